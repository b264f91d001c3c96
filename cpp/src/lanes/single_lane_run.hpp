#pragma once
// Single runs by the methods that march in lanes too (lane_run.hpp).

#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

Run run_in_lane(const Setup& setup, const RunOptions& options);

}  // namespace arm3r
