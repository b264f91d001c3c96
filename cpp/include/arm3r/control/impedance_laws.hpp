#pragma once
// Laws that make the tip a spring and a damper, some of them with a mass; docs/model.md, section 7. Slide convention, base
// axes.

#include "arm3r/control/task_space.hpp"

namespace arm3r {

// tau_g + J^T force.
template <class P, class T>
ARM3R_INLINE Vec3<T> gravity_plus_force(const Arm<P>& model, const Pose<T>& p, const Vec3<T>& force) {
    return plus(gravity_torque(model, p), tip_force_torque(model, p, force));
}

// tau = tau_g + J^T (K_P (x_d - x) - K_D xd) (7.9). Salisbury 1980.
template <class P, class T>
ARM3R_INLINE Vec3<T> stiffness_control(const Controller<P>& controller, const Measurement<T>& sensed) {
    const TipTask<T> tip = tip_task(controller, sensed);
    const Vec3<T> force = minus(cwise_product(controller.gains.stiffness, tip.error),
                                cwise_product(controller.gains.damping, tip.velocity));
    return gravity_plus_force(controller.model, sensed.pose, force);
}

// tau = tau_g + K_q (q_d - q) - J_d^T K_D J_d qd, K_q = J_d^T K_P J_d, J_d = J(q_d) (7.10). Salisbury 1980.
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_stiffness_control(const Controller<P>& controller, const Measurement<T>& sensed) {
    const Gains<P>& gains = controller.gains;
    const Vec3<T> desired = desired_motion_at(controller.reference, sensed.t).position;
    const Pose<T> there = pose(desired);
    const Vec3<T> stretch = tip_velocity(controller.model, there, minus(desired, sensed.q));
    const Vec3<T> slide = tip_velocity(controller.model, there, sensed.qd);
    const Vec3<T> force = minus(cwise_product(gains.stiffness, stretch), cwise_product(gains.damping, slide));
    return plus(gravity_torque(controller.model, sensed.pose), tip_force_torque(controller.model, there, force));
}

// tau = tau_g + J^T (Lambda xdd_d + mu xd_d + B (xd_d - xd) + K (x_d - x)) (7.11). Hogan 1985.
template <class P, class T>
ARM3R_INLINE Vec3<T> impedance_control(const Controller<P>& controller, const Measurement<T>& sensed) {
    const Arm<P>& model = controller.model;
    const TipTask<T> tip = tip_task(controller, sensed);
    const Vec3<T> force = plus(cwise_product(controller.gains.damping, tip.error_rate),
                               cwise_product(controller.gains.stiffness, tip.error));
    const Vec3<T> tau = gravity_plus_force(model, sensed.pose, force);
    const Path path = controller.reference.path;
    if (!is_moving(path)) return tau;  // the path has no velocity, and a singular pose is allowed
    const Vec3<T> rates = joint_rates(model, sensed.pose, tip.desired_velocity);
    const Vec3<T> by_rates = jacobian_dot_times(model, sensed.pose, sensed.qd, rates);
    const Vec3<T> moved = inertial_torque(model, sensed.pose, minus(tip.desired_acceleration, by_rates));
    return plus(tau, plus(moved, times(coriolis_matrix(model, sensed.pose, sensed.qd), rates)));
}

// ID(xdd_d + M_d^-1 (B (xd_d - xd) + K e + f_on_tip)), e: m from the tip to where the spring pulls (7.12). Hogan 1985.
template <class P, class T>
ARM3R_INLINE Vec3<T> shaped_impedance_torque(const Controller<P>& controller, const Measurement<T>& sensed,
                                             const TipTask<T>& tip, const Vec3<T>& e) {
    const Gains<P>& gains = controller.gains;
    const Vec3<T> feedback = plus(cwise_product(gains.damping, tip.error_rate), cwise_product(gains.stiffness, e));
    Vec3<T> a;
    for (int i = 0; i < 3; ++i) a[i] = tip.desired_acceleration[i] + (feedback[i] + sensed.f_on_tip[i]) / gains.mass[i];
    return torque_for_tip(controller.model, sensed, a, sensed.f_cancelled);
}

template <class P, class T>
ARM3R_INLINE Vec3<T> shaped_impedance(const Controller<P>& controller, const Measurement<T>& sensed) {
    const TipTask<T> tip = tip_task(controller, sensed);
    return shaped_impedance_torque(controller, sensed, tip, tip.error);
}

}  // namespace arm3r
