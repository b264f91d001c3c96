#pragma once
// One row, or several in a pack, of any number type: for the files that compile it.

#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/pack.hpp"
#include "control/compiled_laws.hpp"
#include "record/row.hpp"

namespace arm3r {

inline constexpr double stencil = 1.0 / 64;  // of the step
inline constexpr double min_stencil = 2e-6;  // s: below it rounding would swamp the difference

template <class S>
ARM3R_INLINE Vec3<S> tip_at(const Arm<double>& arm, const DenseOutput& dense, const S& theta) {
    return tip_position(arm,
                        pose(Vec3<S>(dense.component(0, theta), dense.component(1, theta), dense.component(2, theta))));
}

// The tip at the four points of the difference around theta, at steps of -2, -1, +1 and +2.
template <class T>
ARM3R_INLINE std::array<Vec3<T>, 4> tip_around(const Arm<double>& arm, const DenseOutput& dense, const T& theta,
                                               double step) {
    return {tip_at(arm, dense, T(theta - 2 * step)), tip_at(arm, dense, T(theta - step)),
            tip_at(arm, dense, T(theta + step)), tip_at(arm, dense, T(theta + 2 * step))};
}

ARM3R_INLINE std::array<Vec3<double>, 4> tip_around(const Arm<double>& arm, const DenseOutput& dense, double theta,
                                                    double step) {
    using Four = Pack<4>;
    const Vec3<Four> tip =
        tip_at(arm, dense, Four(Four::Vector{theta - 2 * step, theta - step, theta + step, theta + 2 * step}));
    std::array<Vec3<double>, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = {tip[0][i], tip[1][i], tip[2][i]};
    return points;
}

template <class T>
ARM3R_INLINE Vec3<T> differentiated_tip(const Arm<double>& arm, const DenseOutput& dense, const T& theta) {  // (5.4)
    const double d = std::max(dense.h * stencil, std::min(min_stencil, 0.25 * dense.h));
    const std::array<Vec3<T>, 4> tip = tip_around(arm, dense, theta, d / dense.h);
    Vec3<T> v;
    for (int i = 0; i < 3; ++i) v[i] = (8.0 * (tip[2][i] - tip[1][i]) - (tip[3][i] - tip[0][i])) / (12 * d);
    return v;
}

template <class T>
ARM3R_INLINE ContactForce<T> force_of(const Plant<double>& plant, const WallState<T>& wall, const Indentation<T>& in,
                                      ContactMode mode) {
    if (!is_touching(mode)) return no_contact<T>();
    const Clamping clamping = mode == ContactMode::separated ? Clamping::released : Clamping::clamped;
    return only_where(in.depth > T(0.0), contact_force(plant.wall, wall, plant.contact, in, clamping));
}

// 1 if the segment from a to b passes through the plate, else 0.
template <class T>
ARM3R_INLINE T passes_through(const Wall<double>& wall, const WallState<T>& state, const Vec3<T>& a, const Vec3<T>& b) {
    const T o(0.0), l(1.0);
    const Vec3<T> still(o, o, o);
    const Indentation<T> from = indentation(wall, state, a, still), to = indentation(wall, state, b, still);
    const T share = from.depth / (from.depth - to.depth);
    const Vec3<T> point(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]));
    const T margin = inside_outline(wall, indentation(wall, state, point, still));
    const T from_behind = select(from.depth > o, l, o), to_behind = select(to.depth > o, l, o);
    return select(from_behind != to_behind, select(margin >= o, l, o), o);
}

// 1 if link 2, or a link 3 whose tip is not in contact, passes through the plate, else 0.
template <class T>
ARM3R_INLINE T link_behind(const Plant<double>& plant, const WallState<T>& wall, const Pose<T>& p, const T& touches) {
    const Vec3<T> shoulder(T(0.0), T(0.0), T(plant.arm.base_height));
    const Vec3<T> elbow = elbow_position(plant.arm, p);
    const T link3 = passes_through(plant.wall, wall, elbow, tip_position(plant.arm, p));
    return max(passes_through(plant.wall, wall, shoulder, elbow), T(link3 - touches));
}

