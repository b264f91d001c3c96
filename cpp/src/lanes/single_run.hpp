#pragma once
// Single runs by the methods that march in lanes (lane_run.hpp): to their end, or from sample to sample.

#include "run/interactive_run.hpp"
#include "setup/setup.hpp"

namespace arm3r {

Run run_alone(const Setup& setup, const RunOptions& options);

std::unique_ptr<InteractiveRun> start_interactive_run(const Setup& setup, const RunOptions& options);

}  // namespace arm3r
