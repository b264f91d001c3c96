#pragma once
// A fixed step beside every rate of the model that is known before the run.

#include <string>
#include <vector>

#include "setup/setup.hpp"

namespace arm3r {

// One sentence for each rate that a step of rk4 does not resolve.
void warn_of_fixed_step(const Setup& setup, std::vector<std::string>& warnings);

}  // namespace arm3r
