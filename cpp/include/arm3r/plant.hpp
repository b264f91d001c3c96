#pragma once
// Arm, wall and controller together: the right-hand side of the equation of motion, with the energy books beside it (4.9).

#include <limits>

#include "arm3r/control/laws.hpp"
#include "arm3r/model/contact.hpp"
#include "arm3r/ode/integrators.hpp"
#include "arm3r/sensing/observer.hpp"
#include "arm3r/sensing/sampling.hpp"

namespace arm3r {

// q, qd, and the quadratures of the energy balance since the start (4.9): work of the actuators, work of the wall's drive,
// dissipated energy, and the parts of the latter that went into the joints and into friction along the wall.
enum : std::size_t {
    motion_size = 6,
    work_of_actuators = motion_size,
    work_of_wall,
    dissipated,
    dissipated_in_joints,
    dissipated_in_friction,
    state_size,
    ledger_size = state_size - motion_size,
    ledger_parts = state_size - dissipated_in_joints,  // the last of them, which are parts of another one
};

// And, where a continuous controller remembers something, its law's memory, the observer's, and the filtered force.
enum : std::size_t {
    law_at = state_size,
    observer_at = law_at + law_memory,
    filter_at = observer_at + 3,
    full_size = filter_at + 3,
};

enum class Touch {
    none,        // the tip is free, or behind the plate without having come through its face
    pressed,     // in contact: the law holds, smoothly continued past the instants at which contact ends
    released,    // inside a wall that would have to pull: no force, and what the dent still holds is lost
    each_stage,  // fixed steps: contact is wherever the tip is inside, asked anew at each stage
};

template <class P>
struct Plant {
    Arm<P> arm;
    Wall<P> wall;
    Contact<P> contact;
    Controller<P> controller;  // a digital one is, between its samples, a constant torque
    Sensors<P> sensors;        // of a continuous one: bias and analog filter
    Observer<P> observer;      // beside a continuous one
    TipLoad<P> load;
    bool has_wall = false, acts_on_arm = false;
    bool needs_azimuth = false;  // something beside gravity and wall looks at q1
};

// Whether a continuous controller or filter looks at the contact.
template <class P>
bool senses_wall(const Plant<P>& plant) {
    return plant.has_wall && (has_law(plant.controller.type) || plant.sensors.has_analog_filter);
}

// Whether the state has the memory of such ones.
template <class P>
bool has_memory(const Plant<P>& plant) {
    return has_law(plant.controller.type) || plant.observer.on || plant.sensors.has_analog_filter;
}

// Whether the contact itself turns energy into heat: by damping, or where springs along the plate let go.
template <class P>
bool dissipates_in_contact(const Plant<P>& plant) {
    return plant.acts_on_arm && (is_damped(plant.contact.law) || plant.contact.law == Law::diagonal);
}

template <class P>
bool can_lose_energy(const Plant<P>& plant) {
    const bool loses_in_joints = plant.arm.has_damping || plant.arm.has_dry_friction;
    const bool loses_at_wall = plant.contact.has_friction || plant.wall.has_outline;
    return loses_in_joints || dissipates_in_contact(plant) || (plant.acts_on_arm && loses_at_wall);
}

// The tip as the wall sees it (4.3), (4.4), (4.7).
template <class P, class T>
ARM3R_INLINE Indentation<T> tip_indentation(const Plant<P>& plant, const WallState<T>& wall, const Pose<T>& p,
                                            const Vec3<T>& qd) {
    return indentation(plant.wall, wall, tip_position(plant.arm, p), tip_velocity(plant.arm, p, qd));
}

// The derivative of the state. N is motion_size for the motion alone, state_size with the books, full_size with memory.
template <class P, class T>
class RightHandSide {
public:
    explicit RightHandSide(const Plant<P>& plant)
        : plant_(plant),
          needs_azimuth_(!plant.arm.gravity_is_vertical || !plant.controller.model.gravity_is_vertical ||
                         plant.has_wall || plant.needs_azimuth) {}