// ---- state and reference of the controller

template <class T>
ARM3R_INLINE Vec3<T> torque_with_memory(const RowContext& context, RightHandSide<double, T>& rhs, const T& t,
                                        const WallState<T>& wall, const Pose<T>& p, const State<T, full_size>& y,
                                        const Vec3<T>& f_on_tip) {
    rhs.law_function = compiled_law<double, T>();
    rhs.contact = T(context.contact);
    rhs.force_phase = T(context.force_phase);
    State<T, full_size> rates;
    return rhs.torque(t, wall, p, Vec3<T>(y[0], y[1], y[2]), Vec3<T>(y[3], y[4], y[5]), f_on_tip, y, rates);
}

template <class T>
ARM3R_INLINE Measurement<T> measurement_of(const RowContext& context, const RightHandSide<double, T>& rhs, const T& t,
                                           const WallState<T>& wall, const Pose<T>& p, const Vec3<T>& q,
                                           const Vec3<T>& qd, const Vec3<T>& f_on_tip, const State<T, full_size>& y) {
    Measurement<T> sensed = rhs.measure(t, wall, p, q, qd, f_on_tip, y);
    if (!context.is_sampled) return sensed;
    sensed.f_on_tip = broadcast<T>(context.controller_state.f_on_tip);
    sensed.force_phase = T(context.controller_state.force_phase);
    return sensed;
}

template <class T, class Write, class WriteVector, class WriteJoints>
ARM3R_INLINE void write_law(const RowContext& context, const Measurement<T>& sensed, const ContactForce<T>& force,
                            const State<T, full_size>& y, const Write& write, const WriteVector& write_vector,
                            const WriteJoints& write_joints) {
    static_cast<void>(y);
    const Controller<double>& law = context.controller;
    write(force.normal);
    write(dot(sensed.n, sensed.f_on_tip));
    write(tracks_force(law.type) ? desired_force_at(law.reference, sensed.t) : T(0.0));
    write(sensed.force_phase);
    const Vec3<T> desired =
        tracks_path(law.type) ? desired_motion_at(law.reference, sensed.t).position : zero_vector<T>();
    write_vector(law.reference.in_joints ? zero_vector<T>() : desired);
    write_joints(law.reference.in_joints ? desired : zero_vector<T>());
}

template <class T, class Write, class WriteVector, class WriteJoints>
ARM3R_INLINE void write_observer(const RowContext& context, const RightHandSide<double, T>& rhs, const Pose<T>& p,
                                 const Vec3<T>& qd, const State<T, full_size>& y, const Write& write,
                                 const WriteVector& write_vector, const WriteJoints& write_joints) {
    const bool continuous = !context.is_sampled && context.plant.observer.on;
    const Vec3<T> r = continuous ? rhs.residual_at(p, qd, y) : broadcast<T>(context.controller_state.residual);
    write_joints(r);
    const Arm<double>& model = context.controller.model;
    const Pose<T> seen =
        context.is_sampled ? pose(broadcast<T>(context.controller_state.q)) : p;  // a sampled observer reads encoders
    const auto regular = distance_to_singular(model, seen) > T(1e-3);
    const Vec3<T> f = force_from(model, seen, r);
    write_vector({select(regular, f[0], T(0.0)), select(regular, f[1], T(0.0)), select(regular, f[2], T(0.0))});
    write(T(context.controller_state.collision));
}

template <class T>
struct RowValues {
    std::array<T, column_count> value{};
    T link_behind_wall;
};

