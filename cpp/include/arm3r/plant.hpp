#pragma once
// Arm, wall and controller together: the right-hand side of the equation of motion, with the energy quadratures (4.9).

#include <limits>

#include "arm3r/control/law_memory.hpp"
#include "arm3r/model/contact.hpp"
#include "arm3r/numbers/widths.hpp"
#include "arm3r/ode/integrators.hpp"
#include "arm3r/sensing/observer.hpp"
#include "arm3r/sensing/sampling.hpp"

namespace arm3r {

// The state is q, qd, and the quadratures of the energy balance since the start (4.9): work of the actuators, work of
// the wall's drive, dissipated energy, and the parts of the latter in the joints and in friction along the wall.
enum : std::size_t {
    motion_size = 6,
    work_of_actuators = motion_size,
    work_of_wall,
    dissipated,
    dissipated_in_joints,
    dissipated_in_friction,
    state_size,
    quadrature_count = state_size - motion_size,
    quadrature_parts = state_size - dissipated_in_joints,  // the last of them, which are parts of another one
    common_moving = dissipated,                            // what changes within a step of a plant of common terms
};

// A continuous controller with memory adds the memory of its law, that of its observer, and the filtered force.
enum : std::size_t {
    law_at = state_size,
    observer_at = law_at + law_memory,
    filter_at = observer_at + 3,
    full_size = filter_at + 3,
};

enum class ContactForceMode {
    none,        // the tip is free, or behind the plate without having crossed its face
    pressed,     // in contact: the contact law, smoothly continued past the instants at which contact ends
    each_stage,  // fixed steps: there is contact wherever the tip is inside, which each stage decides again
};

struct PlantChoices {
    bool holds_torque = false, has_wall = false, acts_on_arm = false;
    bool needs_azimuth = false;  // something besides gravity and wall depends on q1

    bool operator==(const PlantChoices&) const = default;
};

template <class P>
struct Plant : PlantChoices {
    Arm<P> arm;
    Wall<P> wall;
    Contact<P> contact;
    Controller<P> controller;  // a continuous one
    Vec3<P> held_torque;   // N m, where holds_torque: of a constant law, or of a sampled controller until its next one
    Sensors<P> sensors;    // of a continuous one: bias and analog filter
    Observer<P> observer;  // beside a continuous one
    ExternalForce<P> external_force;
};

// Whether a continuous controller or filter needs the contact force.
template <class P>
bool senses_wall(const Plant<P>& plant) {
    return plant.has_wall && (has_law(plant.controller.type) || plant.sensors.has_analog_filter);
}

// Whether the state contains a controller's memory.
template <class P>
bool has_memory(const Plant<P>& plant) {
    return has_law(plant.controller.type) || plant.observer.on || plant.sensors.has_analog_filter;
}

// Whether the contact itself dissipates energy: by damping, or when springs along the plate are released.
template <class P>
bool dissipates_in_contact(const Plant<P>& plant) {
    return plant.acts_on_arm && !is_spring(plant.contact.law);
}

template <class P>
bool can_lose_energy(const Plant<P>& plant) {
    const bool loses_in_joints = plant.arm.has_damping || plant.arm.has_dry_friction;
    const bool loses_at_wall = plant.contact.has_friction || plant.wall.has_outline;
    return loses_in_joints || dissipates_in_contact(plant) || (plant.acts_on_arm && loses_at_wall);
}

// What code that computes a plant's terms knows of them when it is compiled. `common`: the plant has common terms only, so
// that the code holds no others and asks for few.
enum class Terms { any, common };

// Whether gravity is along axis 1, the joints have no friction and the actuators no limit, nothing has a memory, and the wall,
// where there is one, stands still or moves at one velocity and is a plain spring.
template <class P>
bool has_common_terms(const Plant<P>& plant) {
    const auto is_common = [](const Arm<P>& arm) {
        return arm.gravity_is_vertical && !arm.has_damping && !arm.has_dry_friction && !arm.has_torque_limit;
    };
    const Wall<P>& wall = plant.wall;
    const bool has_common_wall = moves_evenly(wall) && is_plain_spring(wall, plant.contact);
    const bool has_known_torque = plant.holds_torque || plant.controller.type == ControllerType::none ||
                                  plant.controller.type == ControllerType::gravity_compensation;
    return is_common(plant.arm) && is_common(plant.controller.model) && (!plant.has_wall || has_common_wall) &&
           has_known_torque && plant.controller.algorithm == Algorithm::closed_form && !has_memory(plant) &&
           !plant.external_force.on;
}

// The torque of a controller without gains, before and after the limit of the actuators.
template <class P, class T>
ARM3R_INLINE Vec3<T> feedforward_torque(const Plant<P>& plant, const Vec3<T>& q, const Pose<T>& p) {
    return plant.holds_torque ? broadcast<T>(plant.held_torque) : feedforward_torque(plant.controller, q, p);
}
template <class P, class T>
ARM3R_INLINE Vec3<T> torque_without_memory(const Plant<P>& plant, const Vec3<T>& q, const Pose<T>& p) {
    return limited(plant.arm, feedforward_torque(plant, q, p), plant.controller.saturation);
}

// The tip as the wall sees it (4.3), (4.4), (4.7).
template <class P, class T>
ARM3R_INLINE Indentation<T> tip_indentation(const Plant<P>& plant, const WallState<T>& wall, const Pose<T>& p,
                                            const Vec3<T>& qd) {
    return indentation(plant.wall, wall, tip_position(plant.arm, p), tip_velocity(plant.arm, p, qd));
}

// The derivative of the state. N is motion_size for the motion alone, state_size with the quadratures, full_size with
// the controller's memory.
template <class P, class T>
class RightHandSide {
public:
    explicit RightHandSide(const Plant<P>& plant)
        : plant_(plant),
          needs_azimuth_(!plant.arm.gravity_is_vertical || !plant.controller.model.gravity_is_vertical ||
                         plant.has_wall || plant.needs_azimuth),
          common_(plant) {}

