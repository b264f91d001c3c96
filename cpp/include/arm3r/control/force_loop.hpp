#pragma once
// What laws that control the pressing force have in common: the error along the normal, its integral, and the split into
// directions of motion and of force; docs/model.md, section 7. Base axes.

#include "arm3r/control/task_space.hpp"

namespace arm3r {

// e_f = f_d - f: N, along the pressing direction -n (7.3).
template <class P, class T>
ARM3R_INLINE T force_error(const Controller<P>& controller, const Sensed<T>& sensed) {
    return force_wanted_at(controller.setpoint, sensed.t) - dot(sensed.n, sensed.f_on_tip);
}

// The rate of the integral, within its limit (7.5): back-calculation adds its part first, and then limits both together.
template <class P, class T>
ARM3R_INLINE T integral_rate(const Controller<P>& controller, const Sensed<T>& sensed, const T& integral,
                             const T& error) {
    const T rate = error * sensed.contact * sensed.force_phase;
    if (controller.anti_windup == AntiWindup::back_calculation) return rate;
    return within_limit(controller.gains, integral, rate);
}

// kP e_f + kI int e_f: N.
template <class P, class T>
ARM3R_INLINE T corrected(const Gains<P>& gains, const T& error, const T& integral) {
    return gains.force * error + gains.force_integral * integral;
}

// S_p motion + S_f p_in pressing (7.3).
template <class T>
ARM3R_INLINE Vec3<T> divided(const Sensed<T>& sensed, const Vec3<T>& motion, const T& pressing) {
    return minus(motion, scaled(T(sensed.force_phase * (dot(sensed.n, motion) + pressing)), sensed.n));
}

// S_f p_in size.
template <class T>
ARM3R_INLINE Vec3<T> pressing(const Sensed<T>& sensed, const T& size) {
    return scaled(T(-(sensed.force_phase * size)), sensed.n);
}

}  // namespace arm3r
