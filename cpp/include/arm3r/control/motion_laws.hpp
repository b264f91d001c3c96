#pragma once
// Laws that track a motion of the joints or of the tip; docs/model.md, section 7. Slide convention.

#include "arm3r/control/task_space.hpp"

namespace arm3r {

// tau = Kp (q_d - q) - Kd qd [+ tau_g] (7.6). Takegaki and Arimoto 1981.
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_pd(const Controller<P>& controller, const Measurement<T>& sensed) {
    const Gains<P>& gains = controller.gains;
    const DesiredMotion<T> desired = desired_motion_at(controller.reference, sensed.t);
    const Vec3<T> tau = minus(cwise_product(gains.joint_stiffness, minus(desired.position, sensed.q)),
                              cwise_product(gains.joint_damping, sensed.qd));
    return controller.compensates_gravity ? plus(tau, gravity_torque(controller.model, sensed.pose)) : tau;
}

// tau = M (qdd_d + Kd ed + Kp e) + C qd + tau_g + tau_f [- J^T f], e = q_d - q (7.7).
template <class P, class T>
ARM3R_INLINE Vec3<T> computed_torque(const Controller<P>& controller, const Measurement<T>& sensed) {
    const Gains<P>& gains = controller.gains;
    const DesiredMotion<T> desired = desired_motion_at(controller.reference, sensed.t);
    const Vec3<T> feedback = plus(cwise_product(gains.velocity, minus(desired.velocity, sensed.qd)),
                                  cwise_product(gains.position, minus(desired.position, sensed.q)));
    return inverse_dynamics(controller.model, sensed.pose, sensed.qd, plus(desired.acceleration, feedback),
                            controller.cancels_force ? sensed.f_cancelled : zero_vector<T>());
}

// ID(xdd_d + Kd (xd_d - xd) + Kp (x_d - x)) [with J^T f left in] (7.8). Luh, Walker and Paul 1980.
template <class P, class T>
ARM3R_INLINE Vec3<T> resolved_acceleration(const Controller<P>& controller, const Measurement<T>& sensed) {
    const TipTask<T> tip = tip_task(controller, sensed);
    return torque_for_tip(controller.model, sensed, tracking_acceleration(controller.gains, tip),
                          controller.cancels_force ? sensed.f_cancelled : zero_vector<T>());
}

}  // namespace arm3r
