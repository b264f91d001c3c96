#include "record/row_values.hpp"
#include "setup/make_controller.hpp"
#include "validate/size_limits.hpp"

namespace arm3r {

Energies<double> energies(const Plant<double>& plant, double t, const FullState& y, ContactMode mode) {
    const Pose<double> p = pose(angles(y));
    double stored = 0;
    if (plant.acts_on_arm && is_touching(mode)) {
        const WallState<double> wall = wall_at(plant.wall, t);
        stored = force_of(plant, wall, tip_indentation(plant, wall, p, rates(y)), mode).stored;
    }
    return {kinetic_energy(plant.arm, p, rates(y)), potential_energy_of_pose(plant.arm, p), stored};
}

namespace {

// The parts of a row that a column needs.
constexpr unsigned parts_of(std::size_t column) {
    const auto is_between = [column](ColumnIndex first, ColumnIndex last) { return column >= first && column <= last; };
    if (is_between("qdd1", "qdd3")) return applied_torque | acceleration;
    if (is_between("tau1", "tau3")) return applied_torque;
    if (is_between("tau_g1", "tau_g3")) return gravity_part;
    if (is_between("tip_x", "tip_vz")) return transform_sensor;
    if (is_between("tip_jvx", "tip_jvz")) return jacobian_velocity;
    if (is_between("tip_dvx", "tip_dvz")) return differentiated_position;
    if (is_between("force", "q_ref3")) return law_signals;
    if (is_between("residual1", "collision")) return observer_signals;
    if (is_between("stiffness_estimate", "tank_energy")) return memory_signals;
    if (is_between("stiffness_sigma", "stiffness_sigma")) return memory_signals;
    if (is_between("saturated", "saturated")) return applied_torque | memory_signals;
    if (is_between("energy_dissipated_joints", "energy_dissipated_edges")) return losses;
    if (is_between("wall_x", "f_on_wall_z")) return contact_state;
    if (is_between("energy_kinetic", "energy_residual")) return energy_terms;
    return 0;
}

RowPlan with_parts(std::vector<std::size_t> columns, std::vector<std::size_t> hidden, unsigned parts) {
    for (const std::size_t column : columns) parts |= parts_of(column);
    for (const std::size_t column : hidden) parts |= parts_of(column);
    return {std::move(columns), std::move(hidden), parts};
}

}  // namespace

// A bad end is explained by the poses before it, a missed contact by the depths, an observer judged by its residual:
// what a run says does not depend on its log.
RowPlan make_row_plan(const Setup& setup, const ColumnSet& kept, bool is_judged) {
    ColumnSet hidden = kept;
    const auto keep = [&](std::initializer_list<ColumnIndex> columns) {
        for (const ColumnIndex column : columns) hidden.set(column);
    };
    if (inverts_jacobian(setup.controller())) keep({"q1", "q2", "q3"});
    if (is_judged && tracks_force(setup.controller().type)) keep({"depth"});
    if (is_judged && setup.observes()) keep({"residual1", "residual2", "residual3"});
    return with_parts(columns_of(setup), in_order(hidden & possible_columns(setup) & ~setup.logged),
                      is_judged ? judged_parts : 0);
}

RowPlan plan_of_end() { return {{}, {}, applied_torque | acceleration}; }

Row make_row(const RowContext& context, double t, const FullState& y, double theta) {
    RowValues<double> row{};
    fill_row(context, t, y, theta, row);
    return {row.value, row.link_behind_wall > 0};
}

}  // namespace arm3r
