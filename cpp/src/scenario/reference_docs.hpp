#pragma once
// The reference pages of scenarios and columns, generated from the schema and the column table.

#include <string>

namespace arm3r {

std::string schema_json();  // JSON Schema, draft 2020-12
std::string schema_markdown();
std::string columns_text();
std::string columns_markdown();
std::string scenario_template();

}  // namespace arm3r
