#pragma once
// The tables of a scenario that stand in CSV files of their own.

#include <string>
#include <vector>

#include "files/yaml_tree.hpp"
#include "schema/schema.hpp"

namespace arm3r {

// The tree with the columns of each table's file in place of its lists. A relative name counts from the folder of
// `scenario_file`. What is wrong with a file is added to `problems`; its lists are then marked as refused.
Node with_table_files(Node root, const std::string& scenario_file, std::vector<Problem>& problems);

// The lists that a key of a file stands for: those of its section.
std::vector<const Key*> columns_of(const Key& file);

}  // namespace arm3r
