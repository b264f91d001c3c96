#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "lanes/lane_taylor.hpp"

namespace arm3r {

void run_lanes_taylor(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_lane_groups<LaneTaylor>(lanes, worker, first, run);
}

}  // namespace arm3r
