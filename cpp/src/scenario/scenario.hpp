#pragma once
// A scenario: text, with edits, turned by the schema into numbers whose origin is known.

#include <string>
#include <string_view>
#include <vector>

#include "files/yaml_tree.hpp"
#include "results/checks.hpp"
#include "setup/setup.hpp"

namespace arm3r {

struct Scenario {
    Document document;
    std::string file;  // its name in messages
};

// Syntax only; what the text says is judged by resolve().
Scenario read_scenario(std::string text, std::string file);

// Sets the value (YAML) at a path; null removes it. A new choice drops the keys of the old one. `origin`: the name of
// the edit in messages and provenance.
void set(Scenario& scenario, std::string_view path, const std::string& value, const std::string& origin);

struct Resolved {
    std::string name;
    std::vector<double> params;
    Setup setup;  // of the parameters
    std::vector<Check> checks;
    std::vector<std::string> warnings;  // probable mistakes that the numbers alone do not show
    Node tree;                          // every value there is, each with its origin as note
};

// Throws Error with every problem of the scenario.
Resolved resolve(const Scenario& scenario);

// The problems that an Error found in the numbers, with their place in the scenario.
std::vector<Problem> located(std::vector<Problem> problems, const Scenario& scenario);

// ---- the resolved tree as text (scenario_text.cpp)

std::string to_yaml(const Node& tree, bool notes);
std::string to_json(const Node& node);
std::string json_at(const Resolved& resolved, std::string_view path);  // null where a known key is unset

// The origin of a default, as people read it.
std::string source_name(int source);

}  // namespace arm3r
