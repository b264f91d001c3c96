#pragma once
// One row, or several side by side, of any number type: for the files that build it.

#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/pack.hpp"
#include "control/compiled_laws.hpp"
#include "record/row.hpp"

namespace arm3r {

inline constexpr double stencil = 1.0 / 64;       // of the step
inline constexpr double shortest_stencil = 2e-6;  // s: below it rounding would swamp the difference

template <class S>
ARM3R_INLINE Vec3<S> tip_at(const Arm<double>& arm, const Inside& inside, const S& theta) {
    return tip_position(
        arm, pose(Vec3<S>(inside.component(0, theta), inside.component(1, theta), inside.component(2, theta))));
}

// The tip at the four points of the difference around theta, at steps of -2, -1, +1 and +2.
template <class T>
ARM3R_INLINE std::array<Vec3<T>, 4> tip_around(const Arm<double>& arm, const Inside& inside, const T& theta,
                                               double step) {
    return {tip_at(arm, inside, T(theta - 2 * step)), tip_at(arm, inside, T(theta - step)),
            tip_at(arm, inside, T(theta + step)), tip_at(arm, inside, T(theta + 2 * step))};
}

ARM3R_INLINE std::array<Vec3<double>, 4> tip_around(const Arm<double>& arm, const Inside& inside, double theta,
                                                    double step) {
    using Four = Pack<4>;
    const Vec3<Four> tip =
        tip_at(arm, inside, Four(Four::Vector{theta - 2 * step, theta - step, theta + step, theta + 2 * step}));
    std::array<Vec3<double>, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = {tip[0][i], tip[1][i], tip[2][i]};
    return points;
}

template <class T>
ARM3R_INLINE Vec3<T> differentiated_tip(const Arm<double>& arm, const Inside& inside, const T& theta) {  // (5.4)
    const double d = std::max(inside.h * stencil, std::min(shortest_stencil, 0.25 * inside.h));
    const std::array<Vec3<T>, 4> tip = tip_around(arm, inside, theta, d / inside.h);
    Vec3<T> v;
    for (int i = 0; i < 3; ++i) v[i] = (8.0 * (tip[2][i] - tip[1][i]) - (tip[3][i] - tip[0][i])) / (12 * d);
    return v;
}

template <class T>
ARM3R_INLINE ContactForce<T> force_of(const Plant<double>& plant, const WallState<T>& wall, const Indentation<T>& in,
                                      Mode mode) {
    if (!is_touching(mode)) return no_contact<T>();
    const Grip grip = mode == Mode::separated ? Grip::released : Grip::clipped;
    return only_where(in.depth > T(0.0), contact_force(plant.wall, wall, plant.contact, in, grip));
}

// 1 where the straight piece from a to b passes through the plate, else 0.
template <class T>
ARM3R_INLINE T passes_through(const Wall<double>& wall, const WallState<T>& state, const Vec3<T>& a, const Vec3<T>& b) {
    const T o(0.0), l(1.0);
    const Vec3<T> still(o, o, o);
    const Indentation<T> from = indentation(wall, state, a, still), to = indentation(wall, state, b, still);
    const T share = from.depth / (from.depth - to.depth);
    const Vec3<T> point(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]));
    const T inside = inside_outline(wall, indentation(wall, state, point, still));
    const T from_behind = select(from.depth > o, l, o), to_behind = select(to.depth > o, l, o);
    return select(from_behind != to_behind, select(inside >= o, l, o), o);
}

// 1 where link 2, or a link 3 whose tip does not touch, passes through the plate, else 0.
template <class T>
ARM3R_INLINE T link_behind(const Plant<double>& plant, const WallState<T>& wall, const Pose<T>& p, const T& touches) {
    const Vec3<T> shoulder(T(0.0), T(0.0), T(plant.arm.base_height));
    const Vec3<T> elbow = elbow_position(plant.arm, p);
    const T link3 = passes_through(plant.wall, wall, elbow, tip_position(plant.arm, p));
    return max(passes_through(plant.wall, wall, shoulder, elbow), T(link3 - touches));
}

// ---- what a controller knows and wants

template <class T>
ARM3R_INLINE Vec3<T> torque_with_memory(const Scene& scene, RightHandSide<double, T>& rhs, const T& t,
                                        const WallState<T>& wall, const Pose<T>& p, const State<T, full_size>& y,
                                        const Vec3<T>& f_on_tip) {
    rhs.law_function = compiled_law<double, T>();
    rhs.contact = T(scene.contact);
    rhs.force_phase = T(scene.force_phase);
    State<T, full_size> rates;
    return rhs.torque(t, wall, p, Vec3<T>(y[0], y[1], y[2]), Vec3<T>(y[3], y[4], y[5]), f_on_tip, y, rates);
}

template <class T>
ARM3R_INLINE Sensed<T> sensed_by(const Scene& scene, const RightHandSide<double, T>& rhs, const T& t,
                                 const WallState<T>& wall, const Pose<T>& p, const Vec3<T>& q, const Vec3<T>& qd,
                                 const Vec3<T>& f_on_tip, const State<T, full_size>& y) {
    Sensed<T> sensed = rhs.sense(t, wall, p, q, qd, f_on_tip, y);
    if (!scene.is_sampled) return sensed;
    sensed.f_on_tip = lifted<T>(scene.known.f_on_tip);
    sensed.force_phase = T(scene.known.force_phase);
    return sensed;
}

