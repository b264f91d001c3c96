#include "sample.hpp"

#include "columns.hpp"

namespace arm3r {
namespace {

constexpr double stencil = 1.0 / 64;         // of the step
constexpr double shortest_stencil = 2e-6;    // s: below it rounding would swamp the difference

Vec3<double> differentiated_tip(const Arm<double>& arm, const Inside& inside, double theta) {  // (5.4)
    const double d = std::max(inside.h * stencil, shortest_stencil);
    const double step = d / inside.h;
    using Four = Pack<4>;  // the four points of the difference, side by side
    const Four at(Four::Vector{theta - 2 * step, theta - step, theta + step, theta + 2 * step});
    const Vec3<Four> q(inside.component(0, at), inside.component(1, at), inside.component(2, at));
    const Vec3<Four> tip = tip_position(arm, pose(q));
    Vec3<double> v;
    for (int i = 0; i < 3; ++i) v[i] = (8.0 * (tip[i][2] - tip[i][1]) - (tip[i][3] - tip[i][0])) / (12 * d);
    return v;
}

ARM3R_INLINE Indentation<double> indentation_of(const Plant<double>& plant, const WallState<double>& wall, const Pose<double>& p, const Vec3<double>& qd) {
    return indentation(plant.wall, wall, tip_position(plant.arm, p), tip_velocity(plant.arm, p, qd));
}

ContactForce<double> force_of(const Plant<double>& plant, const Indentation<double>& in, Mode mode) {
    return only_where(mode == Mode::contact && in.depth > 0, contact_force(plant.wall, plant.contact, in));
}

// Does the straight piece from a (in front of the face) to b (behind it) pass through the plate?
bool passes_through(const Wall<double>& wall, const WallState<double>& state, const Vec3<double>& a, const Vec3<double>& b) {
    const Vec3<double> still(0, 0, 0);
    const Indentation<double> from = indentation(wall, state, a, still), to = indentation(wall, state, b, still);
    if ((from.depth > 0) == (to.depth > 0)) return false;
    const double share = from.depth / (from.depth - to.depth);
    const Vec3<double> point(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]));
    return inside_outline(wall, indentation(wall, state, point, still)) >= 0;
}

bool link_behind(const Plant<double>& plant, const WallState<double>& wall, const Pose<double>& p, bool tip_touches) {
    const Vec3<double> shoulder(0, 0, plant.arm.base_height);
    const Vec3<double> elbow = elbow_position(plant.arm, p);
    return passes_through(plant.wall, wall, shoulder, elbow) ||
           (!tip_touches && passes_through(plant.wall, wall, elbow, tip_position(plant.arm, p)));
}

}  // namespace

Energies energies(const Plant<double>& plant, double t, const FullState& y, Mode mode) {
    const Pose<double> p = pose(angles(y));
    double stored = 0;
    if (plant.acts_on_arm && mode == Mode::contact)
        stored = force_of(plant, indentation_of(plant, wall_at(plant.wall, t), p, rates(y)), mode).stored;
    return {kinetic_energy(plant.arm, p, rates(y)), potential_energy(plant.arm, p), stored};
}

double energy_residual(const FullState& y, double energy, double energy_at_start) {
    return (energy - energy_at_start) - (y[6] + y[7] - y[8]);
}

Row sample(const Plant<double>& plant, bool simscape, double t, const FullState& y, Mode mode, double energy_at_start,
           const Inside& inside, double theta) {
    const Arm<double>& arm = plant.arm;
    const Vec3<double> q = angles(y), qd = rates(y);
    const Pose<double> p = pose(q);

    WallState<double> wall{};
    Indentation<double> in{};
    ContactForce<double> force = no_contact<double>();
    if (plant.has_wall) {
        wall = wall_at(plant.wall, t);
        in = indentation_of(plant, wall, p, qd);
        force = force_of(plant, in, mode);
    }
    const bool touches = mode == Mode::contact && in.depth > 0;
    const Vec3<double> felt = plant.acts_on_arm ? force.on_tip : Vec3<double>(0, 0, 0);
    const Vec3<double> tau = limited(arm, control(plant.controller, q, p));
    const Vec3<double> qdd = forward_dynamics(arm, p, qd, tau, felt);
    const TipSensor<double> sensor = tip_sensor(arm, q, qd);
    const Energies energy{kinetic_energy(arm, p, qd), potential_energy(arm, p), plant.acts_on_arm ? force.stored : 0.0};

    Row row;
    std::size_t column = 0;
    const auto put = [&](double value) { row.value[column++] = value + 0.0; };  // + 0.0: no negative zero
    const auto put_vector = [&](const Vec3<double>& v) { for (int i = 0; i < 3; ++i) put(v[i]); };
    const auto put_joints = [&](const Vec3<double>& v) { put_vector(simscape ? flipped(v) : v); };
    put(t);
    put_joints(q);
    put_joints(qd);
    put_joints(qdd);
    put_joints(tau);
    put_joints(gravity_torque(arm, p));
    put_vector(sensor.position);
    put_vector(sensor.velocity);
    put_vector(times(jacobian(arm, p), qd));
    put_vector(differentiated_tip(arm, inside, theta));
    put_vector(wall.position);
    put(in.depth);
    put(touches ? 1.0 : 0.0);
    put_vector(force.on_tip);
    put_vector(-force.on_tip);
    put(energy.kinetic);
    put(energy.potential);
    put(energy.contact);
    for (std::size_t i = motion_size; i < state_size; ++i) put(y[i]);
    put(energy_residual(y, energy.sum(), energy_at_start));
    row.link_behind_wall = plant.has_wall && link_behind(plant, wall, p, touches);
    return row;
}

}  // namespace arm3r