    Touch touch = Touch::none;
    T contact{0.0}, force_phase{0.0};  // what a continuous controller takes them for (Sensed), constant within a step
    LawFunction<P, T> law_function = nullptr;           // of a continuous controller that has one: law_by_template
    T latest{std::numeric_limits<double>::infinity()};  // s: just before a jump on which the step ends (5.8)

    // The stages of a step are turned from the sines and cosines at the nearest point of a grid of angles (elementary.hpp,
    // sincos_near), which change so rarely that they are kept. What is kept never changes a result: it is that of the point.
    template <std::size_t N>
    ARM3R_INLINE void begin_step(const State<T, N>& y) {
        const Vec3<T> nearest(on_grid(y[0]), on_grid(y[1]), on_grid(T(y[1] + y[2])));
        auto is_kept = nearest[1] == anchor_q_[1] && nearest[2] == anchor_q_[2];
        if (needs_azimuth_) is_kept = is_kept && nearest[0] == anchor_q_[0];
        if (all(is_kept)) return;
        move_anchor(nearest);
    }

    template <std::size_t N>
    ARM3R_INLINE void operator()(const T& t, const State<T, N>& y, State<T, N>& dy) const {
        const T seen = min(t, latest);
        WallState<T> wall;  // where nobody looks at it, nothing
        if (senses_wall(plant_) || (plant_.acts_on_arm && touch != Touch::none)) wall = wall_at(plant_.wall, seen);
        derivative(seen, wall, pose_near(y), y, dy);
    }

    // The same where the pose is known, and the wall unless it is not felt.
    template <std::size_t N>
    ARM3R_INLINE void derivative(const T& t, const WallState<T>& wall, const Pose<T>& p, const State<T, N>& y,
                                 State<T, N>& dy) const {
        Indentation<T> in;
        if (feels())
            in = is_plain(plant_.wall, plant_.contact)
                     ? indentation_at_rest(plant_.wall, wall, tip_position(plant_.arm, p))
                     : tip_indentation(plant_, wall, p, Vec3<T>(y[3], y[4], y[5]));
        Vec3<T> tau;
        derivative(t, wall, p, in, y, dy, tau);
    }

    // The same where the indentation is known too; and the torque that is applied.
    template <std::size_t N>
    ARM3R_INLINE void derivative(const T& t, const WallState<T>& wall, const Pose<T>& p, const Indentation<T>& in,
                                 const State<T, N>& y, State<T, N>& dy, Vec3<T>& tau) const {
        const Vec3<T> q(y[0], y[1], y[2]), qd(y[3], y[4], y[5]);
        const Arm<P>& arm = plant_.arm;
        Feeling feeling;
        if (feels()) feel(wall, p, in, feeling);
        const Vec3<T> load = plant_.load.on ? load_at(plant_.load, t) : none<T>();
        tau = torque(t, wall, p, q, qd, plant_.load.on ? plus(feeling.on_tip, load) : feeling.on_tip, y, dy);
        const Vec3<T> tau_f = friction_torque(arm, qd);
        Vec3<T> drive = minus(compensates_weight() ? none<T>() : tau, tau_f);
        T outer_power(0.0), contact_loss(0.0), friction_loss(0.0);
        if (plant_.acts_on_arm && feeling.anything) {
            drive = plus(drive, tip_force_torque(arm, p, feeling.on_tip));
            outer_power = feeling.wall_power;
            contact_loss = feeling.loss;
            friction_loss = feeling.friction_loss;
        }
        if (plant_.load.on) {
            drive = plus(drive, tip_force_torque(arm, p, load));
            outer_power = outer_power + dot(load, tip_velocity(arm, p, qd));
        }
        const Vec3<T> qdd = joint_acceleration(arm, p, qd, drive, weight_left(p));
        for (int i = 0; i < 3; ++i) {
            dy[i] = qd[i];
            dy[3 + i] = qdd[i];
        }
        if constexpr (N >= state_size) {
            const T joint_loss = dot(tau_f, qd);
            dy[work_of_actuators] = dot(tau, qd);
            dy[work_of_wall] = outer_power;
            dy[dissipated] = joint_loss + contact_loss;
            dy[dissipated_in_joints] = joint_loss;
            dy[dissipated_in_friction] = friction_loss;
        }
    }

