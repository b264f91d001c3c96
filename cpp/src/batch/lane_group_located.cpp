#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "integrate/fixed_steps.hpp"
#include "lanes/lane_events.hpp"

namespace arm3r {

template <class T>
using LaneLocatedRk4 = LaneEvents<T, state_size, FixedSteps<T, state_size>>;

void run_lanes_located(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_lane_groups<LaneLocatedRk4>(lanes, worker, first, run);
}

}  // namespace arm3r
