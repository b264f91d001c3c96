#pragma once
// An impedance whose reference moves along the normal until the force is right; docs/model.md, section 7. memory[0]: its
// displacement in the pressing direction, m, where it integrates. Seraji and Colbaugh 1997. Slide convention, base axes.

#include "arm3r/control/force_loop.hpp"
#include "arm3r/control/impedance_laws.hpp"

namespace arm3r {

// n . K^-1 n: m/N, the compliance of the spring along n. An axis perpendicular to n may have no stiffness.
template <class P, class T>
ARM3R_INLINE T compliance_along(const Vec3<P>& stiffness, const Vec3<T>& n) {
    const auto part = [&](int i)
                          ARM3R_INLINE_LAMBDA { return select(n[i] == T(0.0), T(0.0), T(n[i] * n[i] / stiffness[i])); };
    return part(0) + part(1) + part(2);
}

// The displacement from the reference position to s_E + f_d/k^ + f_d n . K_d^-1 n, s_E the face of the wall: m, in the
// pressing direction (7.18).
template <class P, class T>
ARM3R_INLINE T indirect_displacement(const Controller<P>& controller, const Measurement<T>& sensed) {
    const T f_d = desired_force_at(controller.reference, sensed.t);
    const T depth =
        f_d / controller.gains.assumed_stiffness + f_d * compliance_along(controller.gains.stiffness, sensed.n);
    return depth - sensed.face + dot(sensed.n, desired_motion_at(controller.reference, sensed.t).position);
}

template <class P, class T>
ARM3R_INLINE void adaptive_reference(const Controller<P>& controller, const Measurement<T>& sensed,
                                     const std::array<T, law_memory>& memory, Command<T>& command) {
    const bool integrates = controller.adaptation == Adaptation::integral;
    const T x_r = integrates ? memory[0] : indirect_displacement(controller, sensed);
    const TipTask<T> tip = tip_task(controller, sensed);
    command.tau = shaped_impedance_torque(controller, sensed, tip, plus(tip.error, force_along_press(sensed, x_r)));
    if (integrates)
        command.rates[0] = controller.gains.reference_gain * (force_error(controller, sensed) * sensed.force_phase);
}

}  // namespace arm3r
