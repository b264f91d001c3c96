#pragma once
// Laws that follow a motion, of the joints or of the tip; docs/model.md, section 7. Slide convention.

#include "arm3r/control/task_space.hpp"

namespace arm3r {

// tau = Kp (q_d - q) - Kd qd [+ tau_g] (7.6). Takegaki and Arimoto 1981.
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_pd(const Controller<P>& controller, const Sensed<T>& sensed) {
    const Gains<P>& gains = controller.gains;
    const Wanted<T> wanted = wanted_at(controller.setpoint, sensed.t);
    const Vec3<T> tau = minus(each_times(gains.joint_stiffness, minus(wanted.position, sensed.q)),
                              each_times(gains.joint_damping, sensed.qd));
    return controller.compensates_gravity ? plus(tau, gravity_torque(controller.model, sensed.pose)) : tau;
}

// tau = M (qdd_d + Kd ed + Kp e) + C qd + tau_g + tau_f [- J^T f], e = q_d - q (7.7).
template <class P, class T>
ARM3R_INLINE Vec3<T> computed_torque(const Controller<P>& controller, const Sensed<T>& sensed) {
    const Gains<P>& gains = controller.gains;
    const Wanted<T> wanted = wanted_at(controller.setpoint, sensed.t);
    const Vec3<T> pulled = plus(each_times(gains.velocity, minus(wanted.velocity, sensed.qd)),
                                each_times(gains.position, minus(wanted.position, sensed.q)));
    return inverse_dynamics(controller.model, sensed.pose, sensed.qd, plus(wanted.acceleration, pulled),
                            controller.cancels_force ? sensed.f_cancelled : none<T>());
}

// ID(xdd_d + Kd (xd_d - xd) + Kp (x_d - x)) [with J^T f left in] (7.8). Luh, Walker and Paul 1980.
template <class P, class T>
ARM3R_INLINE Vec3<T> resolved_acceleration(const Controller<P>& controller, const Sensed<T>& sensed) {
    const TipTask<T> tip = tip_task(controller, sensed);
    return torque_for_tip(controller.model, sensed, tracking_acceleration(controller.gains, tip),
                          controller.cancels_force ? sensed.f_cancelled : none<T>());
}

}  // namespace arm3r
