#pragma once
// Part of likely_slips() (setup.hpp).

#include "setup.hpp"

namespace arm3r {

// Of the controller, its reference and its sampling.
void add_controller_slips(const Setup& setup, std::vector<std::string>& slips);

}  // namespace arm3r
