#pragma once
// The parts of a controller: its law, its gains, its model of the arm, which may be wrong, and its reference. The laws
// themselves are in control_laws.hpp. Slide convention, base axes.

#include <array>

#include "arm3r/control/law_table.hpp"
#include "arm3r/control/reference.hpp"
#include "arm3r/model/dynamics.hpp"
#include "arm3r/model/recursion.hpp"
#include "arm3r/numbers/name.hpp"

namespace arm3r {

enum class Algorithm { closed_form, recursion };
enum class Variant { dynamic, jacobian_transpose, projected, raibert_craig };
enum class ForceTerm { cancelled, feedforward };
enum class AntiWindup { none, conditional, back_calculation };
enum class Switching { in_contact, latched, always };
enum class Inner { exact, position, joint_pd };
enum class Adaptation { integral, indirect };
enum class Saturation { clamp, scale };

template <class P>
struct Gains {
    Vec3<P> joint_stiffness, joint_damping;             // N m/rad, N m s/rad
    Vec3<P> position, velocity;                         // 1/s^2, 1/s
    Vec3<P> mass, stiffness, damping;                   // kg, N/m, N s/m, along the base axes
    P force_mass, force_damping;                        // kg, N s/m, along the normal
    P force, force_integral;                            // 1, 1/s
    P integral_limit, tracking_time;                    // N s, s
    P contact_on, contact_off;                          // N
    P inner_bandwidth, inner_damping_ratio;             // rad/s, 1
    P reference_gain;                                   // m/(N s)
    P assumed_stiffness;                                // N/m
    P stiffness_amplitude, stiffness_frequency;         // N/m, Hz
    P tank_energy, tank_low, tank_high, tank_capacity;  // J
    Vec3<P> plane_point, plane_normal;                  // m; unit
};

template <Name path>
struct KeyOf {};

// Every gain with its key in a scenario: calls number(key, x...) or vector(key, v...) with the gain of each of `gains`,
// which may have different number types.
template <class F, class V, class... G>
ARM3R_INLINE void each_gain(F number, V vector, G&... gains) {
    vector(KeyOf<"controller.joint_stiffness">{}, gains.joint_stiffness...);
    vector(KeyOf<"controller.joint_damping">{}, gains.joint_damping...);
    vector(KeyOf<"controller.position_gain">{}, gains.position...);
    vector(KeyOf<"controller.velocity_gain">{}, gains.velocity...);
    vector(KeyOf<"controller.mass">{}, gains.mass...);
    vector(KeyOf<"controller.stiffness">{}, gains.stiffness...);
    vector(KeyOf<"controller.damping">{}, gains.damping...);
    number(KeyOf<"controller.force_mass">{}, gains.force_mass...);
    number(KeyOf<"controller.force_damping">{}, gains.force_damping...);
    number(KeyOf<"controller.force_gain">{}, gains.force...);
    number(KeyOf<"controller.force_integral_gain">{}, gains.force_integral...);
    number(KeyOf<"controller.integral_limit">{}, gains.integral_limit...);
    number(KeyOf<"controller.tracking_time">{}, gains.tracking_time...);
    number(KeyOf<"controller.contact_on">{}, gains.contact_on...);
    number(KeyOf<"controller.contact_off">{}, gains.contact_off...);
    number(KeyOf<"controller.inner_bandwidth">{}, gains.inner_bandwidth...);
    number(KeyOf<"controller.inner_damping_ratio">{}, gains.inner_damping_ratio...);
    number(KeyOf<"controller.reference_gain">{}, gains.reference_gain...);
    number(KeyOf<"controller.assumed_stiffness">{}, gains.assumed_stiffness...);
    number(KeyOf<"controller.stiffness_amplitude">{}, gains.stiffness_amplitude...);
    number(KeyOf<"controller.stiffness_frequency">{}, gains.stiffness_frequency...);
    number(KeyOf<"controller.tank_energy">{}, gains.tank_energy...);
    number(KeyOf<"controller.tank_low">{}, gains.tank_low...);
    number(KeyOf<"controller.tank_high">{}, gains.tank_high...);
    number(KeyOf<"controller.tank_capacity">{}, gains.tank_capacity...);
    vector(KeyOf<"controller.plane_point">{}, gains.plane_point...);
    vector(KeyOf<"controller.plane_normal">{}, gains.plane_normal...);
}

// The choices, which are the same in all lanes.
struct ControllerChoices {
    ControllerType type = ControllerType::none;
    Algorithm algorithm = Algorithm::closed_form;  // for gravity_compensation
    Variant variant = Variant::dynamic;
    ForceTerm force_term = ForceTerm::cancelled;
    AntiWindup anti_windup = AntiWindup::none;
    Switching switching = Switching::in_contact;
    Inner inner = Inner::exact;
    Adaptation adaptation = Adaptation::integral;
    Saturation saturation = Saturation::clamp;
    bool compensates_gravity = false, cancels_force = false, ideal_cancellation = false, has_tank = false,
         controls_passivity = false;

