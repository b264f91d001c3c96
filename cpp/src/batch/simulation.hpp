#pragma once
// A run: a pure function of its parameters, ending in exactly one outcome.

#include "record/run_data.hpp"

namespace arm3r {

// params: a valid flat parameter array (schema.hpp). Throws Error when it is not, or when the run is too large.
Run simulate(std::span<const double> params, const RunOptions& options);

[[noreturn]] void refuse_missing_law();

}  // namespace arm3r
