#pragma once
// The JSON Schema of scenario files, generated from the schema: an editor offers by it the keys of the chosen type.

#include <string>

namespace arm3r {

std::string schema_json();  // draft 7, which every editor knows

}  // namespace arm3r
