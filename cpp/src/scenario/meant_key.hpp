#pragma once
// Suggests which key of a scenario an unknown key stands for.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/yaml_tree.hpp"
#include "schema/schema.hpp"

namespace arm3r {

// Names of keys directly below a section, for the choices made in `params`.
std::vector<std::string> names_there(std::string_view section, std::span<const double> params);

// A sentence for a name of what other robots have and this arm has not; "" for any other name.
std::string not_of_this_arm(std::string_view name, std::string_view section);

// A sentence for a name that is no key of `section`; "" if no key is near.
std::string suggested_key(const std::string& name, std::string_view section, std::span<const double> params);

// The same for the child `node` of `map` in `section`.
std::string suggested_key(const Node& map, const Node& node, std::string_view section, std::span<const double> params);

// "did you mean joint_stiffness?" for a key that does not go with the choices made; "" if no other key has its meaning.
std::string meant_instead(const Key& key, std::span<const double> params);

}  // namespace arm3r
