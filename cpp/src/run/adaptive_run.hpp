#pragma once
// Runs by adaptive steps (5.2): to their end, or from sample to sample.

#include "run/interactive_run.hpp"

namespace arm3r {

// params: valid.
Run run_adaptively(std::span<const double> params, const RunOptions& options);
std::unique_ptr<Stepwise> begin_stepwise(std::span<const double> params, const RunOptions& options);

}  // namespace arm3r
