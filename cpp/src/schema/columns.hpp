#pragma once
// Name, unit and meaning of every column a run can have: the only list of them.

#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>
#include <string_view>

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

inline constexpr std::array column_table = std::to_array<Column>({
    {"t", "s", "time"},
    {"q1", "rad", "joint angle 1"},
    {"q2", "rad", "joint angle 2"},
    {"q3", "rad", "joint angle 3"},
    {"qd1", "rad/s", "joint rate 1"},
    {"qd2", "rad/s", "joint rate 2"},
    {"qd3", "rad/s", "joint rate 3"},
    {"qdd1", "rad/s^2", "joint acceleration 1"},
    {"qdd2", "rad/s^2", "joint acceleration 2"},
    {"qdd3", "rad/s^2", "joint acceleration 3"},
    {"tau1", "N m", "applied torque 1, after the limit"},
    {"tau2", "N m", "applied torque 2, after the limit"},
    {"tau3", "N m", "applied torque 3, after the limit"},
    {"tau_g1", "N m", "torque 1 that holds the true arm"},
    {"tau_g2", "N m", "torque 2 that holds the true arm"},
    {"tau_g3", "N m", "torque 3 that holds the true arm"},
    {"tip_x", "m", "tip position along base x, by the transform sensor (independent recursion)"},
    {"tip_y", "m", "tip position along base y, by the transform sensor"},
    {"tip_z", "m", "tip position along base z, by the transform sensor"},
    {"tip_vx", "m/s", "tip velocity along base x, by the transform sensor"},
    {"tip_vy", "m/s", "tip velocity along base y, by the transform sensor"},
    {"tip_vz", "m/s", "tip velocity along base z, by the transform sensor"},
    {"tip_jvx", "m/s", "tip velocity along base x, as J times qd"},
    {"tip_jvy", "m/s", "tip velocity along base y, as J times qd"},
    {"tip_jvz", "m/s", "tip velocity along base z, as J times qd"},
    {"tip_dvx", "m/s", "tip velocity along base x, position differentiated numerically along the trajectory"},
    {"tip_dvy", "m/s", "tip velocity along base y, position differentiated numerically along the trajectory"},
    {"tip_dvz", "m/s", "tip velocity along base z, position differentiated numerically along the trajectory"},
    {"wall_x", "m", "origin of the plate's frame along base x", Need::wall},
    {"wall_y", "m", "origin of the plate's frame along base y", Need::wall},
    {"wall_z", "m", "origin of the plate's frame along base z", Need::wall},
    {"depth", "m", "how far the tip is behind the contact face; > 0 inside", Need::wall},
    {"contact", "1", "1 in contact, 0 not"},
    {"f_on_tip_x", "N", "contact force on the tip along base x"},
    {"f_on_tip_y", "N", "contact force on the tip along base y"},
    {"f_on_tip_z", "N", "contact force on the tip along base z"},
    {"f_on_wall_x", "N", "contact force on the wall along base x: the opposite"},
    {"f_on_wall_y", "N", "contact force on the wall along base y"},
    {"f_on_wall_z", "N", "contact force on the wall along base z"},
    {"energy_kinetic", "J", "kinetic energy of the arm"},
    {"energy_potential", "J", "potential energy of the arm, zero at the base origin"},
    {"energy_contact", "J", "elastic energy of the contact; 0 when the wall does not act on the arm"},
    {"work_actuators", "J", "work of the applied torques since the start"},
    {"work_wall", "J",
     "work of the wall's drive on the arm since the start, 0 when the wall does not act on the arm; and of a push"},
    {"energy_dissipated", "J", "energy lost to friction, damping and contact since the start"},
    {"energy_residual", "J",
     "change of the energies, minus the works, plus the dissipated energy: the error of the run"},
    {"force", "N", "normal contact force, > 0 when pressing", Need::wall},
    {"force_measured", "N", "normal contact force as the force sensor measures it", Need::wall},
    {"force_ref", "N", "reference of the normal force", Need::force_reference},
    {"force_phase", "1", "1 while force is controlled along the normal, 0 while position is", Need::force_reference},
    {"tip_ref_x", "m", "reference of the tip position along base x", Need::path},
    {"tip_ref_y", "m", "reference of the tip position along base y", Need::path},
    {"tip_ref_z", "m", "reference of the tip position along base z", Need::path},
    {"q_ref1", "rad", "reference of joint angle 1", Need::joint_path},
    {"q_ref2", "rad", "reference of joint angle 2", Need::joint_path},
    {"q_ref3", "rad", "reference of joint angle 3", Need::joint_path},
    {"residual1", "N m", "external torque 1 by the momentum observer", Need::observer},
    {"residual2", "N m", "external torque 2 by the momentum observer", Need::observer},
    {"residual3", "N m", "external torque 3 by the momentum observer", Need::observer},
    {"f_estimate_x", "N", "force at the tip along base x that explains the residual; 0 near a singular pose",
     Need::observer},
    {"f_estimate_y", "N", "force at the tip along base y that explains the residual", Need::observer},
    {"f_estimate_z", "N", "force at the tip along base z that explains the residual", Need::observer},
    {"collision", "1", "1 from the start of a detected collision to its end; a sampled observer only", Need::observer},
    {"stiffness_estimate", "N/m", "the wall's stiffness by least squares; 0 where it is not identifiable",
     Need::estimator},
    {"wall_speed_estimate", "m/s", "the wall's speed towards the arm by least squares; 0 where it is not identifiable",
     Need::estimator},
    {"identifiable", "1", "1 where the data determine both stiffness and speed", Need::estimator},
    {"tank_energy", "J", "energy in the tank", Need::tank},
    {"saturated", "1", "1 where a torque is at its limit", Need::limits},
    {"energy_dissipated_joints", "J", "the part of energy_dissipated lost to damping and friction of the joints",
     Need::loss},
    {"energy_dissipated_contact", "J",
     "the part lost in the contact: by damping along its normal, and by springs along the plate that are still loaded when contact ends",
     Need::loss},
    {"energy_dissipated_friction", "J", "the part lost to friction along the wall", Need::loss},
    {"energy_dissipated_edges", "J", "the part lost where the tip left the plate across an edge", Need::loss},
    {"stiffness_sigma", "N/m", "standard deviation of stiffness_estimate; 0 where it is not identifiable",
     Need::estimator},
});

inline constexpr std::size_t column_count = column_table.size();

using ColumnSet = std::bitset<column_count>;

// The place of a column in a row; a name that does not exist is an error of the compiler.
struct ColumnIndex {
    std::size_t index;

    consteval ColumnIndex(const char* name)
        : index(std::find_if(column_table.begin(), column_table.end(),
                             [name](const Column& column) { return column.name == name; }) -
                column_table.begin()) {
        if (index == column_count) throw "there is no such column";
    }
    constexpr operator std::size_t() const { return index; }
};

}  // namespace arm3r
