#pragma once
// The two ways to run a scenario: by an adaptive method that looks back, and by methods that march in lanes too.

#include "simulation.hpp"

namespace arm3r {

Run run_adaptively(std::span<const double> params, const RunOptions& options);
Run run_marching(std::span<const double> params, const RunOptions& options);

[[noreturn]] void refuse_missing_law();
std::string steps_used_up(double t);
std::string event_storm(double t);

}  // namespace arm3r
