#pragma once
// A stiffness that varies, paid for from a tank of energy that the damper fills; docs/model.md, section 7. memory[0]: what
// is in the tank, J. Ferraguti, Secchi and Fantuzzi 2013. Slide convention, base axes.

#include "arm3r/control/impedance_laws.hpp"

namespace arm3r {

// From 0 at `low` to 1 at `high`, smoothly.
template <class P, class T>
ARM3R_INLINE T opening(const T& level, const P& low, const P& high) {
    return minimum_jerk(T((level - low) / (high - low))).s;
}

// How far the tank may pay, and how far it may fill (7.19).
template <class T>
struct Valves {
    T out, in;
};

template <class P, class T>
ARM3R_INLINE Valves<T> valves(const Gains<P>& gains, const T& energy) {
    const P width = gains.tank_high - gains.tank_low;
    return {opening(energy, gains.tank_low, gains.tank_high),
            1.0 - opening(energy, P(gains.tank_capacity - width), gains.tank_capacity)};
}

// tau = tau_g + J^T (-D ed - K_0 e + w), w = -gamma(E) dK(t) e, e = x - x_d (7.19).
template <class P, class T>
ARM3R_INLINE void energy_tank(const Controller<P>& controller, const Sensed<T>& sensed, const T& energy,
                              Command<T>& command) {
    const Gains<P>& gains = controller.gains;
    const TipTask<T> tip = tip_task(controller, sensed);
    const T variation = gains.stiffness_amplitude * turned(T(gains.stiffness_frequency * sensed.t)).sin;
    const Vec3<T> damped = each_times(gains.damping, tip.error_rate);
    const Vec3<T> held = plus(damped, each_times(gains.stiffness, tip.error));
    const Valves<T> valve = controller.has_tank ? valves(gains, energy) : Valves<T>{T(1.0), T(0.0)};
    const Vec3<T> varied = scaled(T(valve.out * variation), tip.error);
    command.tau = pulling(controller.model, sensed.pose, plus(held, varied));
    if (controller.has_tank) command.rates[0] = valve.in * dot(tip.error_rate, damped) + dot(tip.error_rate, varied);
}

}  // namespace arm3r
