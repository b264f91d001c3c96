#pragma once
// Single runs by the methods that march in lanes too (lane_run.hpp).

#include "record/run_data.hpp"

namespace arm3r {

// params: valid.
Run run_marching(std::span<const double> params, const RunOptions& options);

}  // namespace arm3r
