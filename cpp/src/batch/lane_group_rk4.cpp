#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "lanes/single_rk4.hpp"

namespace arm3r {

template <class T>
using PlainLaneRk4 = std::conditional_t<Lanes<T>::count == 1, SingleRk4, LaneRk4<T>>;

void run_lanes_rk4(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_lane_groups<PlainLaneRk4>(lanes, worker, first, run);
}

}  // namespace arm3r
