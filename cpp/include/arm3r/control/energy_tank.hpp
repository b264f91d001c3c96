#pragma once
// A stiffness that varies, and a tank that stores the energy that the damper takes out and pays for the variation;
// docs/model.md, section 7. memory[0]: the energy in the tank, J. Ferraguti, Secchi and Fantuzzi 2013. Slide
// convention, base axes.

#include "arm3r/control/impedance_laws.hpp"

namespace arm3r {

// A smooth step: 0 at `low`, 1 at `high`.
template <class P, class T>
ARM3R_INLINE T smoothstep(const T& level, const P& low, const P& high) {
    return minimum_jerk(T((level - low) / (high - low))).s;
}

// The gains of the flow out of the tank and into it, 0 to 1 (7.19).
template <class T>
struct TankGains {
    T out, in;
};

template <class P, class T>
ARM3R_INLINE TankGains<T> tank_gains(const Gains<P>& gains, const T& energy) {
    const P width = gains.tank_high - gains.tank_low;
    return {smoothstep(energy, gains.tank_low, gains.tank_high),
            1.0 - smoothstep(energy, P(gains.tank_capacity - width), gains.tank_capacity)};
}

// tau = tau_g + J^T (-D ed - K_0 e + w), w = -gamma(E) dK(t) e, e = x - x_d (7.19).
template <class P, class T>
ARM3R_INLINE void energy_tank(const Controller<P>& controller, const Measurement<T>& sensed, const T& energy,
                              Command<T>& command) {
    const Gains<P>& gains = controller.gains;
    const TipTask<T> tip = tip_task(controller, sensed);
    const T variation = gains.stiffness_amplitude * turned(T(gains.stiffness_frequency * sensed.t)).sin;
    const Vec3<T> damped = cwise_product(gains.damping, tip.error_rate);
    const Vec3<T> held = plus(damped, cwise_product(gains.stiffness, tip.error));
    const TankGains<T> tank_gain = controller.has_tank ? tank_gains(gains, energy) : TankGains<T>{T(1.0), T(0.0)};
    const Vec3<T> varied = scaled(T(tank_gain.out * variation), tip.error);
    command.tau = gravity_plus_force(controller.model, sensed.pose, plus(held, varied));
    if (controller.has_tank)
        command.rates[0] = tank_gain.in * dot(tip.error_rate, damped) + dot(tip.error_rate, varied);
}

}  // namespace arm3r
