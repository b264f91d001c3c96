#pragma once
// A wall that exists in the controller only: spring and damper on a plane; docs/model.md, section 7. Slide convention,
// base axes.

#include "arm3r/control/impedance_laws.hpp"

namespace arm3r {

// N along the plane's normal, never pulling; K and B are the first of stiffness and damping (7.20).
template <class P, class T>
ARM3R_INLINE T virtual_wall_force(const Gains<P>& gains, const Vec3<T>& x, const Vec3<T>& xd) {
    const Vec3<T> normal = broadcast<T>(gains.plane_normal);
    const T depth = dot(normal, minus(broadcast<T>(gains.plane_point), x)), rate = -dot(normal, xd), o(0.0);
    return max_where(depth > o, o, T(gains.stiffness[0] * depth + gains.damping[0] * rate));
}

template <class P, class T>
ARM3R_INLINE Vec3<T> virtual_wall(const Controller<P>& controller, const Measurement<T>& sensed) {
    const T force = virtual_wall_force(controller.gains, tip_position(controller.model, sensed.pose),
                                       tip_velocity(controller.model, sensed.pose, sensed.qd));
    return gravity_plus_force(controller.model, sensed.pose,
                              scaled(force, broadcast<T>(controller.gains.plane_normal)));
}

}  // namespace arm3r
