#pragma once
// Name, unit and meaning of every column a run can have: the only list of them.

#include <string_view>
#include <vector>

namespace arm3r {

struct Column {
    std::string_view name, unit, doc;
    bool only_with_wall = false;
};

const std::vector<Column>& column_table();

}  // namespace arm3r
