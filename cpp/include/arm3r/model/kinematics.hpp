#pragma once
// Position and velocity of the arm in closed form; docs/model.md, section 2. Slide convention, scenario axes. The formulas
// that stand here are those of the planar arm; those of the elbow arm stand in elbow_kinematics.hpp.

#include "arm3r/model/elbow_kinematics.hpp"

namespace arm3r {

template <class P, class T>
ARM3R_INLINE T radius(const Arm<P>& arm, const Pose<T>& p) {  // r (2.2)
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::radius(arm, elbow_arm::reaches(arm, p));
    return arm.link2.length * p.C2 + arm.link3.length * p.C23;
}

template <class P, class T>
ARM3R_INLINE T height(const Arm<P>& arm, const Pose<T>& p) {  // h (2.2)
    return arm.link2.length * p.S2 + arm.link3.length * p.S23;
}

// The point at `radial` along u and `up` along k from joint 2 (2.1).
template <class P, class T>
ARM3R_INLINE Vec3<T> in_arm_plane(const Arm<P>& arm, const Pose<T>& p, const T& radial, const T& up) {
    return {p.C1 * radial, p.S1 * radial, arm.base_height + up};
}

template <class P, class T>
ARM3R_INLINE Vec3<T> tip_position(const Arm<P>& arm, const Pose<T>& p) {  // (2.3)
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::tip_position(arm, p);
    return in_arm_plane(arm, p, radius(arm, p), height(arm, p));
}

template <class P, class T>
ARM3R_INLINE Vec3<T> shoulder_position(const Arm<P>& arm, const Pose<T>& p) {  // of joint 2
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::shoulder_position(arm, p);
    return {T(0.0), T(0.0), T(arm.base_height)};
}

template <class P, class T>
ARM3R_INLINE Vec3<T> elbow_position(const Arm<P>& arm, const Pose<T>& p) {  // (2.3)
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::elbow_position(arm, p);
    return in_arm_plane(arm, p, T(arm.link2.length * p.C2), T(arm.link2.length * p.S2));
}

template <class P, class T>
ARM3R_INLINE Mat3<T> centres_of_mass(const Arm<P>& arm, const Pose<T>& p) {  // (2.3), a row a link
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::centres_of_mass(arm, p);
    return from_rows<T>({T(0.0), T(0.0), T(arm.link1.com)},
                        in_arm_plane(arm, p, T(arm.link2.com * p.C2), T(arm.link2.com * p.S2)),
                        in_arm_plane(arm, p, T(arm.link2.length * p.C2 + arm.link3.com * p.C23),
                                     T(arm.link2.length * p.S2 + arm.link3.com * p.S23)));
}

// J: m, tip velocity per joint rate (2.4).
template <class P, class T>
ARM3R_INLINE Mat3<T> jacobian(const Arm<P>& arm, const Pose<T>& p) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::jacobian(arm, p);
    const T r = radius(arm, p);
    const T h = height(arm, p);
    const T r3 = arm.link3.length * p.C23;
    const T h3 = arm.link3.length * p.S23;
    return from_rows<T>({-p.S1 * r, -p.C1 * h, -p.C1 * h3},  //
                        {p.C1 * r, -p.S1 * h, -p.S1 * h3},   //
                        {T(0.0), r, r3});
}

// J^-1, singular where S3 = 0 or r = 0 (2.8).
template <class P, class T>
ARM3R_INLINE Mat3<T> inverse_jacobian(const Arm<P>& arm, const Pose<T>& p) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::inverse_jacobian(arm, p);
    const T r = radius(arm, p);
    const T h = height(arm, p);
    const T inverse_r = 1.0 / r;
    const T inverse_plane = 1.0 / (arm.link2.length * arm.link3.length * sin_q3(p));
    const T m = arm.link3.length * p.C23 * inverse_plane;
    const T n = arm.link3.length * p.S23 * inverse_plane;
    const T rp = r * inverse_plane;
    return from_rows<T>({-p.S1 * inverse_r, p.C1 * inverse_r, T(0.0)},  //
                        {p.C1 * m, p.S1 * m, n},                        //
                        {-p.C1 * rp, -p.S1 * rp, T(-h * inverse_plane)});
}

