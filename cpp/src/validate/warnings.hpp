#pragma once
// What is allowed but probably a mistake.

#include <optional>

#include "setup/setup.hpp"

namespace arm3r {

// What is allowed but probably a slip, each one sentence with the numbers.
std::vector<std::string> likely_slips(const Setup& setup);

// Of a scenario that does not give controller.gravity: the default is not what the plant feels. It is no part of
// likely_slips(), for the numbers do not tell what was given.
std::optional<std::string> slip_of_default_gravity(const Setup& setup);

// Of the controller, its reference and its sampling.
void add_controller_slips(const Setup& setup, std::vector<std::string>& slips);

}  // namespace arm3r
