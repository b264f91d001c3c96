#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "lanes/lane_events.hpp"

namespace arm3r {

template <class T>
using PlainLaneEvents = LaneEvents<T, state_size>;

void run_lanes_to_events(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_lane_groups<PlainLaneEvents>(lanes, worker, first, run);
}

}  // namespace arm3r