// J_w: angular velocity of link 3 per joint rate (2.5).
template <class P, class T>
ARM3R_INLINE Mat3<T> angular_jacobian(const Arm<P>& arm, const Pose<T>& p) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::angular_jacobian(arm, p);
    return from_rows<T>({T(0.0), p.S1, p.S1},    //
                        {T(0.0), -p.C1, -p.C1},  //
                        {T(1.0), T(0.0), T(0.0)});
}

// J-dot: m/s (2.6).
template <class P, class T>
ARM3R_INLINE Mat3<T> jacobian_dot(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::jacobian_dot(arm, p, qd);
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2];
    const T r = radius(arm, p);
    const T h = height(arm, p);
    const T n = arm.link3.length * p.S23;
    const T nd = arm.link3.length * p.C23 * w3;
    const T rd = -(arm.link2.length * p.S2 * w2 + n * w3);
    const T hd = arm.link2.length * p.C2 * w2 + nd;
    return from_rows<T>({-p.C1 * w1 * r - p.S1 * rd, p.S1 * w1 * h - p.C1 * hd, p.S1 * w1 * n - p.C1 * nd},    //
                        {-p.S1 * w1 * r + p.C1 * rd, -p.C1 * w1 * h - p.S1 * hd, -p.C1 * w1 * n - p.S1 * nd},  //
                        {T(0.0), rd, -n * w3});
}

// J qd without the matrix.
template <class P, class T>
ARM3R_INLINE Vec3<T> tip_velocity(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::tip_velocity(arm, p, qd);
    const T w2 = qd[1], w3 = qd[1] + qd[2];
    const T radial = -(arm.link2.length * p.S2 * w2 + arm.link3.length * p.S23 * w3);
    const T up = arm.link2.length * p.C2 * w2 + arm.link3.length * p.C23 * w3;
    const T around = radius(arm, p) * qd[0];
    return {p.C1 * radial - p.S1 * around, p.S1 * radial + p.C1 * around, up};
}

// The determinant of J, m^3 (2.8), (10.3): its sign changes where the arm is stretched or folded, or the tip meets axis 1.
template <class P, class T>
ARM3R_INLINE T jacobian_determinant(const Arm<P>& arm, const Pose<T>& p) {
    if (arm.is_elbow) [[unlikely]] {
        const elbow_arm::Reaches<T> m = elbow_arm::reaches(arm, p);
        return -(elbow_arm::plane_determinant(m) * elbow_arm::radius(arm, m));
    }
    return -(arm.link2.length * arm.link3.length * sin_q3(p) * radius(arm, p));
}

template <class P, class T>
ARM3R_INLINE T manipulability(const Arm<P>& arm, const Pose<T>& p) {  // |det J|
    return abs(jacobian_determinant(arm, p));
}

// The sine of the angle between the line from joint 2 to joint 3 and that from there to the tip: zero where the arm is
// stretched or folded. It is sin q3 where the tip lies on the x axis of link 3.
template <class P, class T>
ARM3R_INLINE T sine_of_bend(const Arm<P>& arm, const Pose<T>& p) {
    if (!arm.is_elbow) return sin_q3(p);
    return elbow_arm::plane_determinant(elbow_arm::reaches(arm, p)) / (arm.link2.length * arm.link3.length);
}

template <class P, class T>
ARM3R_INLINE T cosine_of_bend(const Arm<P>& arm, const Pose<T>& p) {
    if (!arm.is_elbow) return p.C23 * p.C2 + p.S23 * p.S2;
    const elbow_arm::Reaches<T> m = elbow_arm::reaches(arm, p);
    return (m.r2 * m.r3 + m.h2 * m.h3) / (arm.link2.length * arm.link3.length);
}

