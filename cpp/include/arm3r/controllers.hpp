#pragma once
// The control laws: tau as a function of what a controller may know. Each owns a copy of the arm, possibly a wrong one.
// Slide convention.

#include "arm3r/dynamics.hpp"
#include "arm3r/recursion.hpp"

namespace arm3r {

enum class Controls { none, constant, gravity_compensation };
enum class Algorithm { closed_form, recursion };

template <class P>
struct Controller {
    Controls type;
    Vec3<P> torque;       // N m, for constant
    Algorithm algorithm;  // for gravity_compensation
    Arm<P> model;         // the controller's copy; its gravity is what it compensates
};

template <class P, class T>
ARM3R_INLINE Vec3<T> control(const Controller<P>& controller, const Vec3<T>& q, const Pose<T>& p) {
    if (controller.type == Controls::gravity_compensation)
        return controller.algorithm == Algorithm::closed_form ? gravity_torque(controller.model, p)
                                                              : recursion_gravity_torque(controller.model, q);
    if (controller.type == Controls::constant) return lifted<T>(controller.torque);
    return {T(0.0), T(0.0), T(0.0)};
}

// What the actuators can give of it.
template <class P, class T>
ARM3R_INLINE Vec3<T> limited(const Arm<P>& arm, const Vec3<T>& tau) {
    if (!arm.has_torque_limit) return tau;
    const auto clamped = [&](int i) ARM3R_INLINE_LAMBDA {
        return T(max(min(tau[i], T(arm.torque_limit[i])), T(-arm.torque_limit[i])));
    };
    return {clamped(0), clamped(1), clamped(2)};
}

}  // namespace arm3r
