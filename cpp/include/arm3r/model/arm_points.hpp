#pragma once
// The arm as a line of points, for drawings.

#include <array>

#include "arm3r/model/kinematics.hpp"

namespace arm3r {

inline constexpr std::size_t arm_point_count = 7;

// m, scenario axes: the point of axis 1 nearest to the origin, that at the height of joint 2, joint 2, the end of link 2 in
// its plane, joint 3, the end of link 3 in its plane, the tip. Some coincide; of a planar arm three of them are different
// from their neighbours: joint 2, joint 3, the tip.
template <class P, class T>
ARM3R_INLINE std::array<Vec3<T>, arm_point_count> arm_points(const Arm<P>& arm, const Pose<T>& p) {
    const T o(0.0);
    const Vec3<T> shoulder = shoulder_position(arm, p), elbow = elbow_position(arm, p), tip = tip_position(arm, p);
    if (!arm.is_elbow) return {Vec3<T>(o, o, o), shoulder, shoulder, elbow, elbow, tip, tip};
    const Vec3<T> axis = elbow_arm::direction(arm, p, o, o, T(1.0)),
                  across = elbow_arm::direction(arm, p, o, T(1.0), o);
    const Vec3<T> base = broadcast<T>(arm.elbow.position);
    return {minus(base, scaled(dot(base, axis), axis)),
            base,
            shoulder,
            plus(elbow, scaled(T(arm.elbow.offset), across)),
            elbow,
            plus(tip, scaled(T(arm.elbow.tip[2]), across)),
            tip};
}

}  // namespace arm3r
