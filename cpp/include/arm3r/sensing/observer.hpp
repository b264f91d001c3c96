#pragma once
// The momentum observer estimates the external torque from the momentum of the arm (8.4). De Luca and Mattone 2003,
// 2005. Its state s is the momentum that the model expects; s = p(0) at the start.

#include "arm3r/model/dynamics.hpp"

namespace arm3r {

// p: the generalised momentum M qd, kg m^2/s.
template <class P, class T>
ARM3R_INLINE Vec3<T> momentum(const Arm<P>& model, const Pose<T>& p, const Vec3<T>& qd) {
    return times(mass_matrix(model, p), qd);
}

// r: the estimate of the external joint torque, N m.
template <class P, class T>
ARM3R_INLINE Vec3<T> residual(const Vec3<P>& gain, const Vec3<T>& momentum, const Vec3<T>& s) {
    return {gain[0] * (momentum[0] - s[0]), gain[1] * (momentum[1] - s[1]), gain[2] * (momentum[2] - s[2])};
}

// ds/dt, N m, with the applied torque.
template <class P, class T>
ARM3R_INLINE Vec3<T> expected_rate(const Arm<P>& model, const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& tau,
                                   const Vec3<T>& r) {
    const Vec3<T> by_coriolis = transposed_times(coriolis_matrix(model, p, qd), qd);
    const Vec3<T> losses = plus(gravity_torque(model, p), friction_torque(model, qd));
    return plus(minus(plus(tau, by_coriolis), losses), r);
}

// F^ = J^-T r: the force at the tip that explains the residual, N, base axes; grows without bound near a singular pose.
template <class P, class T>
ARM3R_INLINE Vec3<T> force_from(const Arm<P>& model, const Pose<T>& p, const Vec3<T>& r) {
    return transposed_times(inverse_jacobian(model, p), r);
}

}  // namespace arm3r
