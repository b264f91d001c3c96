#pragma once
// The reference pages of scenarios and columns, generated from the schema and the column table.

#include <string>

#include "schema/schema.hpp"

namespace arm3r {

std::string schema_markdown();
std::string unit_text(const Key& key);  // "rad, or VALUE deg"; "" for none
std::string columns_text();
std::string columns_markdown();
std::string scenario_template();

}  // namespace arm3r
