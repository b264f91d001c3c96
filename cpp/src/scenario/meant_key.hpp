#pragma once
// Suggests which key of a scenario an unknown key stands for.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/yaml_tree.hpp"

namespace arm3r {

// Names of keys directly below a section, for the choices made in `params`.
std::vector<std::string> names_there(std::string_view section, std::span<const double> params);

// A sentence for the child `node` of `map` in `section`; "" if no key is near.
std::string suggested_key(const Node& map, const Node& node, std::string_view section, std::span<const double> params);

}  // namespace arm3r
