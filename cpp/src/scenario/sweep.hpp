#pragma once
// A sweep's file: the table of its keys, from which messages and JSON Schema follow too, and its reader.

#include "scenario/scenario.hpp"
#include "schema/schema.hpp"

namespace arm3r {

// A choice stands before the keys that depend on it; "axes.key" is a key of each map in the list `axes`.
const std::vector<Key>& sweep_keys();

// What the keys say, as arm3r.h describes it; and the scenario with the values of `set`, which is not validated. Throws
// Error ARM3R_E_SCENARIO with every problem.
std::string read_sweep(std::string text, const std::string& file, Scenario& scenario);

}  // namespace arm3r
