#pragma once
// Position and velocity of the arm in closed form; docs/model.md, section 2. Slide convention, base axes.

#include "arm3r/model/arm.hpp"
#include "arm3r/numbers/pack.hpp"

namespace arm3r {

// Sines and cosines of q1 and of the absolute link angles q2 and q2 + q3.
template <class T>
struct Pose {
    T S1, C1, S2, C2, S23, C23;
};

// sin q3: zero where the arm is stretched or folded.
template <class T>
ARM3R_INLINE T sin_q3(const Pose<T>& p) {
    return p.S23 * p.C2 - p.C23 * p.S2;
}

template <class T>
ARM3R_INLINE Pose<T> pose(const Vec3<T>& q) {
    const T sum = q[1] + q[2];
    const T added = sum - q[1];
    // the rounding error of the sum, exactly; the rotation below corrects it
    const T lost = (q[1] - (sum - added)) + (q[2] - added);
    const SinCos<T> first = sincos(q[0]);
    const auto [second, third] = sincos_pair(q[1], sum);
    return {first.sin, first.cos, second.sin, second.cos, third.sin + lost * third.cos, third.cos - lost * third.sin};
}

template <class P, class T>
ARM3R_INLINE T radius(const Arm<P>& arm, const Pose<T>& p) {  // r (2.2)
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
    return in_arm_plane(arm, p, radius(arm, p), height(arm, p));
}

template <class P, class T>
ARM3R_INLINE Vec3<T> elbow_position(const Arm<P>& arm, const Pose<T>& p) {  // (2.3)
    return in_arm_plane(arm, p, T(arm.link2.length * p.C2), T(arm.link2.length * p.S2));
}

template <class P, class T>
ARM3R_INLINE Mat3<T> centres_of_mass(const Arm<P>& arm, const Pose<T>& p) {  // (2.3), a row a link
    return from_rows<T>({T(0.0), T(0.0), T(arm.link1.com)},
                        in_arm_plane(arm, p, T(arm.link2.com * p.C2), T(arm.link2.com * p.S2)),
                        in_arm_plane(arm, p, T(arm.link2.length * p.C2 + arm.link3.com * p.C23),
                                     T(arm.link2.length * p.S2 + arm.link3.com * p.S23)));
}

// J: m, tip velocity per joint rate (2.4).
template <class P, class T>
ARM3R_INLINE Mat3<T> jacobian(const Arm<P>& arm, const Pose<T>& p) {
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
template <class T>
ARM3R_INLINE Mat3<T> angular_jacobian(const Pose<T>& p) {
    return from_rows<T>({T(0.0), p.S1, p.S1},    //
                        {T(0.0), -p.C1, -p.C1},  //
                        {T(1.0), T(0.0), T(0.0)});
}

// J-dot: m/s (2.6).
template <class P, class T>
ARM3R_INLINE Mat3<T> jacobian_dot(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
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
    const T w2 = qd[1], w3 = qd[1] + qd[2];
    const T radial = -(arm.link2.length * p.S2 * w2 + arm.link3.length * p.S23 * w3);
    const T up = arm.link2.length * p.C2 * w2 + arm.link3.length * p.C23 * w3;
    const T around = radius(arm, p) * qd[0];
    return {p.C1 * radial - p.S1 * around, p.S1 * radial + p.C1 * around, up};
}

template <class P, class T>
ARM3R_INLINE T manipulability(const Arm<P>& arm, const Pose<T>& p) {  // |det J| (2.8)
    const T S3 = sin_q3(p);
    return abs(T(arm.link2.length * arm.link3.length * S3 * radius(arm, p)));
}

// The distance of a point from the workspace, m: outside the outer radius or inside the inner one; not above 0 within
// the workspace.
template <class P>
double workspace_excess(const Arm<P>& arm, const Vec3<double>& tip) {
    const double a2 = arm.link2.length, a3 = arm.link3.length, zeta = tip[2] - arm.base_height;
    const double distance = sqrt(tip[0] * tip[0] + tip[1] * tip[1] + zeta * zeta);
    return max(distance - (a2 + a3), abs(a2 - a3) - distance);
}

template <class T>
struct IkResult {
    Vec3<T> q;
    T cos_q3;  // outside [-1, 1] the point is out of reach
};

// front: joint 1 faces the point, or faces away from it; up: the elbow lies above the line from shoulder to tip (2.7).
// The result is meaningless where |cos_q3| > 1.
template <class P, class T>
IkResult<T> inverse_kinematics(const Arm<P>& arm, const Vec3<T>& tip, bool front, bool up) {
    const P a2 = arm.link2.length, a3 = arm.link3.length;
    const T rho_2 = tip[0] * tip[0] + tip[1] * tip[1];
    const T rho = front ? T(sqrt(rho_2)) : T(-sqrt(rho_2));
    const T zeta = tip[2] - arm.base_height;
    const T C3 = (rho_2 + zeta * zeta - a2 * a2 - a3 * a3) / (2.0 * a2 * a3);
    const T bend = acos(T(min(max(C3, T(-1.0)), T(1.0))));
    const T q3 = front == up ? T(-bend) : bend;
    const SinCos<T> third = sincos(q3);
    const T q1 = front ? atan2(tip[1], tip[0]) : atan2(T(-tip[1]), T(-tip[0]));
    const T q2 = atan2(zeta, rho) - atan2(T(a3 * third.sin), T(a2 + a3 * third.cos));
    return {{q1, q2, q3}, C3};
}

}  // namespace arm3r