    // Of an equal plant: its own one stays.
    RightHandSide& operator=(const RightHandSide& other) {
        force_mode = other.force_mode, touching = other.touching, separated = other.separated;
        contact = other.contact, force_phase = other.force_phase, latest = other.latest;
        cached_q_ = other.cached_q_, cached_pose_ = other.cached_pose_, common_ = other.common_;
        return *this;
    }

    // Called when numbers of the plant have changed.
    ARM3R_INLINE void update_common_numbers() { common_ = CommonNumbers(plant_); }

    using Mask = decltype(T(0.0) >= T(0.0));

    ContactForceMode force_mode = ContactForceMode::none;
    // Of `pressed`: the lanes that touch, and those of them inside a wall that would have to pull: there the elastic
    // energy is lost, and there is no force.
    Mask touching = T(0.0) >= T(0.0), separated = T(0.0) > T(0.0);
    T contact{0.0}, force_phase{0.0};          // inputs of a continuous controller, constant within a step
    LawFunction<P, T> law_function = nullptr;  // the law of a continuous controller, or null
    // s: formulas of time are evaluated at this instant at the latest, just before a jump at the end of the step (5.8)
    T latest{infinite};

    // The stages of a step rotate the cached sines and cosines of the nearest point of a grid of angles
    // (elementary.hpp, sincos_near), which changes rarely. The cache never changes a result: the grid point depends on
    // the state only.
    template <std::size_t N>
    ARM3R_INLINE void begin_step(const State<T, N>& y) {
        const Vec3<T> nearest(needs_azimuth_ ? on_grid(y[0]) : cached_q_[0], on_grid(y[1]), on_grid(T(y[1] + y[2])));
        const T moved =
            abs(nearest[0] - cached_q_[0]) + (abs(nearest[1] - cached_q_[1]) + abs(nearest[2] - cached_q_[2]));
        if (in_all_lanes(moved == T(0.0))) return;
        if (needs_azimuth_) update_cached(0, nearest[0], cached_pose_.S1, cached_pose_.C1);
        update_cached(1, nearest[1], cached_pose_.S2, cached_pose_.C2);
        update_cached(2, nearest[2], cached_pose_.S23, cached_pose_.C23);
    }