    // The torque that is applied, and into dy the rates of the controller's memory.
    template <std::size_t N>
    ARM3R_INLINE Vec3<T> torque(const T& t, const WallState<T>& wall, const Pose<T>& p, const Vec3<T>& q,
                                const Vec3<T>& qd, const Vec3<T>& f_on_tip, const State<T, N>& y,
                                State<T, N>& dy) const {
        const Controller<P>& controller = plant_.controller;
        if constexpr (N < full_size) {
            return limited(plant_.arm, control(controller, q, p), controller.saturation);
        } else {
            Command<T> command;
            if (has_law(controller.type)) {
                const Sensed<T> sensed = sense(t, wall, p, q, qd, f_on_tip, y);
                std::array<T, law_memory> memory;
                for (std::size_t i = 0; i < law_memory; ++i) memory[i] = y[law_at + i];
                law_function(controller, sensed, memory, command);
            } else {
                command.tau = control(controller, q, p);
                command.rates.fill(T(0.0));
                command.per_integral = {T(0.0), T(0.0), T(0.0)};
            }
            const Vec3<T> tau = actuated(plant_.arm, controller, y[law_at], command);
            for (std::size_t i = 0; i < law_memory; ++i) dy[law_at + i] = command.rates[i];
            for (std::size_t i = observer_at; i < full_size; ++i) dy[i] = T(0.0);
            if (plant_.observer.on) {
                const Vec3<T> rate = expected_rate(controller.model, p, qd, tau, residual_at(p, qd, y));
                for (int i = 0; i < 3; ++i) dy[observer_at + i] = rate[i];
            }
            if (plant_.sensors.has_analog_filter)
                for (int i = 0; i < 3; ++i)
                    dy[filter_at + i] = plant_.sensors.analog_rate * (f_on_tip[i] - y[filter_at + i]);
            return tau;
        }
    }

    // What a continuous controller is told.
    ARM3R_INLINE Sensed<T> sense(const T& t, const WallState<T>& wall, const Pose<T>& p, const Vec3<T>& q,
                                 const Vec3<T>& qd, const Vec3<T>& f_on_tip, const State<T, full_size>& y) const {
        Vec3<T> measured = f_on_tip;
        if (plant_.sensors.has_analog_filter) measured = {y[filter_at], y[filter_at + 1], y[filter_at + 2]};
        if (plant_.sensors.has_bias) measured = plus(measured, lifted<T>(plant_.sensors.bias));
        const Vec3<T> n = plant_.has_wall ? normal(plant_.wall, wall) : none<T>();
        const T face = plant_.has_wall ? T(dot(n, wall.position) + plant_.wall.face_offset) : T(0.0);
        return {t, q,    qd,      p,          measured, plant_.controller.ideal_cancellation ? f_on_tip : measured,
                n, face, contact, force_phase};
    }

    // The momentum observer's estimate of the external torque.
    ARM3R_INLINE Vec3<T> residual_at(const Pose<T>& p, const Vec3<T>& qd, const State<T, full_size>& y) const {
        return residual(plant_.observer.gain, momentum(plant_.controller.model, p, qd),
                        Vec3<T>(y[observer_at], y[observer_at + 1], y[observer_at + 2]));
    }