    bool operator==(const ControllerChoices&) const = default;
};

// Whether the law uses the wall stiffness of the estimator as soon as the estimate is valid.
inline bool asks_estimator(const ControllerChoices& law) {
    return law.type == ControllerType::adaptive_reference && law.adaptation == Adaptation::indirect;
}

// Whether the law controls the force from now on, 1 or 0: always, in contact, or since the first contact (7.4).
template <class T>
ARM3R_INLINE T force_phase_after(Switching switching, const T& contact, const T& before) {
    if (switching == Switching::in_contact) return contact;
    return switching == Switching::latched ? T(max(before, contact)) : T(1.0);
}

template <class P>
struct Controller : ControllerChoices {
    Vec3<P> torque;  // N m, for constant
    Gains<P> gains;
    Reference<P> reference;
    Arm<P> model;  // the controller's copy; its gravity is what it compensates
};

// ---- input and output of a law

// The measurements of a controller at an instant. If the sensors are perfect, they are the true values.
template <class T>
struct Measurement {
    T t;                  // s
    Vec3<T> q, qd;        // rad, rad/s
    Pose<T> pose;         // of q
    Vec3<T> f_on_tip;     // N, measured
    Vec3<T> f_cancelled;  // N, what a law may cancel: the measured one, or the true one with ideal_cancellation
    Vec3<T> n;            // unit, from the wall towards the arm; the pressing direction is -n
    T face;               // m, n . (a point of the wall's face)
    T contact;            // 1: the controller assumes that the tip is in contact; else 0
    T force_phase;        // 1: the law controls the force along n; 0: the tip follows the reference along n too
};

template <class T>
struct Command {
    Vec3<T> tau;                      // N m, before the limit
    std::array<T, law_memory> rates;  // of the law's memory, 1/s each
    Vec3<T> dtau_dintegral;           // N m/(N s), d tau/d memory[0]: anti-windup needs it
};

template <class P, class T>
using LawFunction = void (*)(const Controller<P>&, const Measurement<T>&, const std::array<T, law_memory>&,
                             Command<T>&);

// ---- torques without gains

template <class P, class T>
ARM3R_INLINE Vec3<T> feedforward_torque(const Controller<P>& controller, const Vec3<T>& q, const Pose<T>& p) {
    if (controller.type == ControllerType::gravity_compensation)
        return controller.algorithm == Algorithm::closed_form ? gravity_torque(controller.model, p)
                                                              : recursion_gravity_torque(controller.model, q);
    if (controller.type == ControllerType::constant) return broadcast<T>(controller.torque);
    return {T(0.0), T(0.0), T(0.0)};
}

// The torque that the actuators can apply: each joint is limited by itself, or all are scaled by one factor.
template <class P, class T>
ARM3R_INLINE Vec3<T> limited(const Arm<P>& arm, const Vec3<T>& tau, Saturation saturation) {
    if (!arm.has_torque_limit) return tau;
    const auto clamped = [&](int i) ARM3R_INLINE_LAMBDA {
        return T(max(min(tau[i], T(arm.torque_limit[i])), T(-arm.torque_limit[i])));
    };
    if (saturation == Saturation::clamp) return {clamped(0), clamped(1), clamped(2)};
    Vec3<T> share;
    for (int i = 0; i < 3; ++i) {
        const T size = abs(tau[i]), limit(arm.torque_limit[i]);
        share[i] = select(size > limit, T(limit / size), T(1.0));
    }
    const T factor = min(min(share[0], share[1]), share[2]);
    const auto scaled = [&](int i)
                            ARM3R_INLINE_LAMBDA { return select(share[i] == factor, clamped(i), T(factor * tau[i])); };
    return {scaled(0), scaled(1), scaled(2)};
}

// The rate of an integral of the force error that does not leave its limit (7.5).
template <class P, class T>
ARM3R_INLINE T within_limit(const Gains<P>& gains, const T& integral, const T& rate) {
    const T o(0.0), limit(gains.integral_limit);
    const auto full = (integral >= limit && rate > o) || (integral <= -limit && rate < o);
    return select(full, o, rate);
}

// The controller's output: the torque of the law after the limit of the actuators. Anti-windup corrects the rate of the
// law's integral by the difference of the two (7.5).
template <class P, class T>
ARM3R_INLINE Vec3<T> actuated(const Arm<P>& arm, const Controller<P>& controller, const T& integral,
                              Command<T>& command) {
    const Vec3<T> output = limited(arm, command.tau, controller.saturation);
    if (controller.anti_windup == AntiWindup::none) return output;
    const Vec3<T> lack = minus(output, command.tau);
    const T windup_correction = dot(command.dtau_dintegral, lack);
    T& rate = command.rates[0];
    if (controller.anti_windup == AntiWindup::conditional) {
        rate = select(windup_correction * rate < T(0.0), T(0.0), rate);
    } else {
        const T size = max(dot(command.dtau_dintegral, command.dtau_dintegral), T(1e-300));
        rate = within_limit(controller.gains, integral,
                            T(rate + windup_correction / (size * controller.gains.tracking_time)));
    }
    return output;
}

}  // namespace arm3r
