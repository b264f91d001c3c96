#include "columns.hpp"

namespace arm3r {

const std::vector<Column>& column_table() {
    static const std::vector<Column> table = {
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
        {"wall_x", "m", "origin of the plate's frame along base x", true},
        {"wall_y", "m", "origin of the plate's frame along base y", true},
        {"wall_z", "m", "origin of the plate's frame along base z", true},
        {"depth", "m", "how far the tip is behind the contact face; > 0 inside", true},
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
        {"work_actuators", "J", "work of the applied torques since t = 0"},
        {"work_wall", "J", "work of the wall's drive on the arm since t = 0; 0 when the wall does not act on the arm"},
        {"energy_dissipated", "J", "energy lost to friction, damping and contact since t = 0"},
        {"energy_residual", "J", "what the balance of the six before leaves over: the error of the run"},
    };
    return table;
}

}  // namespace arm3r
