#pragma once
// The arm as seen from its tip: which joint motion gives a tip motion, and which torque; docs/model.md, section 7. Slide
// convention, base axes.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

// J^-1 xd: the joint rates that move the tip with xd (7.4). Infinite at a singular pose.
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_rates(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& xd) {
    const T radial = p.C1 * xd[0] + p.S1 * xd[1];
    const T around = p.C1 * xd[1] - p.S1 * xd[0];
    const T S3 = sin_q3(p);
    const T inverse_r = 1.0 / radius(arm, p);
    const T inverse_plane = 1.0 / (arm.link2.length * arm.link3.length * S3);
    const T w2 = arm.link3.length * (p.C23 * radial + p.S23 * xd[2]) * inverse_plane;
    const T w3 = -(arm.link2.length * (p.C2 * radial + p.S2 * xd[2]) * inverse_plane);
    return {around * inverse_r, w2, w3 - w2};
}

// Jdot(q, qd) rates: m/s^2 (2.6). The same with qd and `rates` exchanged.
template <class P, class T>
ARM3R_INLINE Vec3<T> jacobian_dot_times(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& rates) {
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
ARM3R_INLINE Vec3<T> torque_for_tip(const Arm<P>& model, const Sensed<T>& sensed, const Vec3<T>& a,
                                    const Vec3<T>& f_on_tip) {
    return shared<T>([&]() ARM3R_INLINE_LAMBDA {
        const Vec3<T> by_rates = jacobian_dot_times(model, sensed.pose, sensed.qd, sensed.qd);
        const Vec3<T> qdd = joint_rates(model, sensed.pose, minus(a, by_rates));
        return inverse_dynamics(model, sensed.pose, sensed.qd, qdd, f_on_tip);
    });
}

// J^T Lambda a = M J^-1 a: what that torque changes by with a (7.4).
template <class P, class T>
ARM3R_INLINE Vec3<T> inertial_torque(const Arm<P>& model, const Pose<T>& p, const Vec3<T>& a) {
    return shared<T>([&]() ARM3R_INLINE_LAMBDA { return times(mass_matrix(model, p), joint_rates(model, p, a)); });
}

// How far the pose is from where J has no inverse: 0 there, 1 at most (7.21).
template <class P, class T>
ARM3R_INLINE T distance_to_singular(const Arm<P>& arm, const Pose<T>& p) {
    const T S3 = sin_q3(p);
    return min(T(abs(S3)), T(abs(radius(arm, p)) / (arm.link2.length + arm.link3.length)));
}

// The tip where the controller believes it, and where it wants it: m, m/s, m/s^2, base axes.
template <class T>
struct TipTask {
    Vec3<T> velocity;                              // xd
    Vec3<T> error, error_rate;                     // x_d - x, xd_d - xd
    Vec3<T> wanted_velocity, wanted_acceleration;  // xd_d, xdd_d
};

template <class P, class T>
ARM3R_INLINE TipTask<T> tip_task(const Controller<P>& controller, const Sensed<T>& sensed) {
    return shared<T>([&]() ARM3R_INLINE_LAMBDA {
        const Wanted<T> wanted = wanted_at(controller.setpoint, sensed.t);
        const Vec3<T> velocity = tip_velocity(controller.model, sensed.pose, sensed.qd);
        return TipTask<T>{velocity, minus(wanted.position, tip_position(controller.model, sensed.pose)),
                          minus(wanted.velocity, velocity), wanted.velocity, wanted.acceleration};
    });
}

// xdd_d + Kd (xd_d - xd) + Kp (x_d - x): m/s^2 (7.8).
template <class P, class T>
ARM3R_INLINE Vec3<T> tracking_acceleration(const Gains<P>& gains, const TipTask<T>& tip) {
    const Vec3<T> pulled = plus(each_times(gains.velocity, tip.error_rate), each_times(gains.position, tip.error));
    return plus(tip.wanted_acceleration, pulled);
}

}  // namespace arm3r
