#pragma once
// The JSON Schemas of scenarios and of sweeps, generated from their tables: an editor offers by them the keys of the
// chosen type.

#include <string>

namespace arm3r {

std::string schema_json();  // draft 7, which every editor knows
std::string sweep_schema_json();

}  // namespace arm3r
