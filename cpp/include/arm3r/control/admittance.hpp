#pragma once
// Admittance: the tip follows a point that yields to the measured force; docs/model.md, section 7. memory: where the point
// is, m, and its velocity, m/s, base axes. Slide convention.

#include "arm3r/control/task_space.hpp"

namespace arm3r {

// The difference of two angles, within half a turn.
template <class T>
ARM3R_INLINE T turned_between(const T& to, const T& from) {
    const T difference = to - from;
    return difference - two_pi * nearest_integer(T(difference * (1 / two_pi)));
}

// The change of the joint angles that brings the tip to `point`, on the present one of the four branches (2.7). If the
// point is out of reach, the arm is stretched towards it.
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_error(const Arm<P>& model, const Measurement<T>& sensed, const Vec3<T>& point) {
    const Pose<T>& p = sensed.pose;
    const T front = copysign(T(1.0), radius(model, p)), bent = sine_of_bend(model, p);
    const Vec3<T> q =
        inverse_kinematics_of_branch(model, point, front, [&](const T&) ARM3R_INLINE_LAMBDA { return bent; }).q;
    return {turned_between(q[0], sensed.q[0]), turned_between(q[1], sensed.q[1]), turned_between(q[2], sensed.q[2])};
}

// The admittance: M (xdd_c - xdd_d) + B (xd_c - xd_d) + K (x_c - x_d) = f_on_tip + f_d p_in, solved for xdd_c, m/s^2
// (7.17).
template <class P, class T>
ARM3R_INLINE Vec3<T> admittance_acceleration(const Controller<P>& controller, const Measurement<T>& sensed,
                                             const Vec3<T>& point, const Vec3<T>& velocity) {
    const Gains<P>& gains = controller.gains;
    const DesiredMotion<T> desired = desired_motion_at(controller.reference, sensed.t);
    const T pressed = desired_force_at(controller.reference, sensed.t);
    const Vec3<T> feedback = plus(cwise_product(gains.damping, minus(desired.velocity, velocity)),
                                  cwise_product(gains.stiffness, minus(desired.position, point)));
    Vec3<T> a;
    for (int i = 0; i < 3; ++i)
        a[i] = desired.acceleration[i] + (feedback[i] + (sensed.f_on_tip[i] - pressed * sensed.n[i])) / gains.mass[i];
    return a;
}

// The torque of the inner loop, which makes the tip track the point (7.17).
template <class P, class T>
ARM3R_INLINE Vec3<T> inner_loop_torque(const Controller<P>& controller, const Measurement<T>& sensed,
                                       const Vec3<T>& point, const Vec3<T>& velocity, const Vec3<T>& acceleration) {
    const Arm<P>& model = controller.model;
    const Gains<P>& gains = controller.gains;
    if (controller.inner == Inner::joint_pd) {
        const Vec3<T> tau = minus(cwise_product(gains.joint_stiffness, joint_error(model, sensed, point)),
                                  cwise_product(gains.joint_damping, sensed.qd));
        return plus(tau, gravity_torque(model, sensed.pose));
    }
    const T w(gains.inner_bandwidth), w2 = w * w, d = 2.0 * gains.inner_damping_ratio * w;
    const Vec3<T> xd = tip_velocity(model, sensed.pose, sensed.qd);
    const Vec3<T> feedback = scaled(w2, minus(point, tip_position(model, sensed.pose)));
    const Vec3<T> a = controller.inner == Inner::exact
                          ? plus(acceleration, plus(scaled(d, minus(velocity, xd)), feedback))
                          : minus(feedback, scaled(d, xd));
    return torque_for_tip(model, sensed, a, sensed.f_cancelled);
}

// Maples and Becker 1986.
template <class P, class T>
ARM3R_INLINE void admittance_control(const Controller<P>& controller, const Measurement<T>& sensed,
                                     const std::array<T, law_memory>& memory, Command<T>& command) {
    const Vec3<T> point(memory[0], memory[1], memory[2]), velocity(memory[3], memory[4], memory[5]);
    const Vec3<T> acceleration = admittance_acceleration(controller, sensed, point, velocity);
    command.tau = inner_loop_torque(controller, sensed, point, velocity, acceleration);
    command.rates = {velocity[0], velocity[1], velocity[2], acceleration[0], acceleration[1], acceleration[2]};
}

}  // namespace arm3r
