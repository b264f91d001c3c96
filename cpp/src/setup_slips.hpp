#pragma once
// Parts of likely_slips() (setup.hpp), and what stands beside it.

#include <optional>

#include "setup.hpp"

namespace arm3r {

// Of a scenario that does not give controller.gravity: the default is not what the plant feels. It is no part of
// likely_slips(), for the numbers do not tell what was given.
std::optional<std::string> slip_of_default_gravity(std::span<const double> params);

// Of the controller, its reference and its sampling.
void add_controller_slips(const Setup& setup, std::vector<std::string>& slips);

}  // namespace arm3r