// dr/dt, m/s
template <class P, class T>
ARM3R_INLINE T radius_rate(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
    if (arm.is_elbow) [[unlikely]] {
        const elbow_arm::Reaches<T> m = elbow_arm::reaches(arm, p);
        return -((m.h2 + m.h3) * qd[1] + m.h3 * qd[2]);
    }
    return -(height(arm, p) * qd[1] + arm.link3.length * p.S23 * qd[2]);
}

// How far a point is out of reach, m: outside the outer radius about joint 2 or inside the inner one, where the tip lies
// before axis 1 or behind it; not above 0 within reach.
template <class P>
double reach_excess(const Arm<P>& arm, const Vec3<double>& tip, bool front) {
    const double a2 = arm.link2.length, a3 = arm.link3.length;
    const auto excess = [&](double distance) { return max(distance - (a2 + a3), abs(a2 - a3) - distance); };
    if (!arm.is_elbow) {
        const double zeta = tip[2] - arm.base_height;
        return excess(sqrt(tip[0] * tip[0] + tip[1] * tip[1] + zeta * zeta));
    }
    const Vec3<double> x = elbow_arm::from_base_position(arm, tip);
    const double e = arm.elbow.lateral, R = x[0] * x[0] + x[1] * x[1] - e * e;
    if (R < 0) return abs(e) - hypot2(x[0], x[1]);
    return excess(hypot2((front ? sqrt(R) : -sqrt(R)) - arm.elbow.shoulder_offset, x[2]));
}

// The same of the nearer of both.
template <class P>
double workspace_excess(const Arm<P>& arm, const Vec3<double>& tip) {
    return min(reach_excess(arm, tip, true), reach_excess(arm, tip, false));
}

// The joint angles at a tip position on one of the four branches: the radius has the sign of `front`, 1 or -1, and the sine
// of the bend (sine_of_bend) that of `bend_sign(rho)`, where rho is the tip's distance from joint 2 along u (2.7), (10.5).
// The result is meaningless where |cos_q3| > 1: then the arm is stretched towards the point, or folded.
template <class P, class T, class BendSign>
ARM3R_INLINE IkResult<T> inverse_kinematics_of_branch(const Arm<P>& arm, const Vec3<T>& tip, const T& front,
                                                      BendSign bend_sign) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::inverse_kinematics_of_branch(arm, tip, front, bend_sign);
    const P a2 = arm.link2.length, a3 = arm.link3.length;
    const T rho_2 = tip[0] * tip[0] + tip[1] * tip[1];
    const T rho = front * sqrt(rho_2), zeta = tip[2] - arm.base_height;
    const T C3 = (rho_2 + zeta * zeta - a2 * a2 - a3 * a3) / (2.0 * a2 * a3);
    const T bend = acos(T(min(max(C3, T(-1.0)), T(1.0))));
    const T q3 = copysign(bend, T(bend_sign(rho)));
    const SinCos<T> third = sincos(q3);
    const T q1 = atan2(T(front * tip[1]), T(front * tip[0]));
    const T q2 = atan2(zeta, rho) - atan2(T(a3 * third.sin), T(a2 + a3 * third.cos));
    return {{q1, q2, q3}, C3};
}

// front: the tip lies before axis 1 along u, or behind it (for a planar arm: joint 1 faces the point, or faces away from
// it); up: the elbow lies above the line from joint 2 to the tip (2.7), (10.5). The result is meaningless where
// |cos_q3| > 1.
template <class P, class T>
IkResult<T> inverse_kinematics(const Arm<P>& arm, const Vec3<T>& tip, bool front, bool up) {
    return inverse_kinematics_of_branch(arm, tip, T(front ? 1.0 : -1.0),
                                        [up](const T& rho) { return up ? T(-rho) : rho; });
}

// The branch of a pose with this radius and sine of the bend.
template <class P>
IkResult<double> inverse_kinematics_near(const Arm<P>& arm, const Vec3<double>& tip, double radius, double bend) {
    return inverse_kinematics_of_branch(arm, tip, radius >= 0 ? 1.0 : -1.0,
                                        [bend](double) { return bend > 0 ? 1.0 : -1.0; });
}

}  // namespace arm3r
