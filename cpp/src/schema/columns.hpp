#pragma once
// Name, unit and meaning of every column a run can have: the only list of them.

#include <string_view>
#include <vector>

namespace arm3r {

// The condition for a column to exist.
enum class Need {
    nothing,
    wall,
    force_reference,  // a law that tracks a force
    path,             // a law that tracks a path of the tip
    joint_path,       // a law that tracks a path in joint angles
    observer,
    estimator,
    tank,
    loss,    // something that can turn energy into heat
    limits,  // torque limits
};

struct Column {
    std::string_view name, unit, doc;
    Need need = Need::nothing;
};

std::string_view need_text(Need need);  // "only with a wall"; "" for nothing
std::string_view need_hint(Need need);  // "add `wall: {}`": how a run gets the column

const std::vector<Column>& column_table();

}  // namespace arm3r
