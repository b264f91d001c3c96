#pragma once
// Laws that make the tip a spring and a damper, some of them with a mass; docs/model.md, section 7. Slide convention, base
// axes.

#include "arm3r/control/task_space.hpp"

namespace arm3r {

// A torque that adds a force at the tip to the compensation of gravity.
template <class P, class T>
ARM3R_INLINE Vec3<T> pulling(const Arm<P>& model, const Pose<T>& p, const Vec3<T>& force) {
    return plus(gravity_torque(model, p), tip_force_torque(model, p, force));
}

// tau = tau_g + J^T (K_P (x_d - x) - K_D xd) (7.9). Salisbury 1980.
template <class P, class T>
ARM3R_INLINE Vec3<T> stiffness_control(const Controller<P>& controller, const Sensed<T>& sensed) {
    const TipTask<T> tip = tip_task(controller, sensed);
    const Vec3<T> force =
        minus(each_times(controller.gains.stiffness, tip.error), each_times(controller.gains.damping, tip.velocity));
    return pulling(controller.model, sensed.pose, force);
}

// tau = tau_g + K_q (q_d - q) - J_d^T K_D J_d qd, K_q = J_d^T K_P J_d, J_d = J(q_d) (7.10). Salisbury 1980.
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_stiffness_control(const Controller<P>& controller, const Sensed<T>& sensed) {
    const Gains<P>& gains = controller.gains;
    const Vec3<T> wanted = wanted_at(controller.setpoint, sensed.t).position;
    const Pose<T> there = pose(wanted);
    const Vec3<T> stretch = tip_velocity(controller.model, there, minus(wanted, sensed.q));
    const Vec3<T> slide = tip_velocity(controller.model, there, sensed.qd);
    const Vec3<T> force = minus(each_times(gains.stiffness, stretch), each_times(gains.damping, slide));
    return plus(gravity_torque(controller.model, sensed.pose), tip_force_torque(controller.model, there, force));
}

// tau = tau_g + J^T (Lambda xdd_d + mu xd_d + B (xd_d - xd) + K (x_d - x)) (7.11). Hogan 1985.
template <class P, class T>
ARM3R_INLINE Vec3<T> impedance_control(const Controller<P>& controller, const Sensed<T>& sensed) {
    const Arm<P>& model = controller.model;
    const TipTask<T> tip = tip_task(controller, sensed);
    const Vec3<T> force =
        plus(each_times(controller.gains.damping, tip.error_rate), each_times(controller.gains.stiffness, tip.error));
    const Vec3<T> tau = pulling(model, sensed.pose, force);
    const Path path = controller.setpoint.path;
    if (!is_moving(path)) return tau;  // no motion to bring along, at a singular pose either
    const Vec3<T> rates = joint_rates(model, sensed.pose, tip.wanted_velocity);
    const Vec3<T> by_rates = jacobian_dot_times(model, sensed.pose, sensed.qd, rates);
    const Vec3<T> moved = inertial_torque(model, sensed.pose, minus(tip.wanted_acceleration, by_rates));
    return plus(tau, plus(moved, times(coriolis_matrix(model, sensed.pose, sensed.qd), rates)));
}

// ID(xdd_d + M_d^-1 (B (xd_d - xd) + K e + f_on_tip)), e: m from the tip to where the spring pulls (7.12). Hogan 1985.
template <class P, class T>
ARM3R_INLINE Vec3<T> shaped(const Controller<P>& controller, const Sensed<T>& sensed, const TipTask<T>& tip,
                            const Vec3<T>& e) {
    const Gains<P>& gains = controller.gains;
    const Vec3<T> pulled = plus(each_times(gains.damping, tip.error_rate), each_times(gains.stiffness, e));
    Vec3<T> a;
    for (int i = 0; i < 3; ++i) a[i] = tip.wanted_acceleration[i] + (pulled[i] + sensed.f_on_tip[i]) / gains.mass[i];
    return torque_for_tip(controller.model, sensed, a, sensed.f_cancelled);
}

template <class P, class T>
ARM3R_INLINE Vec3<T> shaped_impedance(const Controller<P>& controller, const Sensed<T>& sensed) {
    const TipTask<T> tip = tip_task(controller, sensed);
    return shaped(controller, sensed, tip, tip.error);
}

}  // namespace arm3r
