#pragma once
// Position and velocity of an elbow arm in closed form; docs/model.md, section 10. Slide convention; results in the axes
// of the scenario.

#include "arm3r/model/arm.hpp"
#include "arm3r/model/pose.hpp"

namespace arm3r::elbow_arm {

// Links 2 and 3 in their plane, m: from joint 2 to joint 3 and from there to the tip, along u and k (10.1).
template <class T>
struct Reaches {
    T r2, h2, r3, h3;
};

template <class P, class T>
ARM3R_INLINE Reaches<T> reaches(const Arm<P>& arm, const Pose<T>& p) {
    const P &a3 = arm.elbow.tip[0], &b3 = arm.elbow.tip[1];
    return {arm.link2.length * p.C2, arm.link2.length * p.S2, a3 * p.C23 - b3 * p.S23, a3 * p.S23 + b3 * p.C23};
}

template <class P, class T>
ARM3R_INLINE T radius(const Arm<P>& arm, const Reaches<T>& m) {  // r (10.1)
    return arm.elbow.shoulder_offset + (m.r2 + m.r3);
}

// From base axes to those of the scenario, and back.
template <class P, class T>
ARM3R_INLINE Vec3<T> to_scenario(const Arm<P>& arm, const Vec3<T>& v) {
    if (!arm.elbow.base_is_turned) return v;
    const Mat3<P>& R = arm.elbow.rotation;
    Vec3<T> out;
    for (int i = 0; i < 3; ++i) out[i] = R(i, 0) * v[0] + R(i, 1) * v[1] + R(i, 2) * v[2];
    return out;
}
template <class P, class T>
ARM3R_INLINE Vec3<T> to_base(const Arm<P>& arm, const Vec3<T>& v) {
    if (!arm.elbow.base_is_turned) return v;
    const Mat3<P>& R = arm.elbow.rotation;
    Vec3<T> out;
    for (int i = 0; i < 3; ++i) out[i] = R(0, i) * v[0] + R(1, i) * v[1] + R(2, i) * v[2];
    return out;
}

// A direction by its components along u, v, k.
template <class P, class T>
ARM3R_INLINE Vec3<T> direction(const Arm<P>& arm, const Pose<T>& p, const T& u, const T& v, const T& k) {
    return to_scenario(arm, Vec3<T>(p.C1 * u - p.S1 * v, p.S1 * u + p.C1 * v, k));
}
template <class P, class T>
ARM3R_INLINE Vec3<T> point(const Arm<P>& arm, const Pose<T>& p, const T& u, const T& v, const T& k) {
    const Vec3<T> d = direction(arm, p, u, v, k);
    const Vec3<P>& o = arm.elbow.position;
    return {o[0] + d[0], o[1] + d[1], o[2] + d[2]};
}

// The components of a vector along u, v, k.
template <class P, class T>
ARM3R_INLINE Vec3<T> components(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& vector) {
    const Vec3<T> b = to_base(arm, vector);
    return {p.C1 * b[0] + p.S1 * b[1], p.C1 * b[1] - p.S1 * b[0], b[2]};
}

// A matrix whose columns are directions.
template <class T>
ARM3R_INLINE Mat3<T> from_columns(const Vec3<T>& first, const Vec3<T>& second, const Vec3<T>& third) {
    Mat3<T> m;
    for (int i = 0; i < 3; ++i) m(i, 0) = first[i], m(i, 1) = second[i], m(i, 2) = third[i];
    return m;
}

template <class P, class T>
ARM3R_INLINE Vec3<T> tip_position(const Arm<P>& arm, const Pose<T>& p) {  // (10.1)
    const Reaches<T> m = reaches(arm, p);
    return point(arm, p, radius(arm, m), T(arm.elbow.lateral), T(m.h2 + m.h3));
}

// The origin of link 3.
template <class P, class T>
ARM3R_INLINE Vec3<T> elbow_position(const Arm<P>& arm, const Pose<T>& p) {
    return point(arm, p, T(arm.elbow.shoulder_offset + arm.link2.length * p.C2), T(-arm.elbow.offset),
                 T(arm.link2.length * p.S2));
}

// The origin of link 2.
template <class P, class T>
ARM3R_INLINE Vec3<T> shoulder_position(const Arm<P>& arm, const Pose<T>& p) {
    return point(arm, p, T(arm.elbow.shoulder_offset), T(0.0), T(0.0));
}

template <class P, class T>
ARM3R_INLINE Mat3<T> centres_of_mass(const Arm<P>& arm, const Pose<T>& p) {  // a row a link
    const auto& links = arm.elbow.links;
    const Vec3<P>&c1 = links[0].com, &c2 = links[1].com, &c3 = links[2].com;
    const P& a1 = arm.elbow.shoulder_offset;
    return from_rows<T>(
        point(arm, p, T(c1[0]), T(c1[1]), T(c1[2])),
        point(arm, p, T(a1 + (c2[0] * p.C2 - c2[1] * p.S2)), T(-c2[2]), T(c2[0] * p.S2 + c2[1] * p.C2)),
        point(arm, p, T(a1 + (arm.link2.length * p.C2 + (c3[0] * p.C23 - c3[1] * p.S23))),
              T(-(arm.elbow.offset + c3[2])), T(arm.link2.length * p.S2 + (c3[0] * p.S23 + c3[1] * p.C23))));
}

// a2 (h3 C2 - r3 S2) = a2 a3 sin q3, m^2, where the tip lies along x of link 3 (10.3).
template <class T>
ARM3R_INLINE T plane_determinant(const Reaches<T>& m) {
    return m.h3 * m.r2 - m.r3 * m.h2;
}

template <class P, class T>
ARM3R_INLINE Mat3<T> jacobian(const Arm<P>& arm, const Pose<T>& p) {  // (10.2)
    const Reaches<T> m = reaches(arm, p);
    const T o(0.0);
    return from_columns(direction(arm, p, T(-arm.elbow.lateral), radius(arm, m), o),
                        direction(arm, p, T(-(m.h2 + m.h3)), o, T(m.r2 + m.r3)), direction(arm, p, T(-m.h3), o, m.r3));
}

// The angular velocity of link 3 per joint rate.
template <class P, class T>
ARM3R_INLINE Mat3<T> angular_jacobian(const Arm<P>& arm, const Pose<T>& p) {
    const T o(0.0), l(1.0);
    const Vec3<T> across = direction(arm, p, o, T(-1.0), o);
    return from_columns(direction(arm, p, o, o, l), across, across);
}

// The rates of q1, q2, q2 + q3 that move the tip with a velocity of the components x along u, v, k (10.3).
template <class P, class T>
ARM3R_INLINE Vec3<T> angle_rates(const Arm<P>& arm, const Reaches<T>& m, const Vec3<T>& x) {
    const T w1 = x[1] / radius(arm, m);
    const T inverse_plane = 1.0 / plane_determinant(m);
    const T outward = x[0] + arm.elbow.lateral * w1;
    return {w1, (m.r3 * outward + m.h3 * x[2]) * inverse_plane, -((m.r2 * outward + m.h2 * x[2]) * inverse_plane)};
}

template <class P, class T>
ARM3R_INLINE Vec3<T> joint_rates(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& xd) {
    const Vec3<T> w = angle_rates(arm, reaches(arm, p), components(arm, p, xd));
    return {w[0], w[1], w[2] - w[1]};
}

template <class P, class T>
ARM3R_INLINE Mat3<T> inverse_jacobian(const Arm<P>& arm, const Pose<T>& p) {
    const T o(0.0), l(1.0);
    return from_columns(elbow_arm::joint_rates(arm, p, Vec3<T>(l, o, o)),
                        elbow_arm::joint_rates(arm, p, Vec3<T>(o, l, o)),
                        elbow_arm::joint_rates(arm, p, Vec3<T>(o, o, l)));
}

template <class P, class T>
ARM3R_INLINE Mat3<T> jacobian_dot(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {  // (10.4)
    const Reaches<T> m = reaches(arm, p);
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2];
    const T r3d = -(m.h3 * w3), h3d = m.r3 * w3, rd = r3d - m.h2 * w2, hd = h3d + m.r2 * w2;
    return from_columns(direction(arm, p, T(-(radius(arm, m) * w1)), T(rd - arm.elbow.lateral * w1), T(0.0)),
                        direction(arm, p, T(-hd), T(-((m.h2 + m.h3) * w1)), rd),
                        direction(arm, p, T(-h3d), T(-(m.h3 * w1)), r3d));
}

// Jdot(q, qd) rates.
template <class P, class T>
ARM3R_INLINE Vec3<T> jacobian_dot_times(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& rates) {
    const Reaches<T> m = reaches(arm, p);
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2], v1 = rates[0], v2 = rates[1], v3 = rates[1] + rates[2];
    const T second = w2 * v2, third = w3 * v3, first = w1 * v1;
    return direction(arm, p, T(-(radius(arm, m) * first + (m.r2 * second + m.r3 * third))),
                     T(-((m.h2 * w2 + m.h3 * w3) * v1 + (m.h2 * v2 + m.h3 * v3) * w1) - arm.elbow.lateral * first),
                     T(-(m.h2 * second + m.h3 * third)));
}