    // The pose near the one of begin_step().
    template <std::size_t N>
    ARM3R_INLINE Pose<T> pose_near(const State<T, N>& y) const {
        const auto [second, third] =
            sincos_near_pair(anchor_q_[1], SinCos<T>{anchor_.S2, anchor_.C2}, y[1], anchor_q_[2],
                             SinCos<T>{anchor_.S23, anchor_.C23}, T(y[1] + y[2]));
        if (!needs_azimuth_) return {T(0.0), T(1.0), second.sin, second.cos, third.sin, third.cos};
        const SinCos<T> first = sincos_near(anchor_q_[0], SinCos<T>{anchor_.S1, anchor_.C1}, y[0]);
        return {first.sin, first.cos, second.sin, second.cos, third.sin, third.cos};
    }

private:
    // Whether the actuators do nothing but carry the weight of the controller's arm: they are then taken together with that
    // of the arm, so that nothing is left by rounding where the two are equal (3.8).
    ARM3R_INLINE bool compensates_weight() const {
        const Controller<P>& controller = plant_.controller;
        return controller.type == Controls::gravity_compensation && controller.algorithm == Algorithm::closed_form &&
               !plant_.arm.has_torque_limit;
    }
    ARM3R_INLINE Vec3<T> weight_left(const Pose<T>& p) const {
        const Vec3<T> weight = link_weight(plant_.arm, p);
        return compensates_weight() ? minus(weight, link_weight(plant_.controller.model, p)) : weight;
    }

    // What the wall does to the tip: nothing but where it touches.
    struct Feeling {
        bool anything = false;
        decltype(T(0.0) > T(0.0)) where = T(0.0) > T(0.0);
        Vec3<T> on_tip{T(0.0), T(0.0), T(0.0)};            // N
        T wall_power{0.0}, loss{0.0}, friction_loss{0.0};  // W; the last is a part of the loss
    };

    ARM3R_INLINE bool feels() const { return touch != Touch::none && (plant_.acts_on_arm || senses_wall(plant_)); }

    ARM3R_INLINE void feel(const WallState<T>& wall, const Pose<T>& p, const Indentation<T>& in,
                           Feeling& feeling) const {
        if (touch == Touch::each_stage) {
            feeling.where = in.depth > T(0.0);
            if (!any(feeling.where)) return;
            feeling.where = feeling.where && within(in);
        }
        const ContactForce<T> force = contact_force(plant_.wall, wall, plant_.contact, in, grip());
        feeling.anything = true;
        feeling.on_tip = force.on_tip;
        feeling.wall_power = dot(force.on_tip, velocity_at(plant_.wall, wall, tip_position(plant_.arm, p)));
        feeling.loss = force.dissipated;
        feeling.friction_loss = force.friction_loss;
        if (touch != Touch::each_stage) return;
        const T o(0.0);
        for (int i = 0; i < 3; ++i) feeling.on_tip[i] = select(feeling.where, feeling.on_tip[i], o);
        feeling.wall_power = select(feeling.where, feeling.wall_power, o);
        feeling.loss = select(feeling.where, feeling.loss, o);
        feeling.friction_loss = select(feeling.where, feeling.friction_loss, o);
    }

    ARM3R_INLINE static T on_grid(const T& angle) {
        constexpr double points_per_radian = 32;
        return nearest_integer(T(angle * points_per_radian)) * (1 / points_per_radian);
    }

    ARM3R_INLINE void move_anchor(const Vec3<T>& nearest) {
        const SinCos<T> first = sincos(nearest[0]), second = sincos(nearest[1]), third = sincos(nearest[2]);
        anchor_q_ = nearest;
        anchor_ = {first.sin, first.cos, second.sin, second.cos, third.sin, third.cos};
    }

    ARM3R_INLINE Grip grip() const {
        if (touch == Touch::each_stage) return Grip::clipped;
        return touch == Touch::released ? Grip::released : Grip::smooth;
    }

    ARM3R_INLINE auto within(const Indentation<T>& in) const {
        const T zero(0.0);
        return plant_.wall.has_outline ? inside_outline(plant_.wall, in) >= zero : zero >= zero;
    }

    const Plant<P>& plant_;
    bool needs_azimuth_;
    Vec3<T> anchor_q_{T(0.0), T(0.0), T(0.0)};
    Pose<T> anchor_{T(0.0), T(1.0), T(0.0), T(1.0), T(0.0), T(1.0)};
};

}  // namespace arm3r
