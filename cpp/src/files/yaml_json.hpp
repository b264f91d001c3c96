#pragma once
// YAML text as JSON with the place of every node: the reader of scenarios, for files that are not scenarios.

#include <string>

namespace arm3r {

// As arm3r.h describes it. Throws Error ARM3R_E_SCENARIO, listing every problem.
std::string yaml_json(std::string text, const std::string& file);

}  // namespace arm3r
