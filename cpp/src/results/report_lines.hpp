#pragma once
// Lines of the report that people read.

#include <string>
#include <vector>

namespace arm3r {

std::string fixed(double value, int decimals);
std::string line(const std::string& label, const std::string& text);

// Lines of cells, each column as wide as its widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& lines);

}  // namespace arm3r
