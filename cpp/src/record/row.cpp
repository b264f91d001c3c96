#include "record/row_values.hpp"

namespace arm3r {

Energies<double> energies(const Plant<double>& plant, double t, const FullState& y, ContactMode mode) {
    const Pose<double> p = pose(angles(y));
    double stored = 0;
    if (plant.acts_on_arm && is_touching(mode)) {
        const WallState<double> wall = wall_at(plant.wall, t);
        stored = force_of(plant, wall, tip_indentation(plant, wall, p, rates(y)), mode).stored;
    }
    return {kinetic_energy(plant.arm, p, rates(y)), potential_energy(plant.arm, p), stored};
}

Row make_row(const RowContext& context, double t, const FullState& y, double theta) {
    RowValues<double> row;
    fill_row(context, t, y, theta, row);
    return {row.value, row.link_behind_wall > 0};
}

}  // namespace arm3r
