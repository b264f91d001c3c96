#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "lanes/lane_rk4.hpp"

namespace arm3r {

template <class T>
using PlainLaneRk4 = LaneRk4<T, state_size>;

void run_lanes_rk4(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_lane_groups<PlainLaneRk4>(lanes, worker, first, run);
}

}  // namespace arm3r