template <class T, class Put, class PutVector, class PutJoints>
ARM3R_INLINE void put_law(const Scene& scene, const Sensed<T>& sensed, const ContactForce<T>& force,
                          const State<T, full_size>& y, const Put& put, const PutVector& put_vector,
                          const PutJoints& put_joints) {
    static_cast<void>(y);
    const Controller<double>& law = scene.law;
    put(force.normal);
    put(dot(sensed.n, sensed.f_on_tip));
    put(wants_force(law.type) ? force_wanted_at(law.setpoint, sensed.t) : T(0.0));
    put(sensed.force_phase);
    const Vec3<T> wanted = wants_path(law.type) ? wanted_at(law.setpoint, sensed.t).position : none<T>();
    put_vector(law.setpoint.in_joints ? none<T>() : wanted);
    put_joints(law.setpoint.in_joints ? wanted : none<T>());
}

template <class T, class Put, class PutVector, class PutJoints>
ARM3R_INLINE void put_observer(const Scene& scene, const RightHandSide<double, T>& rhs, const Pose<T>& p,
                               const Vec3<T>& qd, const State<T, full_size>& y, const Put& put,
                               const PutVector& put_vector, const PutJoints& put_joints) {
    const bool continuous = !scene.is_sampled && scene.plant.observer.on;
    const Vec3<T> r = continuous ? rhs.residual_at(p, qd, y) : lifted<T>(scene.known.residual);
    put_joints(r);
    const Arm<double>& model = scene.law.model;
    const Pose<T> seen = scene.is_sampled ? pose(lifted<T>(scene.known.q)) : p;  // a sampled observer reads encoders
    const auto regular = distance_to_singular(model, seen) > T(1e-3);
    const Vec3<T> f = force_from(model, seen, r);
    put_vector({select(regular, f[0], T(0.0)), select(regular, f[1], T(0.0)), select(regular, f[2], T(0.0))});
    put(T(scene.known.collision));
}

template <class T>
struct Sampled {
    std::array<T, column_count> value{};
    T link_behind_wall;
};

template <class T>
ARM3R_INLINE void sample_into(const Scene& scene, const T& row_time, const State<T, full_size>& y, const T& theta,
                              Sampled<T>& row) {
    const T t = max(row_time, T(scene.inside.t0));  // a row is never seen before the step that it was put into
    const Plant<double>& plant = scene.plant;
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
        force = force_of(plant, wall, in, scene.mode);
        if (is_touching(scene.mode)) touches = select(in.depth > o, T(1.0), o);
        row.link_behind_wall = link_behind(plant, wall, p, touches);
    }
    Vec3<T> felt = plant.acts_on_arm ? force.on_tip : Vec3<T>(o, o, o), at_tip = force.on_tip;
    if (plant.load.on) {
        const Vec3<T> load = load_at(plant.load, t);
        felt = plus(felt, load);
        at_tip = plus(at_tip, load);
    }
    RightHandSide<double, T> rhs(plant);
    const Vec3<T> tau = has_memory(plant) ? torque_with_memory(scene, rhs, t, wall, p, y, at_tip)
                                          : limited(arm, control(plant.controller, q, p), plant.controller.saturation);
    const TipSensor<T> sensor = tip_sensor(arm, q, qd);
    const T kinetic = kinetic_energy(arm, p, qd), potential = potential_energy(arm, p);
    const T stored = plant.acts_on_arm ? force.stored : o;

    std::size_t column = 0;
    const auto put = [&](const T& value)
                         ARM3R_INLINE_LAMBDA { row.value[column++] = value + 0.0; };  // + 0.0: no negative zero
    const auto put_vector = [&](const Vec3<T>& v) ARM3R_INLINE_LAMBDA {
        for (int i = 0; i < 3; ++i) put(v[i]);
    };
    const auto put_joints = [&](const Vec3<T>& v) ARM3R_INLINE_LAMBDA { put_vector(scene.simscape ? flipped(v) : v); };
    put(row_time);
    put_joints(q);
    put_joints(qd);
    put_joints(forward_dynamics(arm, p, qd, tau, felt));
    put_joints(tau);
    put_joints(gravity_torque(arm, p));
    put_vector(sensor.position);
    put_vector(sensor.velocity);
    put_vector(times(jacobian(arm, p), qd));
    put_vector(differentiated_tip(arm, scene.inside, theta));
    put_vector(wall.position);
    put(in.depth);
    put(touches);
    put_vector(force.on_tip);
    put_vector({-force.on_tip[0], -force.on_tip[1], -force.on_tip[2]});
    put(kinetic);
    put(potential);
    put(stored);
    for (const std::size_t i : {work_of_actuators, work_of_wall, dissipated}) put(y[i]);
    put(energy_residual(y, T(kinetic + potential + stored), scene.energy_at_start));
    const std::array<T, 4> parts = dissipated_parts(plant, y, scene.lost_at_edges);
    for (std::size_t i = 0; i < parts.size(); ++i) row.value[parts_column + i] = parts[i] + 0.0;
    if (scene.law.type == Controls::none && !plant.observer.on && !plant.has_wall) return;
    const Sensed<T> sensed = sensed_by(scene, rhs, t, wall, p, q, qd, at_tip, y);
    put_law(scene, sensed, force, y, put, put_vector, put_joints);
    put_observer(scene, rhs, p, qd, y, put, put_vector, put_joints);
    const auto put_constant = [&](double value) ARM3R_INLINE_LAMBDA { put(T(value)); };
    put_constant(scene.known.stiffness);
    put_constant(scene.known.wall_speed);
    put_constant(scene.known.identifiable);
    put(scene.is_sampled ? T(scene.known.memory[0]) : y[law_at]);
    T saturated = o;
    for (int i = 0; i < 3; ++i) saturated = select(abs(tau[i]) >= T(arm.torque_limit[i]), T(1.0), saturated);
    put(saturated);
}

}  // namespace arm3r