template <class P, class T>
ARM3R_INLINE Vec3<T> tip_velocity(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
    const Reaches<T> m = reaches(arm, p);
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2];
    return direction(arm, p, T(-(m.h2 * w2 + m.h3 * w3) - arm.elbow.lateral * w1), T(radius(arm, m) * w1),
                     T(m.r2 * w2 + m.r3 * w3));
}

// The torques on the three angles q1, q2, q2 + q3 of a force at the tip, by its components along u, v, k.
template <class P, class T>
ARM3R_INLINE Vec3<T> angle_torques(const Arm<P>& arm, const Reaches<T>& m, const Vec3<T>& f) {
    return {radius(arm, m) * f[1] - arm.elbow.lateral * f[0], m.r2 * f[2] - m.h2 * f[0], m.r3 * f[2] - m.h3 * f[0]};
}

template <class P, class T>
ARM3R_INLINE Vec3<T> from_base_position(const Arm<P>& arm, const Vec3<T>& tip) {
    const Vec3<P>& o = arm.elbow.position;
    return to_base(arm, Vec3<T>(tip[0] - o[0], tip[1] - o[1], tip[2] - o[2]));
}

// The joint angles at a tip position on the branch where r has the sign of `front` and the bend that of `bend_sign(rho)`
// (10.5); rho: of the tip from joint 2, along u.
template <class P, class T, class BendSign>
ARM3R_INLINE IkResult<T> inverse_kinematics_of_branch(const Arm<P>& arm, const Vec3<T>& tip, const T& front,
                                                      BendSign bend_sign) {
    const P &a2 = arm.link2.length, &a3 = arm.link3.length, &e = arm.elbow.lateral;
    const Vec3<T> x = from_base_position(arm, tip);
    const T R = x[0] * x[0] + x[1] * x[1] - e * e;
    const T r = front * sqrt(T(max(R, T(0.0))));
    const T rho = r - arm.elbow.shoulder_offset, zeta = x[2];
    const T C3 = (rho * rho + zeta * zeta - a2 * a2 - a3 * a3) / (2.0 * a2 * a3);
    const T bend = copysign(acos(T(min(max(C3, T(-1.0)), T(1.0)))), T(bend_sign(rho)));
    const SinCos<T> third = sincos(bend);
    const T q1 = atan2(T(x[1] * r - x[0] * e), T(x[0] * r + x[1] * e));
    const T q2 = atan2(zeta, rho) - atan2(T(a3 * third.sin), T(a2 + a3 * third.cos));
    const T tip_angle(atan2(arm.elbow.tip[1], arm.elbow.tip[0]));
    constexpr double out_of_reach = 2;  // no cosine
    return {{q1, q2, bend - tip_angle}, select(R < T(0.0), T(out_of_reach), C3)};
}

}  // namespace arm3r::elbow_arm
