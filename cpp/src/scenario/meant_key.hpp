#pragma once
// What an unknown key of a scenario most likely is meant to be.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/yaml_tree.hpp"

namespace arm3r {

// Names that stand directly below a section for the choices made in `params`.
std::vector<std::string> names_there(std::string_view section, std::span<const double> params);

// A sentence for the child `node` of `map`, which stands at `section`; "" where nothing is near.
std::string meant_key(const Node& map, const Node& node, std::string_view section, std::span<const double> params);

}  // namespace arm3r
