#include "trust/enclosure.hpp"

namespace arm3r {
namespace {

using Vector = Vec3<Interval>;

Pose<Interval> pose_of(const Vector& q) {
    const auto [S1, C1] = sincos(q[0]);
    const auto [S2, C2] = sincos(q[1]);
    const auto [S23, C23] = sincos(q[1] + q[2]);
    return {S1, C1, S2, C2, S23, C23};
}

// What gravity does to the links beyond what a controller compensates. Where both have the same gravity, only what the
// two arms differ in is taken: the difference of two equal intervals is not zero.
Vector weight_left(const Plant<double>& plant, const Pose<Interval>& p) {
    const Arm<double>&arm = plant.arm, &model = plant.controller.model;
    if (plant.controller.type != ControllerType::gravity_compensation) return link_weight(arm, p);
    if (arm.gravity != model.gravity) return minus(link_weight(arm, p), link_weight(model, p));
    Arm<double> rest = arm;
    rest.lumped.G2 -= model.lumped.G2;
    rest.lumped.G3 -= model.lumped.G3;
    rest.elbow.Gy2 -= model.elbow.Gy2;
    rest.elbow.Gy3 -= model.elbow.Gy3;
    rest.elbow.Hu -= model.elbow.Hu;
    rest.elbow.Hv -= model.elbow.Hv;
    return link_weight(rest, p);
}

// The acceleration of the joints without the wall, and by a force of 1 N along n.
struct Accelerations {
    Vector free, by_force;
};

Accelerations accelerations(const Plant<double>& plant, const Vec3<double>& n, const Pose<Interval>& p,
                            const Vector& qd) {
    const Vector held = plant.holds_torque ? broadcast<Interval>(plant.held_torque) : zero_vector<Interval>();
    const Vector drive = minus(held, friction_torque(plant.arm, qd)), at_rest = zero_vector<Interval>();
    const Vector push = tip_force_torque(plant.arm, p, broadcast<Interval>(n));
    return {joint_acceleration(plant.arm, p, qd, drive, weight_left(plant, p)),
            joint_acceleration(plant.arm, p, at_rest, push, at_rest)};
}

Enclosure seen_from_tip(const Plant<double>& plant, const Vec3<double>& n, const Vector& q, const Vector& qd) {
    const Pose<Interval> p = pose_of(q);
    const Vector normal = broadcast<Interval>(n);
    const auto [free, a] = accelerations(plant, n, p, qd);
    const Mat3<Interval> J_dot = jacobian_dot(plant.arm, p, qd), C = coriolis_matrix(plant.arm, p, qd);
    return {.q = q,
            .qd = qd,
            .mobility_rate = 2.0 * (dot(normal, times(J_dot, a)) - dot(a, times(C, a))),
            .acceleration = dot(normal, plus(tip_velocity(plant.arm, p, free), times(J_dot, qd))),
            .tip_velocity = tip_velocity(plant.arm, p, qd)};
}

bool contains(const Vector& outer, const Vector& inner) {
    return outer[0].contains(inner[0]) && outer[1].contains(inner[1]) && outer[2].contains(inner[2]);
}

Vector grown(const Vector& old, const Vector& next) {
    Vector out;
    for (int i = 0; i < 3; ++i) out[i] = widened(hull(old[i], next[i]), 0.05);
    return out;
}

}  // namespace

bool is_passive(const Plant<double>& plant) {
    const ControllerType type = plant.controller.type;
    const bool compensates = type == ControllerType::gravity_compensation;
    return (type == ControllerType::none || type == ControllerType::constant || compensates) &&
           !(compensates && plant.arm.has_torque_limit) && !plant.external_force.on;
}

std::optional<Enclosure> enclose(const Plant<double>& plant, const Vec3<double>& n, const Vec3<double>& q,
                                 const Vec3<double>& qd, const Span& span) {
    const Interval time(0, span.time), impulse(0, span.impulse);
    Vector angles = broadcast<Interval>(q), rates = broadcast<Interval>(qd);
    for (int attempt = 0; attempt < 40; ++attempt) {
        const Accelerations by = accelerations(plant, n, pose_of(angles), rates);
        Vector next_angles, next_rates;
        for (int i = 0; i < 3; ++i) {
            next_rates[i] = qd[i] + by.free[i] * time + by.by_force[i] * impulse;
            next_angles[i] = q[i] + rates[i] * time;
        }
        if (contains(angles, next_angles) && contains(rates, next_rates)) return seen_from_tip(plant, n, angles, rates);
        angles = grown(angles, next_angles);
        rates = grown(rates, next_rates);
    }
    return {};
}

Enclosure at_instant(const Plant<double>& plant, const Vec3<double>& n, const Vec3<double>& q, const Vec3<double>& qd) {
    return seen_from_tip(plant, n, broadcast<Interval>(q), broadcast<Interval>(qd));
}

}  // namespace arm3r
