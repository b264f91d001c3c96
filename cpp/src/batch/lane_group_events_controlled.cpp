#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "lanes/lane_events.hpp"

namespace arm3r {

template <class T>
using ControlledLaneEvents = LaneEvents<T, full_size>;

void run_lanes_to_events_controlled(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_lane_groups<ControlledLaneEvents>(lanes, worker, first, run);
}

}  // namespace arm3r