    // What begin_step() has cached: the nearest points for q1 (if it is needed), q2 and q2 + q3.
    const Vec3<T>& angles_of_grid() const { return cached_q_; }
    const Pose<T>& pose_of_grid() const { return cached_pose_; }
    bool needs_azimuth() const { return needs_azimuth_; }

    template <std::size_t N>
    ARM3R_INLINE void operator()(const T& t, const State<T, N>& y, State<T, N>& dy) const {
        Vec3<T> tau;
        derivative_at<Terms::any>(t, y, dy, tau);
    }

    // The same for a plant of known terms, and the applied torque. With common terms the contact is decided at each stage,
    // if there is any.
    template <Terms terms, std::size_t N>
    ARM3R_INLINE void derivative_at(const T& t, const State<T, N>& y, State<T, N>& dy, Vec3<T>& tau) const {
        const T seen = min(t, latest);
        const Pose<T> p = pose_near(y);
        if constexpr (terms == Terms::common) {
            common_derivative(seen, p, y, dy, tau);
        } else {
            WallState<T> wall;  // left uninitialised if unused
            if (senses_wall(plant_) || (plant_.acts_on_arm && force_mode != ContactForceMode::none))
                wall = wall_state_at(seen);
            derivative_at_wall(seen, wall, p, y, dy, tau);
        }
    }

    // The same with a known pose, and with the wall if it is needed.
    template <std::size_t N>
    ARM3R_INLINE void derivative_at_wall(const T& t, const WallState<T>& wall, const Pose<T>& p, const State<T, N>& y,
                                         State<T, N>& dy, Vec3<T>& tau) const {
        Indentation<T> in;  // left uninitialised if unused
        if (needs_contact()) in = indentation_of(wall, p, Vec3<T>(y[3], y[4], y[5]));
        derivative(t, wall, p, in, y, dy, tau);
    }

