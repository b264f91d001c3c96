#pragma once
// A run: a pure function of its parameters, ending in exactly one outcome.

#include <span>

#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// The run of a setup that keeps every rule (validate.hpp). Throws Error where it is too large, or has no law of the user's.
Run simulate(const Setup& setup, const RunOptions& options);

[[noreturn]] void refuse_missing_law();

// Throws Error where the parameters have a controller of another type than `user`.
void refuse_other_controllers(std::span<const double> params);

}  // namespace arm3r
