#pragma once
// Dotted paths, "wall.contact.stiffness" or "checks[0].abs", into a tree.

#include <string>
#include <string_view>
#include <vector>

#include "files/yaml_tree.hpp"

namespace arm3r {

struct Step {
    std::string key;  // empty: an item of a list
    std::size_t index = 0;
};

std::vector<Step> parse_path(std::string_view path);  // throws Error ARM3R_E_INDEX

const Node* find(const Node& root, const std::vector<Step>& steps);

// The location of the value at a path; if it is missing, that of the deepest existing section.
SourceLocation locate(const Node& root, const std::vector<Step>& steps);

std::string join(std::string_view prefix, std::string_view key);  // "a" + "b" = "a.b"
std::string last_name(std::string_view path);                     // of "a.b": "b"
std::string item(std::string_view path, std::size_t index);       // "a" + 1 = "a[1]"
std::string below(std::string_view path, std::string_view rest);  // "a" + "[1].b" = "a[1].b"; "a" + "" = "a"

// The names that the schema and the reader know directly below a section, in their order; "" is the top.
std::vector<std::string> names_below(std::string_view section);
bool is_section(std::string_view path);
bool is_known(std::string_view path);  // a section, a key, or an item of a key that has several numbers

// "did you mean stiffness?", or "" where no word is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& words);
std::vector<std::string> all_paths();

}  // namespace arm3r
