#pragma once
// The derivatives of the dynamics with respect to the state and the torque, exact to rounding, by Dual; docs/model.md
// (3.13). Slide convention; the force on the tip is constant.

#include <array>

#include "arm3r/model/dynamics.hpp"
#include "arm3r/numbers/dual.hpp"

namespace arm3r {

// The derivatives of a joint vector: [k](i, j) is that of component i with respect to component j of argument k.
using Derivatives = std::array<Mat3<double>, 3>;

// Of f(a, b, c), a joint vector over Dual.
template <class F>
Derivatives derivatives(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c, F f) {
    using D = Dual<9>;
    const auto variables = [](const Vec3<double>& v, int first) {
        return Vec3<D>(D::variable(v[0], first), D::variable(v[1], first + 1), D::variable(v[2], first + 2));
    };
    const Vec3<D> result = f(variables(a, 0), variables(b, 3), variables(c, 6));
    Derivatives by;
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) by[k](i, j) = result[i].slope[3 * k + j];
    return by;
}

// Of qdd with respect to q, qd and tau; the last is the inverse of the mass matrix.
inline Derivatives forward_dynamics_derivatives(const Arm<double>& arm, const Vec3<double>& q, const Vec3<double>& qd,
                                                const Vec3<double>& tau, const Vec3<double>& f_on_tip) {
    return derivatives(q, qd, tau, [&](const auto& angles, const auto& rates, const auto& torque) {
        return forward_dynamics(arm, pose(angles), rates, torque, broadcast<Dual<9>>(f_on_tip));
    });
}

// Of tau with respect to q, qd and qdd; the last is the mass matrix.
inline Derivatives inverse_dynamics_derivatives(const Arm<double>& arm, const Vec3<double>& q, const Vec3<double>& qd,
                                                const Vec3<double>& qdd, const Vec3<double>& f_on_tip) {
    return derivatives(q, qd, qdd, [&](const auto& angles, const auto& rates, const auto& acceleration) {
        return inverse_dynamics(arm, pose(angles), rates, acceleration, broadcast<Dual<9>>(f_on_tip));
    });
}

}  // namespace arm3r
