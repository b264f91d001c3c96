#pragma once
// Runs by adaptive steps (5.2): to their end, or from sample to sample.

#include "run/interactive_run.hpp"

namespace arm3r {

Run run_adaptively(const Setup& setup, const RunOptions& options);
std::unique_ptr<InteractiveRun> start_interactive_run(const Setup& setup, const RunOptions& options);

}  // namespace arm3r