template <class T>
ARM3R_INLINE void fill_row(const RowContext& context, const T& row_time, const State<T, full_size>& y, const T& theta,
                           RowValues<T>& row) {
    const T t = max(row_time, T(context.dense.t0));  // no row is before the start of its step
    const Plant<double>& plant = context.plant;
    const Arm<double>& arm = plant.arm;
    const T o(0.0);
    const Vec3<T> q(y[0], y[1], y[2]), qd(y[3], y[4], y[5]);
    const Pose<T> p = pose(q);

    WallState<T> wall = no_wall<T>();
    Indentation<T> in{o, o, o, o, o, o};
    ContactForce<T> force = no_contact<T>();
    T touches = o;
    row.link_behind_wall = o;
    if (plant.has_wall) {
        wall = wall_at(plant.wall, t);
        in = tip_indentation(plant, wall, p, qd);
        force = force_of(plant, wall, in, context.mode);
        if (is_touching(context.mode)) touches = select(in.depth > o, T(1.0), o);
        row.link_behind_wall = link_behind(plant, wall, p, touches);
    }
    Vec3<T> felt = plant.acts_on_arm ? force.on_tip : Vec3<T>(o, o, o), at_tip = force.on_tip;
    if (plant.external_force.on) {
        const Vec3<T> external_force = external_force_at(plant.external_force, t);
        felt = plus(felt, external_force);
        at_tip = plus(at_tip, external_force);
    }
    RightHandSide<double, T> rhs(plant);
    const Vec3<T> tau = has_memory(plant)
                            ? torque_with_memory(context, rhs, t, wall, p, y, at_tip)
                            : limited(arm, feedforward_torque(plant.controller, q, p), plant.controller.saturation);
    const TipSensor<T> sensor = tip_sensor(arm, q, qd);
    const T kinetic = kinetic_energy(arm, p, qd), potential = potential_energy(arm, p);
    const T stored = plant.acts_on_arm ? force.stored : o;

    std::size_t column = 0;
    const auto write = [&](const T& value)
                           ARM3R_INLINE_LAMBDA { row.value[column++] = value + 0.0; };  // + 0.0: no negative zero
    const auto write_vector = [&](const Vec3<T>& v) ARM3R_INLINE_LAMBDA {
        for (int i = 0; i < 3; ++i) write(v[i]);
    };
    const auto write_joints = [&](const Vec3<T>& v)
                                  ARM3R_INLINE_LAMBDA { write_vector(context.simscape ? change_convention(v) : v); };
    write(row_time);
    write_joints(q);
    write_joints(qd);
    write_joints(forward_dynamics(arm, p, qd, tau, felt));
    write_joints(tau);
    write_joints(gravity_torque(arm, p));
    write_vector(sensor.position);
    write_vector(sensor.velocity);
    write_vector(times(jacobian(arm, p), qd));
    write_vector(differentiated_tip(arm, context.dense, theta));
    write_vector(wall.position);
    write(in.depth);
    write(touches);
    write_vector(force.on_tip);
    write_vector({-force.on_tip[0], -force.on_tip[1], -force.on_tip[2]});
    write(kinetic);
    write(potential);
    write(stored);
    for (const std::size_t i : {work_of_actuators, work_of_wall, dissipated}) write(y[i]);
    write(energy_residual(y, T(kinetic + potential + stored), context.energy_at_start));
    const std::array<T, 4> parts = dissipated_parts(plant, y, context.lost_at_edges);
    for (std::size_t i = 0; i < parts.size(); ++i) row.value[parts_column + i] = parts[i] + 0.0;
    if (context.controller.type == ControllerType::none && !plant.observer.on && !plant.has_wall) return;
    const Measurement<T> sensed = measurement_of(context, rhs, t, wall, p, q, qd, at_tip, y);
    write_law(context, sensed, force, y, write, write_vector, write_joints);
    write_observer(context, rhs, p, qd, y, write, write_vector, write_joints);
    const auto write_constant = [&](double value) ARM3R_INLINE_LAMBDA { write(T(value)); };
    write_constant(context.controller_state.stiffness);
    write_constant(context.controller_state.wall_speed);
    write_constant(context.controller_state.identifiable);
    write(context.is_sampled ? T(context.controller_state.memory[0]) : y[law_at]);
    T saturated = o;
    for (int i = 0; i < 3; ++i) saturated = select(abs(tau[i]) >= T(arm.torque_limit[i]), T(1.0), saturated);
    write(saturated);
}

}  // namespace arm3r