    // The same with the indentation, if it is needed.
    template <std::size_t N>
    ARM3R_INLINE void derivative(const T& t, const WallState<T>& wall, const Pose<T>& p, const Indentation<T>& in,
                                 const State<T, N>& y, State<T, N>& dy, Vec3<T>& tau) const {
        const Vec3<T> q(y[0], y[1], y[2]), qd(y[3], y[4], y[5]);
        const Arm<P>& arm = plant_.arm;
        ContactLoad contact_load;
        if (needs_contact()) set_contact_load(wall, p, in, contact_load);
        const Vec3<T> external_force =
            plant_.external_force.on ? external_force_at(plant_.external_force, t) : zero_vector<T>();
        tau = torque(t, wall, p, q, qd,
                     plant_.external_force.on ? plus(contact_load.on_tip, external_force) : contact_load.on_tip, y, dy);
        const Vec3<T> tau_f = friction(qd);
        Vec3<T> drive = minus(compensates_weight() ? zero_vector<T>() : tau, tau_f);
        T outer_power(0.0), contact_loss(0.0), friction_loss(0.0);
        if (plant_.acts_on_arm && contact_load.anything) {
            drive = plus(drive, tip_force_torque(arm, p, contact_load.on_tip));
            outer_power = contact_load.wall_power;
            contact_loss = contact_load.loss;
            friction_loss = contact_load.friction_loss;
        }
        if (plant_.external_force.on) {
            drive = plus(drive, tip_force_torque(arm, p, external_force));
            outer_power = outer_power + dot(external_force, tip_velocity(arm, p, qd));
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

    // Whether anything does work on the arm but gravity.
    ARM3R_INLINE bool does_work() const {
        return plant_.holds_torque || plant_.acts_on_arm || plant_.controller.type != ControllerType::none;
    }

    // The same for a plant of common terms, whose contact is decided at each stage, if there is any. Nothing dissipates,
    // and these components of dy are not set.
    template <std::size_t N>
    ARM3R_INLINE void common_derivative(const T& t, const Pose<T>& p, const State<T, N>& y, State<T, N>& dy,
                                        Vec3<T>& tau) const {
        if (plant_.arm.is_elbow) return common_derivative_of<true>(t, p, y, dy, tau);
        common_derivative_of<false>(t, p, y, dy, tau);
    }

    template <bool is_elbow, std::size_t N>
    ARM3R_INLINE void common_derivative_of(const T& t, const Pose<T>& p, const State<T, N>& y, State<T, N>& dy,
                                           Vec3<T>& tau) const {
        const Vec3<T> qd(y[3], y[4], y[5]);
        Vec3<T> torque = torque_of_weight<is_elbow>(p);  // on q1, q2, q2 + q3
        T power(0.0), outer_power(0.0);
        if (plant_.holds_torque) {
            tau = broadcast<T>(plant_.held_torque);
            torque = {tau[0], torque[1] + (tau[1] - tau[2]), torque[2] + tau[2]};
            power = dot(tau, qd);
        } else if (plant_.controller.type == ControllerType::gravity_compensation) {
            const Vec3<T> assumed = vertical_weight<is_elbow>(plant_.controller.model, p);
            tau = {T(0.0), assumed[1] + assumed[2], assumed[2]};
            power = tau[1] * qd[1] + tau[2] * qd[2];
        } else {
            tau = zero_vector<T>();
        }
        if (plant_.acts_on_arm) {
            const PlateForce push = plate_force<is_elbow>(t, p);
            if (push.acts) {
                for (int i = 0; i < 3; ++i) torque[i] = torque[i] + push.torque[i];
                outer_power = push.power;
            }
        }
        const Vec3<T> qdd = acceleration_of<is_elbow>(p, qd, torque);
        for (int i = 0; i < 3; ++i) {
            dy[i] = qd[i];
            dy[3 + i] = qdd[i];
        }
        if constexpr (N >= state_size) {
            dy[work_of_actuators] = power;
            dy[work_of_wall] = outer_power;
        }
    }

    // Returns the applied torque and writes the rates of the controller's memory into dy.
    template <std::size_t N>
    ARM3R_INLINE Vec3<T> torque(const T& t, const WallState<T>& wall, const Pose<T>& p, const Vec3<T>& q,
                                const Vec3<T>& qd, const Vec3<T>& f_on_tip, const State<T, N>& y,
                                State<T, N>& dy) const {
        const Controller<P>& controller = plant_.controller;
        if constexpr (N < full_size) {
            return torque_without_memory(plant_, q, p);
        } else {
            Command<T> command;
            if (has_law(controller.type)) {
                const Measurement<T> sensed = measure(t, wall, p, q, qd, f_on_tip, y);
                std::array<T, law_memory> memory;
                for (std::size_t i = 0; i < law_memory; ++i) memory[i] = y[law_at + i];
                law_function(controller, sensed, memory, command);
            } else {
                command.tau = feedforward_torque(plant_, q, p);
                command.rates.fill(T(0.0));
                command.dtau_dintegral = {T(0.0), T(0.0), T(0.0)};
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

    // The measurements of a continuous controller.
    ARM3R_INLINE Measurement<T> measure(const T& t, const WallState<T>& wall, const Pose<T>& p, const Vec3<T>& q,
                                        const Vec3<T>& qd, const Vec3<T>& f_on_tip,
                                        const State<T, full_size>& y) const {
        Vec3<T> measured = f_on_tip;
        if (plant_.sensors.has_analog_filter) measured = {y[filter_at], y[filter_at + 1], y[filter_at + 2]};
        if (plant_.sensors.has_bias) measured = plus(measured, broadcast<T>(plant_.sensors.bias));
        const Vec3<T> n = plant_.has_wall ? normal(plant_.wall, wall) : zero_vector<T>();
        const T face = plant_.has_wall ? T(dot(n, wall.position) + plant_.wall.face_offset) : T(0.0);
        return {t, q,    qd,      p,          measured, plant_.controller.ideal_cancellation ? f_on_tip : measured,
                n, face, contact, force_phase};
    }

    // The state with the memory of a continuous controller at the start: filter and observer have settled. `truth` has
    // the true values; `contact` and `force_phase` are set.
    ARM3R_INLINE State<T, full_size> with_initial_memory(State<T, full_size> y, const WallState<T>& wall,
                                                         const Measurement<T>& truth) const {
        const Controller<P>& controller = plant_.controller;
        for (int i = 0; i < 3; ++i) y[filter_at + i] = truth.f_on_tip[i];
        if (has_law(controller.type)) {
            const Measurement<T> sensed = measure(truth.t, wall, truth.pose, truth.q, truth.qd, truth.f_on_tip, y);
            const std::array<T, law_memory> memory = memory_at_start(controller, sensed);
            for (std::size_t i = 0; i < law_memory; ++i) y[law_at + i] = memory[i];
        }
        const Vec3<T> p = momentum(controller.model, truth.pose, truth.qd);
        for (int i = 0; i < 3; ++i) y[observer_at + i] = p[i];
        return y;
    }

    // The momentum observer's estimate of the external torque.
    ARM3R_INLINE Vec3<T> residual_at(const Pose<T>& p, const Vec3<T>& qd, const State<T, full_size>& y) const {
        return residual(plant_.observer.gain, momentum(plant_.controller.model, p, qd),
                        Vec3<T>(y[observer_at], y[observer_at + 1], y[observer_at + 2]));
    }

    // The pose from the sines and cosines that begin_step() has cached.
    template <std::size_t N>
    ARM3R_INLINE Pose<T> pose_near(const State<T, N>& y) const {
        const Vec3<T>& base = cached_q_;
        const SinCos<T> at1{cached_pose_.S1, cached_pose_.C1}, at2{cached_pose_.S2, cached_pose_.C2},
            at3{cached_pose_.S23, cached_pose_.C23};
        const T third_angle = y[1] + y[2];
        if constexpr (Lanes<T>::count > 1) {
            if (needs_azimuth_) {
                using std::array;
                const auto [first, second, third] = sincos_near_each(
                    array<T, 3>{base[0], base[1], base[2]}, array{at1, at2, at3}, array<T, 3>{y[0], y[1], third_angle});
                return {first.sin, first.cos, second.sin, second.cos, third.sin, third.cos};
            }
            const auto [second, third] = sincos_near_each(std::array<T, 2>{base[1], base[2]}, std::array{at2, at3},
                                                          std::array<T, 2>{y[1], third_angle});
            return {T(0.0), T(1.0), second.sin, second.cos, third.sin, third.cos};
        } else {
            const auto [second, third] = sincos_near_pair(base[1], at2, y[1], base[2], at3, third_angle);
            if (!needs_azimuth_) return {T(0.0), T(1.0), second.sin, second.cos, third.sin, third.cos};
            const SinCos<T> first = sincos_near(base[0], at1, y[0]);
            return {first.sin, first.cos, second.sin, second.cos, third.sin, third.cos};
        }
    }

private:
    // sincos_near of several angles; a single test decides for all of them.
    template <std::size_t count>
    ARM3R_INLINE static std::array<SinCos<T>, count> sincos_near_each(const std::array<T, count>& base_angle,
                                                                      const std::array<SinCos<T>, count>& base,
                                                                      const std::array<T, count>& angle) {
        std::array<SinCos<T>, count> result;
        T farthest(0.0);
        for (std::size_t i = 0; i < count; ++i) {
            const T delta = angle[i] - base_angle[i];
            farthest = i == 0 ? abs(delta) : max(farthest, abs(delta));
            result[i] = sincos_rotated(base[i], delta);
        }
        if (!in_all_lanes(farthest <= T(sincos_near_limit)))
            for (std::size_t i = 0; i < count; ++i) result[i] = sincos_near(base_angle[i], base[i], angle[i]);
        return result;
    }

    template <bool is_elbow>
    ARM3R_INLINE static Vec3<T> vertical_weight(const Arm<P>& arm, const Pose<T>& p) {
        if constexpr (is_elbow) return elbow_arm::link_weight(arm, p);
        else return link_weight(arm.lumped, arm.gravity, true, p);
    }

    // What the terms of a plant of common terms need and does not depend on the state.
    struct CommonNumbers {
        LinkInertia<P> inertia;
        P weight2, weight3;  // N m: of link 2 and 3 along gravity, less what the actuators compensate
        P face, speed;       // m, m/s: the face along the normal, from above the base in the height of the shoulder
        struct OfElbow {
            Vec3<P> normal;                                // base axes
            P weight_x2, weight_y2, weight_x3, weight_y3;  // N m: first moments along gravity, less what is compensated
        } elbow;

        ARM3R_INLINE explicit CommonNumbers(const Plant<P>& plant)
            : inertia(plant.arm.lumped),
              weight2(plant.arm.lumped.G2 * plant.arm.gravity[2]),
              weight3(plant.arm.lumped.G3 * plant.arm.gravity[2]),
              face(plant.wall.face_offset +
                   (dot(plant.wall.n, plant.wall.point) - plant.wall.n[2] * plant.arm.base_height)),
              speed(plant.wall.motion == Motion::constant ? P(dot(plant.wall.n, plant.wall.velocity)) : P(0.0)) {
            if (plant.arm.is_elbow) {
                set_elbow(plant);
                return;
            }
            if (plant.holds_torque || plant.controller.type != ControllerType::gravity_compensation) return;
            const Arm<P>& model = plant.controller.model;
            weight2 = weight2 - model.lumped.G2 * model.gravity[2];
            weight3 = weight3 - model.lumped.G3 * model.gravity[2];
        }

        ARM3R_INLINE void set_elbow(const Plant<P>& plant) {
            const Arm<P>& arm = plant.arm;
            const P g = arm.elbow.gravity[2];
            face = plant.wall.face_offset + dot(plant.wall.n, minus(plant.wall.point, arm.elbow.position));
            elbow = {elbow_arm::to_base(arm, plant.wall.n), arm.lumped.G2 * g, arm.elbow.Gy2 * g, arm.lumped.G3 * g,
                     arm.elbow.Gy3 * g};
            if (plant.holds_torque || plant.controller.type != ControllerType::gravity_compensation) return;
            const Arm<P>& model = plant.controller.model;
            const P held = model.elbow.gravity[2];
            elbow.weight_x2 = elbow.weight_x2 - model.lumped.G2 * held;
            elbow.weight_y2 = elbow.weight_y2 - model.elbow.Gy2 * held;
            elbow.weight_x3 = elbow.weight_x3 - model.lumped.G3 * held;
            elbow.weight_y3 = elbow.weight_y3 - model.elbow.Gy3 * held;
        }
    };

    // The torques on the three angles of the weight along axis 1 that is not compensated.
    template <bool is_elbow>
    ARM3R_INLINE Vec3<T> torque_of_weight(const Pose<T>& p) const {
        const T o(0.0);
        if constexpr (is_elbow) {
            const auto& g = common_.elbow;
            return {o, g.weight_x2 * p.C2 - g.weight_y2 * p.S2, g.weight_x3 * p.C23 - g.weight_y3 * p.S23};
        } else {
            return {o, common_.weight2 * p.C2, common_.weight3 * p.C23};
        }
    }

    // torque: on q1, q2, q2 + q3, N m.
    template <bool is_elbow>
    ARM3R_INLINE Vec3<T> acceleration_of(const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& torque) const {
        const Arm<P>& arm = plant_.arm;
        if constexpr (is_elbow)
            return elbow_arm::acceleration_by_angle_torques(arm, p, elbow_arm::first_moments(arm, p), qd, torque);
        else return acceleration_by_link_torques(arm.lumped, common_.inertia, p, qd, torque);
    }

    // The push of an even plate with a plain spring on q1, q2, q2 + q3, N m, and its power, W.
    struct PlateForce {
        bool acts;
        Vec3<T> torque;
        T power;
    };

    // distance: of the tip along the plate's normal, m; torques_of_one(): those of 1 N along it, asked for where it presses.
    template <class F>
    ARM3R_INLINE PlateForce plate_force_by(const T& t, const Pose<T>& p, const T& distance, F torques_of_one) const {
        const Wall<P>& wall = plant_.wall;
        const T depth = (common_.face + common_.speed * t) - distance;
        auto where = depth > T(0.0);
        if (!in_any_lane(where)) return {false, {}, {}};
        if (wall.has_outline) {
            const WallState<T> state = even_wall_at(wall, t);
            where =
                where && inside_outline(wall, indentation_at_rest(wall, state, tip_position(plant_.arm, p))) >= T(0.0);
        }
        const T force = spring_law(plant_.contact, T(select(where, depth, T(0.0)))).elastic;
        const Vec3<T> one = torques_of_one();
        return {true, {one[0] * force, one[1] * force, one[2] * force}, force * common_.speed};
    }

    // In the plane of the links, whose horizontal direction is the radial one: (2.1) and (4.3), or (10.1).
    template <bool is_elbow>
    ARM3R_INLINE PlateForce plate_force(const T& t, const Pose<T>& p) const {
        const Arm<P>& arm = plant_.arm;
        const Vec3<P>& n = is_elbow ? common_.elbow.normal : plant_.wall.n;
        const T radial = p.C1 * n[0] + p.S1 * n[1], around = p.C1 * n[1] - p.S1 * n[0];
        if constexpr (is_elbow) {
            const elbow_arm::Reaches<T> m = elbow_arm::reaches(arm, p);
            const T distance = radial * elbow_arm::radius(arm, m) + around * arm.elbow.lateral + n[2] * (m.h2 + m.h3);
            return plate_force_by(t, p, distance, [&]() ARM3R_INLINE_LAMBDA {
                return elbow_arm::angle_torques(arm, m, Vec3<T>(radial, around, T(n[2])));
            });
        } else {
            const P &a2 = arm.link2.length, &a3 = arm.link3.length;
            const T r = a2 * p.C2 + a3 * p.C23, h = a2 * p.S2 + a3 * p.S23;
            return plate_force_by(t, p, T(radial * r + n[2] * h), [&]() ARM3R_INLINE_LAMBDA {
                return Vec3<T>(r * around, a2 * (p.C2 * n[2] - p.S2 * radial), a3 * (p.C23 * n[2] - p.S23 * radial));
            });
        }
    }

    // Whether the actuators only compensate the weight of the controller's model. Both weights are then subtracted from
    // each other, so that equal ones leave no rounding error (3.8).
    ARM3R_INLINE bool compensates_weight() const {
        const Controller<P>& controller = plant_.controller;
        return controller.type == ControllerType::gravity_compensation &&
               controller.algorithm == Algorithm::closed_form && !plant_.arm.has_torque_limit;
    }
    ARM3R_INLINE Vec3<T> weight_left(const Pose<T>& p) const {
        const Vec3<T> weight = link_weight(plant_.arm, p);
        return compensates_weight() ? minus(weight, link_weight(plant_.controller.model, p)) : weight;
    }

    // The effect of the wall on the tip; zero without contact.
    struct ContactLoad {
        bool anything = false;
        Mask where = T(0.0) > T(0.0);
        Vec3<T> on_tip{T(0.0), T(0.0), T(0.0)};            // N
        T wall_power{0.0}, loss{0.0}, friction_loss{0.0};  // W; the last is a part of the loss
    };

    ARM3R_INLINE bool needs_contact() const {
        return force_mode != ContactForceMode::none && (plant_.acts_on_arm || senses_wall(plant_));
    }

    ARM3R_INLINE void set_contact_load(const WallState<T>& wall, const Pose<T>& p, const Indentation<T>& in,
                                       ContactLoad& contact_load) const {
        const bool decides = force_mode == ContactForceMode::each_stage;
        contact_load.where = decides ? in.depth > T(0.0) : touching;
        if (!in_any_lane(contact_load.where)) return;
        if (decides) contact_load.where = contact_load.where && within(in);
        const ContactForce<T> force = contact_force_at(wall, in);
        contact_load.anything = true;
        contact_load.on_tip = force.on_tip;
        contact_load.wall_power = dot(force.on_tip, velocity_at(plant_.wall, wall, tip_position(plant_.arm, p)));
        contact_load.loss = force.dissipated;
        contact_load.friction_loss = force.friction_loss;
        if (!decides && in_all_lanes(contact_load.where)) return;
        const T o(0.0);
        for (int i = 0; i < 3; ++i) contact_load.on_tip[i] = select(contact_load.where, contact_load.on_tip[i], o);
        contact_load.wall_power = select(contact_load.where, contact_load.wall_power, o);
        contact_load.loss = select(contact_load.where, contact_load.loss, o);
        contact_load.friction_loss = select(contact_load.where, contact_load.friction_loss, o);
    }

    // What most plants do not have is a function call, so that its long code does not stand in each stage of a step. Its
    // arguments are copied, so that those of the rest stay in registers.
    template <class Result, class F, class... A>
    ARM3R_INLINE static Result called(F f, A... arguments) {
        Result result;
        Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { result = f(arguments...); });
        return result;
    }

    ARM3R_INLINE WallState<T> wall_state_at(const T& t) const {
        if (is_plain_motion(plant_.wall)) return plain_wall_at(plant_.wall, t);
        return called<WallState<T>>([this](const T& at) ARM3R_INLINE_LAMBDA { return wall_at(plant_.wall, at); }, t);
    }

    ARM3R_INLINE Vec3<T> friction(const Vec3<T>& qd) const {
        if (!plant_.arm.has_dry_friction) return viscous_torque(plant_.arm, qd);
        return called<Vec3<T>>(
            [this](const Vec3<T>& rate) ARM3R_INLINE_LAMBDA { return friction_torque(plant_.arm, rate); }, qd);
    }

    ARM3R_INLINE Indentation<T> indentation_of(const WallState<T>& wall, const Pose<T>& p, const Vec3<T>& qd) const {
        if (is_plain_spring(plant_.wall, plant_.contact))
            return indentation_at_rest(plant_.wall, wall, tip_position(plant_.arm, p));
        return called<Indentation<T>>([this](const WallState<T>& state, const Pose<T>& at, const Vec3<T>& rate)
                                          ARM3R_INLINE_LAMBDA { return tip_indentation(plant_, state, at, rate); },
                                      wall, p, qd);
    }

    ARM3R_INLINE ContactForce<T> contact_force_at(const WallState<T>& wall, const Indentation<T>& in) const {
        if (is_plain_spring(plant_.wall, plant_.contact))
            return plain_spring_force(plant_.wall, plant_.contact, in.depth);
        return called<ContactForce<T>>(
            [this](const WallState<T>& state, const Indentation<T>& inside) ARM3R_INLINE_LAMBDA {
                const auto force = [&](Clamping clamping) ARM3R_INLINE_LAMBDA {
                    return contact_force(plant_.wall, state, plant_.contact, inside, clamping);
                };
                const bool decides = force_mode == ContactForceMode::each_stage;
                if (decides || !in_any_lane(separated)) return force(decides ? Clamping::clamped : Clamping::smooth);
                const ContactForce<T> released = force(Clamping::released);
                return in_all_lanes(separated) ? released : selected(separated, released, force(Clamping::smooth));
            },
            wall, in);
    }

    ARM3R_INLINE static T on_grid(const T& angle) {
        constexpr double points_per_radian = 16;
        return nearest_integer(T(angle * points_per_radian)) * (1 / points_per_radian);
    }

    ARM3R_INLINE void update_cached(int i, const T& nearest, T& sine, T& cosine) {
        // Of packs all at once: which of them has another point is as good as random.
        if (Lanes<T>::count == 1 && in_all_lanes(nearest == cached_q_[i])) return;
        const SinCos<T> there = sincos(nearest);
        cached_q_[i] = nearest, sine = there.sin, cosine = there.cos;
    }

    ARM3R_INLINE auto within(const Indentation<T>& in) const {
        const T zero(0.0);
        return plant_.wall.has_outline ? inside_outline(plant_.wall, in) >= zero : zero >= zero;
    }

    const Plant<P>& plant_;
    bool needs_azimuth_;
    CommonNumbers common_;
    Vec3<T> cached_q_{T(0.0), T(0.0), T(0.0)};
    Pose<T> cached_pose_{T(0.0), T(1.0), T(0.0), T(1.0), T(0.0), T(1.0)};
};

}  // namespace arm3r
