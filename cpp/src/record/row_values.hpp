#pragma once
// One row, or several in a pack, of any number type: for the files that compile it.

#include "arm3r/control/task_space.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/pack.hpp"
#include "control/compiled_laws.hpp"
#include "integrate/dense_output.hpp"
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
    const double longest = dense.is_series() ? infinite : 0.25 * dense.h;  // a series holds beyond the step, too
    const double d = std::max(dense.h * stencil, std::min(min_stencil, longest));
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
    const Vec3<T> shoulder = shoulder_position(plant.arm, p), elbow = elbow_position(plant.arm, p);
    const T link3 = passes_through(plant.wall, wall, elbow, tip_position(plant.arm, p));
    return max(passes_through(plant.wall, wall, shoulder, elbow), T(link3 - touches));
}

// ---- state and reference of the controller

template <class T>
ARM3R_INLINE void set_inputs(const RowContext& context, RightHandSide<double, T>& rhs) {
    rhs.law_function = compiled_law<double, T>();
    rhs.contact = T(context.inputs.contact);
    rhs.force_phase = T(context.inputs.force_phase);
}

template <class T>
ARM3R_INLINE Vec3<T> torque_with_memory(RightHandSide<double, T>& rhs, const T& t, const WallState<T>& wall,
                                        const Pose<T>& p, const State<T, full_size>& y, const Vec3<T>& f_on_tip) {
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

// ---- the columns

template <class T>
struct RowValues {
    std::array<T, column_count> value;  // set where the plan has the column
    T link_behind_wall;
};

// The first N components of the sum of a power series, as DenseOutput::component has them; the sums stay in registers.
template <std::size_t N, class T>
ARM3R_INLINE void sum_series(const DenseOutput& dense, const T& seconds, State<T, full_size>& y) {
    std::array<T, N> sum;
    for (std::size_t i = 0; i < N; ++i) sum[i] = T(dense.c[dense.order][i]);
    for (int k = dense.order - 1; k >= 0; --k)
        for (std::size_t i = 0; i < N; ++i) sum[i] = sum[i] * seconds + dense.c[k][i];
    for (std::size_t i = 0; i < N; ++i) y[i] = sum[i];
}

// The solution at several instants of a step. Where the plan needs no energy, and no controller has memory in the state,
// the quadratures are 0.
template <class T>
ARM3R_INLINE State<T, full_size> state_for_row(const RowContext& context, const T& theta) {
    const DenseOutput& dense = context.dense;
    State<T, full_size> y;
    for (std::size_t i = motion_size; i < full_size; ++i) y[i] = T(0.0);
    const bool has_memory = dense.size > state_size;
    const std::size_t needed = has_memory || context.needs(energy_terms | losses) ? dense.size : motion_size;
    const bool is_series = dense.order >= 0 && !has_memory;
    if (is_series && needed == motion_size) sum_series<motion_size>(dense, theta * dense.h, y);
    else if (is_series) sum_series<state_size>(dense, theta * dense.h, y);
    else
        for (std::size_t i = 0; i < needed; ++i) y[i] = dense.component(i, theta);
    return y;
}

// Writes values into the columns of their names; vectors into three, of which the first is named. Joint vectors are in
// the slide convention.
template <class T>
class RowWriter {
public:
    ARM3R_INLINE RowWriter(RowValues<T>& row, const JointConvention& convention)
        : value_(row.value), convention_(convention) {}

    ARM3R_INLINE void number(ColumnIndex column, const T& x) { put(column, x); }
    ARM3R_INLINE void vector(ColumnIndex first, const Vec3<T>& v) {
        for (std::size_t i = 0; i < 3; ++i) put(first + i, v[i]);
    }
    ARM3R_INLINE void angles(ColumnIndex first, const Vec3<T>& q) { vector(first, convention_.from_slide(q)); }
    ARM3R_INLINE void joints(ColumnIndex first, const Vec3<T>& v) { vector(first, convention_.flipped(v)); }

private:
    ARM3R_INLINE void put(std::size_t column, const T& x) { value_[column] = x + 0.0; }  // + 0.0: no negative zero

    std::array<T, column_count>& value_;
    const JointConvention& convention_;
};

// Arm, wall and the force between them at the instant of a row.
template <class T>
struct RowState {
    T t;  // s
    Vec3<T> q, qd;
    Pose<T> pose;
    WallState<T> wall = no_wall<T>();
    Indentation<T> in{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    ContactForce<T> force = no_contact<T>();
    T touches{0.0};
    Vec3<T> felt, at_tip;            // N, on the tip: what the arm feels, and what a sensor there would
    Vec3<T> tau = zero_vector<T>();  // N m
};

template <class T>
ARM3R_INLINE void find_contact(const RowContext& context, RowState<T>& now, T& link_behind_wall) {
    const Plant<double>& plant = context.plant;
    if (plant.has_wall) {
        now.wall = wall_at(plant.wall, now.t);
        now.in = tip_indentation(plant, now.wall, now.pose, now.qd);
        now.force = force_of(plant, now.wall, now.in, context.mode);
        if (is_touching(context.mode)) now.touches = select(now.in.depth > T(0.0), T(1.0), T(0.0));
        if (context.is_judged()) link_behind_wall = link_behind(plant, now.wall, now.pose, now.touches);
    }
    now.felt = plant.acts_on_arm ? now.force.on_tip : zero_vector<T>();
    now.at_tip = now.force.on_tip;
    if (!plant.external_force.on) return;
    const Vec3<T> external_force = external_force_at(plant.external_force, now.t);
    now.felt = plus(now.felt, external_force);
    now.at_tip = plus(now.at_tip, external_force);
}

template <class T>
ARM3R_INLINE void write_motion(const RowContext& context, const RowState<T>& now, const T& theta, RowWriter<T>& write) {
    const Arm<double>& arm = context.plant.arm;
    write.joints("tau1", now.tau);
    if (context.needs(acceleration)) write.joints("qdd1", forward_dynamics(arm, now.pose, now.qd, now.tau, now.felt));
    if (context.needs(gravity_part)) write.joints("tau_g1", gravity_torque(arm, now.pose));
    if (context.needs(transform_sensor)) {
        const TipSensor<T> sensor = tip_sensor(arm, now.q, now.qd);
        write.vector("tip_x", sensor.position);
        write.vector("tip_vx", sensor.velocity);
    }
    if (context.needs(jacobian_velocity)) write.vector("tip_jvx", times(jacobian(arm, now.pose), now.qd));
    if (context.needs(differentiated_position)) write.vector("tip_dvx", differentiated_tip(arm, context.dense, theta));
}

template <class T>
ARM3R_INLINE void write_contact(const RowState<T>& now, RowWriter<T>& write) {
    const Vec3<T>& f = now.force.on_tip;
    write.vector("wall_x", now.wall.position);
    write.number("depth", now.in.depth);
    write.number("contact", now.touches);
    write.vector("f_on_tip_x", f);
    write.vector("f_on_wall_x", {-f[0], -f[1], -f[2]});
}

template <class T>
ARM3R_INLINE void write_energy(const RowContext& context, const RowState<T>& now, const State<T, full_size>& y,
                               RowWriter<T>& write) {
    const Plant<double>& plant = context.plant;
    const T kinetic = kinetic_energy(plant.arm, now.pose, now.qd);
    const T stored = plant.acts_on_arm ? now.force.stored : T(0.0);
    write.number("energy_kinetic", kinetic);
    write.number("energy_potential", potential_energy(plant.arm, now.pose));
    write.number("energy_contact", stored);
    write.number("work_actuators", y[work_of_actuators]);
    write.number("work_wall", y[work_of_wall]);
    write.number("energy_dissipated", y[dissipated]);
    const T energy = kinetic + potential_energy_of_pose(plant.arm, now.pose) + stored;
    write.number("energy_residual", energy_residual(y, energy, context.energy_at_start));
}

template <class T>
ARM3R_INLINE void write_law(const RowContext& context, const Measurement<T>& sensed, const ContactForce<T>& force,
                            RowWriter<T>& write) {
    const Controller<double>& law = context.controller;
    write.number("force", force.normal);
    write.number("force_measured", dot(sensed.n, sensed.f_on_tip));
    write.number("force_ref", tracks_force(law.type) ? desired_force_at(law.reference, sensed.t) : T(0.0));
    write.number("force_phase", sensed.force_phase);
    const Vec3<T> desired =
        tracks_path(law.type) ? desired_motion_at(law.reference, sensed.t).position : zero_vector<T>();
    write.vector("tip_ref_x", law.reference.in_joints ? zero_vector<T>() : desired);
    if (law.reference.in_joints) write.angles("q_ref1", desired);
    else write.vector("q_ref1", zero_vector<T>());
}

template <class T>
ARM3R_INLINE void write_observer(const RowContext& context, const RightHandSide<double, T>& rhs, const RowState<T>& now,
                                 const State<T, full_size>& y, RowWriter<T>& write) {
    const bool continuous = !context.is_sampled && context.plant.observer.on;
    const Vec3<T> r =
        continuous ? rhs.residual_at(now.pose, now.qd, y) : broadcast<T>(context.controller_state.residual);
    write.joints("residual1", r);
    const Arm<double>& model = context.controller.model;
    // A sampled observer reads encoders.
    const Pose<T> seen = context.is_sampled ? pose(broadcast<T>(context.controller_state.q)) : now.pose;
    const auto regular = distance_to_singular(model, seen) > T(1e-3);
    const Vec3<T> f = force_from(model, seen, r);
    write.vector("f_estimate_x",
                 {select(regular, f[0], T(0.0)), select(regular, f[1], T(0.0)), select(regular, f[2], T(0.0))});
    write.number("collision", T(context.controller_state.collision));
}

template <class T>
ARM3R_INLINE void write_memory(const RowContext& context, const RowState<T>& now, const State<T, full_size>& y,
                               RowWriter<T>& write) {
    const double touches = is_touching(context.mode) ? 1 : 0;  // an estimate lives for one contact
    write.number("stiffness_estimate", T(touches * context.controller_state.stiffness));
    write.number("stiffness_sigma", T(touches * context.controller_state.stiffness_sigma));
    write.number("wall_speed_estimate", T(touches * context.controller_state.wall_speed));
    write.number("identifiable", T(touches * context.controller_state.identifiable));
    write.number("tank_energy", context.is_sampled ? T(context.controller_state.memory[0]) : y[law_at]);
    T saturated(0.0);
    for (int i = 0; i < 3; ++i)
        saturated = select(abs(now.tau[i]) >= T(context.plant.arm.torque_limit[i]), T(1.0), saturated);
    write.number("saturated", saturated);
}

template <class T>
ARM3R_INLINE void fill_row(const RowContext& context, const T& row_time, const State<T, full_size>& y, const T& theta,
                           RowValues<T>& row) {
    const Plant<double>& plant = context.plant;
    RowState<T> now;
    now.t = max(row_time, T(context.dense.t0));  // no row is before the start of its step, nor just before a jump
    for (const double jump : context.jumps)
        now.t = select(abs(now.t - jump) <= T(context.clock_rounding), max(now.t, T(jump)), now.t);
    now.q = {y[0], y[1], y[2]};
    now.qd = {y[3], y[4], y[5]};
    row.link_behind_wall = T(0.0);
    RowWriter<T> write(row, context.convention);
    write.number("t", row_time);
    write.angles("q1", now.q);
    write.joints("qd1", now.qd);
    if (context.plan.parts == 0) return;
    now.pose = pose(now.q);
    find_contact(context, now, row.link_behind_wall);
    RightHandSide<double, T> rhs(plant);
    if (has_memory(plant)) set_inputs(context, rhs);
    if (context.needs(applied_torque))
        now.tau = has_memory(plant) ? torque_with_memory(rhs, now.t, now.wall, now.pose, y, now.at_tip)
                                    : torque_without_memory(plant, now.q, now.pose);

    write_motion(context, now, theta, write);
    write_contact(now, write);
    if (context.needs(energy_terms)) write_energy(context, now, y, write);
    if (context.needs(law_signals)) {
        const Measurement<T> sensed =
            measurement_of(context, rhs, now.t, now.wall, now.pose, now.q, now.qd, now.at_tip, y);
        write_law(context, sensed, now.force, write);
    }
    if (context.needs(observer_signals)) write_observer(context, rhs, now, y, write);
    if (context.needs(memory_signals)) write_memory(context, now, y, write);
    if (!context.needs(losses)) return;
    const auto [joints, in_contact, friction, edges] = dissipated_parts(plant, y, context.lost_at_edges);
    write.number("energy_dissipated_joints", joints);
    write.number("energy_dissipated_contact", in_contact);
    write.number("energy_dissipated_friction", friction);
    write.number("energy_dissipated_edges", edges);
}

}  // namespace arm3r
