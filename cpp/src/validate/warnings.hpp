#pragma once
// What is allowed but probably a mistake.

#include <optional>

#include "setup/setup.hpp"

namespace arm3r {

// Warnings of what is allowed but probably a mistake, each one sentence with the numbers.
std::vector<std::string> scenario_warnings(const Setup& setup);

// The warning for a controller that compensates another weight than that of the arm. `by_default`: the scenario has no
// controller.gravity; the numbers do not show that, so this is not part of scenario_warnings().
std::optional<std::string> compensation_warning(const Setup& setup, bool by_default);

// One sentence for each control loop that is unstable at the start: by a formula, or else by its linearisation.
std::vector<std::string> unstable_loops(const Setup& setup);

// What was known before a run and explains that it ended badly: an unstable loop, or a rate that the fixed step does not
// resolve.
std::optional<std::string> known_cause(const Setup& setup);

// Warnings about the controller, its reference and its sampling.
void add_controller_warnings(const Setup& setup, std::vector<std::string>& warnings);

}  // namespace arm3r
