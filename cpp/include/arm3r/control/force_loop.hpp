#pragma once
// The parts that all laws with force control share: the error along the normal, its integral, and the split into
// directions of motion and of force; docs/model.md, section 7. Base axes.

#include "arm3r/control/task_space.hpp"

namespace arm3r {

// e_f = f_d - f: N, along the pressing direction -n (7.3).
template <class P, class T>
ARM3R_INLINE T force_error(const Controller<P>& controller, const Measurement<T>& sensed) {
    return desired_force_at(controller.reference, sensed.t) - dot(sensed.n, sensed.f_on_tip);
}

// The rate of the integral, within its limit (7.5). With back-calculation the limit is applied later, to the sum of
// both rates.
template <class P, class T>
ARM3R_INLINE T integral_rate(const Controller<P>& controller, const Measurement<T>& sensed, const T& integral,
                             const T& error) {
    const T rate = error * sensed.contact * sensed.force_phase;
    if (controller.anti_windup == AntiWindup::back_calculation) return rate;
    return within_limit(controller.gains, integral, rate);
}

// The PI term kP e_f + kI int e_f: N.
template <class P, class T>
ARM3R_INLINE T pi_term(const Gains<P>& gains, const T& error, const T& integral) {
    return gains.force * error + gains.force_integral * integral;
}

// S_p motion + S_f p_in force_part (7.3).
template <class T>
ARM3R_INLINE Vec3<T> split_directions(const Measurement<T>& sensed, const Vec3<T>& motion, const T& force_part) {
    return minus(motion, scaled(T(sensed.force_phase * (dot(sensed.n, motion) + force_part)), sensed.n));
}

// S_f p_in size.
template <class T>
ARM3R_INLINE Vec3<T> force_along_press(const Measurement<T>& sensed, const T& size) {
    return scaled(T(-(sensed.force_phase * size)), sensed.n);
}

}  // namespace arm3r
