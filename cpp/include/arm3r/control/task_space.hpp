#pragma once
// Kinematics and dynamics in the space of the tip: joint rates and torques for a motion of the tip; docs/model.md,
// section 7. Slide convention, base axes.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

// J^-1 xd: the joint rates that move the tip with xd (7.4). Infinite at a singular pose.
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_rates(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& xd) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::joint_rates(arm, p, xd);
    const T radial = p.C1 * xd[0] + p.S1 * xd[1];
    const T around = p.C1 * xd[1] - p.S1 * xd[0];
    const T S3 = sin_q3(p);
    const T inverse_r = 1.0 / radius(arm, p);
    const T inverse_plane = 1.0 / (arm.link2.length * arm.link3.length * S3);
    const T w2 = arm.link3.length * (p.C23 * radial + p.S23 * xd[2]) * inverse_plane;
    const T w3 = -(arm.link2.length * (p.C2 * radial + p.S2 * xd[2]) * inverse_plane);
    return {around * inverse_r, w2, w3 - w2};
}

// Jdot(q, qd) rates: m/s^2 (2.6). Exchanging qd and `rates` does not change it.
template <class P, class T>
ARM3R_INLINE Vec3<T> jacobian_dot_times(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& rates) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::jacobian_dot_times(arm, p, qd, rates);
    const P a2 = arm.link2.length, a3 = arm.link3.length;
    const T w2 = qd[1], w3 = qd[1] + qd[2], v2 = rates[1], v3 = rates[1] + rates[2];
    const T outward_w = -(a2 * p.S2 * w2 + a3 * p.S23 * w3);
    const T outward_v = -(a2 * p.S2 * v2 + a3 * p.S23 * v3);
    const T second = a2 * (w2 * v2), third = a3 * (w3 * v3);
    const T radial = -(second * p.C2 + third * p.C23) - radius(arm, p) * (qd[0] * rates[0]);
    const T around = outward_w * rates[0] + outward_v * qd[0];
    const T up = -(second * p.S2 + third * p.S23);
    return {p.C1 * radial - p.S1 * around, p.S1 * radial + p.C1 * around, up};
}

// ID(a): the torque at which the tip of the model accelerates by a, m/s^2, while f_on_tip, N, acts on it (7.4).
template <class P, class T>
ARM3R_INLINE Vec3<T> torque_for_tip(const Arm<P>& model, const Measurement<T>& sensed, const Vec3<T>& a,
                                    const Vec3<T>& f_on_tip) {
    return shared<T>([&]() ARM3R_INLINE_LAMBDA {
        const Vec3<T> by_rates = jacobian_dot_times(model, sensed.pose, sensed.qd, sensed.qd);
        const Vec3<T> qdd = joint_rates(model, sensed.pose, minus(a, by_rates));
        return inverse_dynamics(model, sensed.pose, sensed.qd, qdd, f_on_tip);
    });
}

// J^T Lambda a = M J^-1 a: the change of that torque with a (7.4).
template <class P, class T>
ARM3R_INLINE Vec3<T> inertial_torque(const Arm<P>& model, const Pose<T>& p, const Vec3<T>& a) {
    return shared<T>([&]() ARM3R_INLINE_LAMBDA { return times(mass_matrix(model, p), joint_rates(model, p, a)); });
}

// The distance of the pose from a singularity of J: 0 there, at most 1 (7.21).
template <class P, class T>
ARM3R_INLINE T distance_to_singular(const Arm<P>& arm, const Pose<T>& p) {
    return min(T(abs(sine_of_bend(arm, p))), T(abs(radius(arm, p)) / reach(arm)));
}

// Errors of the tip, computed with the controller's model, and the desired motion: m, m/s, m/s^2, base axes.
template <class T>
struct TipTask {
    Vec3<T> velocity;                                // xd
    Vec3<T> error, error_rate;                       // x_d - x, xd_d - xd
    Vec3<T> desired_velocity, desired_acceleration;  // xd_d, xdd_d
};

template <class P, class T>
ARM3R_INLINE TipTask<T> tip_task(const Controller<P>& controller, const Measurement<T>& sensed) {
    return shared<T>([&]() ARM3R_INLINE_LAMBDA {
        const DesiredMotion<T> desired = desired_motion_at(controller.reference, sensed.t);
        const Vec3<T> velocity = tip_velocity(controller.model, sensed.pose, sensed.qd);
        return TipTask<T>{velocity, minus(desired.position, tip_position(controller.model, sensed.pose)),
                          minus(desired.velocity, velocity), desired.velocity, desired.acceleration};
    });
}

// xdd_d + Kd (xd_d - xd) + Kp (x_d - x): m/s^2 (7.8).
template <class P, class T>
ARM3R_INLINE Vec3<T> tracking_acceleration(const Gains<P>& gains, const TipTask<T>& tip) {
    const Vec3<T> feedback =
        plus(cwise_product(gains.velocity, tip.error_rate), cwise_product(gains.position, tip.error));
    return plus(tip.desired_acceleration, feedback);
}

}  // namespace arm3r
