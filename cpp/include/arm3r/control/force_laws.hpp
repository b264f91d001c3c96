#pragma once
// Laws that control the pressing force and the motion across it; docs/model.md, section 7. memory[0]: the integral of the
// force error, N s. Slide convention, base axes.

#include "arm3r/control/force_loop.hpp"
#include "arm3r/control/impedance_laws.hpp"

namespace arm3r {

// S_p a_m + S_f p_in (kP e_f + kI int e_f - b p_in . xd)/m_f, a_m = xdd_d + K_D (xd_d - xd) + K (x_d - x): m/s^2 (7.13).
template <class P, class T>
ARM3R_INLINE Vec3<T> split_acceleration(const Gains<P>& gains, const Measurement<T>& sensed, const TipTask<T>& tip,
                                        const T& correction) {
    const T along = (correction + gains.force_damping * dot(sensed.n, tip.velocity)) / gains.force_mass;
    return split_directions(sensed, tracking_acceleration(gains, tip), along);
}

// d tau/d int e_f of ID(a) where a has kI int e_f/m along p_in.
template <class P, class T>
ARM3R_INLINE Vec3<T> dtau_dintegral_of_tip(const Controller<P>& controller, const Measurement<T>& sensed) {
    const T gain(controller.gains.force_integral / controller.gains.force_mass);
    return inertial_torque(controller.model, sensed.pose, force_along_press(sensed, gain));
}

// J^T (Lambda a + mu xd + p) - J^T f, or + J^T S_f p_in f_d in place of - J^T f (7.13). Khatib 1987.
template <class P, class T>
ARM3R_INLINE Vec3<T> operational_space_control(const Controller<P>& controller, const Measurement<T>& sensed,
                                               const T& correction) {
    const TipTask<T> tip = tip_task(controller, sensed);
    const Vec3<T> a = split_acceleration(controller.gains, sensed, tip, correction);
    if (controller.force_term == ForceTerm::cancelled)
        return torque_for_tip(controller.model, sensed, a, sensed.f_cancelled);
    const T fed_forward = -desired_force_at(controller.reference, sensed.t);
    return torque_for_tip(controller.model, sensed, a, force_along_press(sensed, fed_forward));
}

// J^-1 S_p v, or (S_p J)^+ v (7.15).
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_motion(const Controller<P>& controller, const Measurement<T>& sensed, const Vec3<T>& v) {
    const auto solved = [&](const Vec3<T>& x)
                            ARM3R_INLINE_LAMBDA { return joint_rates(controller.model, sensed.pose, x); };
    if (controller.variant == Variant::raibert_craig) return solved(split_directions(sensed, v, T(0.0)));
    const Vec3<T> y = solved(v), g = solved(sensed.n);
    return minus(y, scaled(T(sensed.force_phase * dot(g, y) / max(dot(g, g), T(1e-300))), g));
}

// tau_g + Kp_q P x_e - Kv_q P xd + J^T S_f p_in pressed, P one of the two above (7.14). Raibert and Craig 1981; Fisher and
// Mujtaba 1992.
template <class P, class T>
ARM3R_INLINE Vec3<T> hybrid_in_joints(const Controller<P>& controller, const Measurement<T>& sensed,
                                      const TipTask<T>& tip, const T& pressed) {
    const Gains<P>& gains = controller.gains;
    const Vec3<T> held = minus(cwise_product(gains.joint_stiffness, joint_motion(controller, sensed, tip.error)),
                               cwise_product(gains.joint_damping, joint_motion(controller, sensed, tip.velocity)));
    const Vec3<T> force = force_along_press(sensed, pressed);
    return plus(gravity_torque(controller.model, sensed.pose),
                plus(held, tip_force_torque(controller.model, sensed.pose, force)));
}

template <class P, class T>
ARM3R_INLINE Vec3<T> hybrid_control(const Controller<P>& controller, const Measurement<T>& sensed,
                                    const T& correction) {  // (7.14)
    const Gains<P>& gains = controller.gains;
    const TipTask<T> tip = tip_task(controller, sensed);
    if (controller.variant == Variant::dynamic)
        return torque_for_tip(controller.model, sensed, split_acceleration(gains, sensed, tip, correction),
                              sensed.f_cancelled);
    const T damped = gains.force_damping * dot(sensed.n, tip.velocity);
    const T pressed = desired_force_at(controller.reference, sensed.t) + correction + damped;
    if (controller.variant != Variant::jacobian_transpose) return hybrid_in_joints(controller, sensed, tip, pressed);
    const Vec3<T> motion = minus(cwise_product(gains.stiffness, tip.error), cwise_product(gains.damping, tip.velocity));
    return gravity_plus_force(controller.model, sensed.pose, split_directions(sensed, motion, pressed));
}

// ID(xdd_d + (K_D (xd_d - xd) + K_P (x_d - x) + S_f p_in (K_F e_f + K_I int e_f))/m) (7.16). Chiaverini, Sciavicco 1993.
template <class P, class T>
ARM3R_INLINE Vec3<T> parallel_control(const Controller<P>& controller, const Measurement<T>& sensed,
                                      const T& correction) {
    const Gains<P>& gains = controller.gains;
    const TipTask<T> tip = tip_task(controller, sensed);
    const Vec3<T> feedback =
        plus(cwise_product(gains.damping, tip.error_rate), cwise_product(gains.stiffness, tip.error));
    const Vec3<T> force = plus(feedback, force_along_press(sensed, correction));
    const T per_mass = T(1.0 / gains.force_mass);
    return torque_for_tip(controller.model, sensed, plus(tip.desired_acceleration, scaled(per_mass, force)),
                          sensed.f_cancelled);
}

template <class P, class T>
ARM3R_INLINE void force_law(const Controller<P>& controller, const Measurement<T>& sensed, const T& integral,
                            Command<T>& command) {
    const T error = force_error(controller, sensed);
    const T correction = pi_term(controller.gains, error, integral);
    command.rates[0] = integral_rate(controller, sensed, integral, error);
    if (controller.type == ControllerType::operational_space)
        command.tau = operational_space_control(controller, sensed, correction);
    else if (controller.type == ControllerType::parallel)
        command.tau = parallel_control(controller, sensed, correction);
    else command.tau = hybrid_control(controller, sensed, correction);
    if (controller.anti_windup == AntiWindup::none) return;
    const bool by_statics = controller.type == ControllerType::hybrid && controller.variant != Variant::dynamic;
    command.dtau_dintegral = by_statics
                                 ? tip_force_torque(controller.model, sensed.pose,
                                                    force_along_press(sensed, T(controller.gains.force_integral)))
                                 : dtau_dintegral_of_tip(controller, sensed);
}

}  // namespace arm3r
