#pragma once
// Forces and motion of the arm, in closed form; docs/model.md, section 3. Slide convention. The formulas that stand here
// are those of the planar arm; those of the elbow arm stand in elbow_dynamics.hpp.

#include "arm3r/model/elbow_dynamics.hpp"
#include "arm3r/model/kinematics.hpp"

namespace arm3r {

// M: kg m^2, armature included (3.3).
template <class P, class T>
ARM3R_INLINE Mat3<T> mass_matrix(const Arm<P>& arm, const Pose<T>& p) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::mass_matrix(arm, p);
    const Lumped<P>& l = arm.lumped;
    const T C3 = p.C2 * p.C23 + p.S2 * p.S23;
    const T M11 = l.A1 + p.C2 * (l.A2 * p.C2 + l.B * p.C23) + p.C23 * (l.A3 * p.C23 + l.B * p.C2);
    const T M22 = l.B2 + l.B3 + 2.0 * l.B * C3;
    const T M23 = l.B3 + l.B * C3;
    return from_rows<T>({M11, T(0.0), T(0.0)},  //
                        {T(0.0), M22, M23},     //
                        {T(0.0), M23, T(l.B3 + l.J3)});
}

// C: the Christoffel choice, so that Mdot = C + C^T (3.4).
template <class P, class T>
ARM3R_INLINE Mat3<T> coriolis_matrix(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::coriolis_matrix(arm, p, qd);
    const Lumped<P>& l = arm.lumped;
    const T h3 = -p.S23 * (l.A3 * p.C23 + l.B * p.C2);
    const T h2 = h3 - p.S2 * (l.A2 * p.C2 + l.B * p.C23);
    const T b = l.B * sin_q3(p);
    return from_rows<T>({h2 * qd[1] + h3 * qd[2], h2 * qd[0], h3 * qd[0]},  //
                        {-h2 * qd[0], -b * qd[2], -b * (qd[1] + qd[2])},    //
                        {-h3 * qd[0], b * qd[1], T(0.0)});
}

template <class P, class T>
ARM3R_INLINE Vec3<T> velocity_product(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {  // C qd
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::velocity_product(arm, p, qd);
    const Lumped<P>& l = arm.lumped;
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2];
    const T row2 = p.S2 * (l.A2 * p.C2 + l.B * p.C23);
    const T row3 = p.S23 * (l.A3 * p.C23 + l.B * p.C2);
    const T b = l.B * sin_q3(p);
    const T third = row3 * w1 * w1 + b * w2 * w2;
    return {-2.0 * (row2 * w2 + row3 * w3) * w1, row2 * w1 * w1 - b * w3 * w3 + third, third};
}

// The weight of the links on the three angles q1, q2, q2 + q3 (3.5). g is any gravity vector, in base axes. If it is
// vertical, both branches give the same bits.
template <class P, class G, class T>
ARM3R_INLINE Vec3<T> link_weight(const Lumped<P>& l, const Vec3<G>& g, bool vertical, const Pose<T>& p) {
    if (vertical) return {T(0.0), -(l.G2 * p.C2) * g[2], -(l.G3 * p.C23) * g[2]};
    const T gr = g[0] * p.C1 + g[1] * p.S1;
    const T gt = g[1] * p.C1 - g[0] * p.S1;
    return {-(l.G2 * p.C2 + l.G3 * p.C23) * gt, (l.G2 * p.S2) * gr - (l.G2 * p.C2) * g[2],
            (l.G3 * p.S23) * gr - (l.G3 * p.C23) * g[2]};
}

template <class P, class T>
ARM3R_INLINE Vec3<T> link_weight(const Arm<P>& arm, const Pose<T>& p) {
    if (arm.is_elbow) return elbow_arm::link_weight(arm, p);
    return link_weight(arm.lumped, arm.gravity, arm.gravity_is_vertical, p);
}

// tau_g: the torque that holds the arm at rest, dU/dq (3.5).
template <class P, class T>
ARM3R_INLINE Vec3<T> gravity_torque(const Arm<P>& arm, const Pose<T>& p) {
    const Vec3<T> weight = link_weight(arm, p);
    return {weight[0], weight[1] + weight[2], weight[2]};
}

// tau_f: viscous and regularised dry friction (3.6); always dissipative.
template <class P, class T>
ARM3R_INLINE Vec3<T> viscous_torque(const Arm<P>& arm, const Vec3<T>& qd) {
    const T o(0.0);
    if (!arm.has_damping) return {o, o, o};
    return {arm.damping[0] * qd[0], arm.damping[1] * qd[1], arm.damping[2] * qd[2]};
}
template <class P, class T>
ARM3R_INLINE Vec3<T> friction_torque(const Arm<P>& arm, const Vec3<T>& qd) {
    const Vec3<T> tau_f = viscous_torque(arm, qd);
    if (!arm.has_dry_friction) return tau_f;
    const auto dry = [&](int i)
                         ARM3R_INLINE_LAMBDA { return arm.friction[i] * tanh(T(qd[i] / arm.friction_velocity)); };
    return {tau_f[0] + dry(0), tau_f[1] + dry(1), tau_f[2] + dry(2)};
}

// The mass matrix of the link angles (3.8), as far as it does not depend on the pose, and the product of its diagonal.
template <class P>
struct LinkInertia {
    P Mb22, Mb33, product;

    ARM3R_INLINE explicit LinkInertia(const Lumped<P>& l)
        : Mb22(l.B2 + l.J3), Mb33(l.B3 + l.J3), product(Mb22 * Mb33) {}
};

template <class P, class T>
ARM3R_INLINE T kinetic_energy(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {  // T (3.7)
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::kinetic_energy(arm, p, qd);
    const Lumped<P>& l = arm.lumped;
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2];
    const T C3 = p.C2 * p.C23 + p.S2 * p.S23;
    const T BC23 = l.B * p.C23, BC2 = l.B * p.C2;
    const T M11 = l.A1 + p.C2 * (l.A2 * p.C2 + BC23) + p.C23 * (l.A3 * p.C23 + BC2);
    const LinkInertia<P> inertia(l);
    const T Mb23 = l.B * C3 - l.J3;
    return 0.5 * (M11 * (w1 * w1) + inertia.Mb22 * (w2 * w2) + inertia.Mb33 * (w3 * w3)) + Mb23 * (w2 * w3);
}

// The energy of gravity in a pose, with `fixed`, kg m, beside the part that changes with it.
template <class P, class T>
ARM3R_INLINE T energy_of_gravity(const Arm<P>& arm, const Pose<T>& p, const P& fixed) {
    const Lumped<P>& l = arm.lumped;
    const T radial = l.G2 * p.C2 + l.G3 * p.C23;
    const T up = l.G2 * p.S2 + l.G3 * p.S23;
    if (arm.gravity_is_vertical) return -(arm.gravity[2] * (fixed + up));
    return -(arm.gravity[0] * p.C1 * radial + arm.gravity[1] * p.S1 * radial + arm.gravity[2] * (fixed + up));
}

template <class P, class T>
ARM3R_INLINE T potential_energy(const Arm<P>& arm, const Pose<T>& p) {  // U, zero at the base origin (3.7)
    if (arm.is_elbow) [[unlikely]]
        return arm.elbow.fixed_energy + elbow_arm::potential_energy_of_pose(arm, p);
    const P fixed = arm.link1.mass * arm.link1.com + (arm.link2.mass + arm.link3.mass + arm.payload) * arm.base_height;
    return energy_of_gravity(arm, p, fixed);
}

// U, zero where links 2 and 3 are level: what its changes are computed from, without the rounding errors of a height.
template <class P, class T>
ARM3R_INLINE T potential_energy_of_pose(const Arm<P>& arm, const Pose<T>& p) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::potential_energy_of_pose(arm, p);
    return energy_of_gravity(arm, p, P(0.0));
}

// J: no change of U, from any pose to any other, is more than twice this.
template <class P>
ARM3R_INLINE P weight_times_reach(const Arm<P>& arm) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::weight_times_reach(arm);
    const Vec3<P>& g = arm.gravity;
    return sqrt(P(dot(g, g))) * (abs(arm.lumped.G2) + abs(arm.lumped.G3));
}

// The joint torques of a force at the tip: J^T f.
template <class P, class T>
ARM3R_INLINE Vec3<T> tip_force_torque(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& f_on_tip) {
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::tip_force_torque(arm, p, f_on_tip);
    const T radial = p.C1 * f_on_tip[0] + p.S1 * f_on_tip[1];
    const T around = p.C1 * f_on_tip[1] - p.S1 * f_on_tip[0];
    const T third = arm.link3.length * (p.C23 * f_on_tip[2] - p.S23 * radial);
    const T second = arm.link2.length * (p.C2 * f_on_tip[2] - p.S2 * radial);
    return {radius(arm, p) * around, second + third, third};
}

// qdd from the torques on the three angles q1, q2, q2 + q3 (3.8).
template <class P, class T>
ARM3R_INLINE Vec3<T> acceleration_by_link_torques(const Lumped<P>& l, const LinkInertia<P>& inertia, const Pose<T>& p,
                                                  const Vec3<T>& qd, const Vec3<T>& torque) {
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2];
    const T w1_2 = w1 * w1;
    const T C3 = p.C2 * p.C23 + p.S2 * p.S23;
    const T BS3 = l.B * sin_q3(p);
    const T BC23 = l.B * p.C23, BC2 = l.B * p.C2;
    const T Pc = l.A2 * p.C2 + BC23, Q = l.A3 * p.C23 + BC2;
    const T S2P = p.S2 * Pc, S23Q = p.S23 * Q;

    const T M11 = l.A1 + p.C2 * Pc + p.C23 * Q;
    const T R1 = torque[0] + (S2P * w2 + S23Q * w3) * (w1 + w1);
    const T R2 = torque[1] - S2P * w1_2 + BS3 * (w3 * w3);
    const T R3 = torque[2] - S23Q * w1_2 - BS3 * (w2 * w2);

    const T Mb23 = l.B * C3 - l.J3;
    const T inverse_det = 1.0 / (inertia.product - Mb23 * Mb23);
    const T phi2_dd = (inertia.Mb33 * R2 - Mb23 * R3) * inverse_det;
    const T phi3_dd = (inertia.Mb22 * R3 - Mb23 * R2) * inverse_det;
    return {R1 / M11, phi2_dd, phi3_dd - phi2_dd};
}

// qdd from the torques that drive the joints (actuators less friction plus J^T f) and from the weight on the link
// angles, or the part of it that a controller does not compensate.
template <class P, class T>
ARM3R_INLINE Vec3<T> joint_acceleration(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& drive,
                                        const Vec3<T>& weight) {
    const Vec3<T> torque(drive[0] - weight[0], (drive[1] - drive[2]) - weight[1], drive[2] - weight[2]);
    if (arm.is_elbow)
        return elbow_arm::acceleration_by_angle_torques(arm, p, elbow_arm::first_moments(arm, p), qd, torque);
    return acceleration_by_link_torques(arm.lumped, LinkInertia<P>(arm.lumped), p, qd, torque);
}

template <class P, class T>
ARM3R_INLINE Vec3<T> joint_acceleration(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& drive) {
    return joint_acceleration(arm, p, qd, drive, link_weight(arm, p));
}

// M qdd + C qd + tau_g + tau_f = tau + J^T f_on_tip (3.1), solved for qdd.
template <class P, class T>
ARM3R_INLINE Vec3<T> forward_dynamics(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& tau,
                                      const Vec3<T>& f_on_tip) {
    const Vec3<T> tau_f = friction_torque(arm, qd);
    const Vec3<T> tau_e = tip_force_torque(arm, p, f_on_tip);
    return joint_acceleration(
        arm, p, qd, Vec3<T>(tau[0] - tau_f[0] + tau_e[0], tau[1] - tau_f[1] + tau_e[1], tau[2] - tau_f[2] + tau_e[2]));
}

// The same equation (3.1), solved for tau.
template <class P, class T>
ARM3R_INLINE Vec3<T> inverse_dynamics(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd, const Vec3<T>& qdd,
                                      const Vec3<T>& f_on_tip) {
    const Mat3<T> M = mass_matrix(arm, p);
    const Vec3<T> v = velocity_product(arm, p, qd);
    const Vec3<T> tau_g = gravity_torque(arm, p);
    const Vec3<T> tau_f = friction_torque(arm, qd);
    const Vec3<T> tau_e = tip_force_torque(arm, p, f_on_tip);
    if (arm.is_elbow) [[unlikely]]
        return minus(plus(plus(plus(times(M, qdd), v), tau_g), tau_f), tau_e);
    return {M(0, 0) * qdd[0] + v[0] + tau_g[0] + tau_f[0] - tau_e[0],
            M(1, 1) * qdd[1] + M(1, 2) * qdd[2] + v[1] + tau_g[1] + tau_f[1] - tau_e[1],
            M(2, 1) * qdd[1] + M(2, 2) * qdd[2] + v[2] + tau_g[2] + tau_f[2] - tau_e[2]};
}

// J M^-1 J^T: 1/kg, the mobility of the tip (3.11).
template <class P, class T>
ARM3R_INLINE Mat3<T> tip_mobility(const Arm<P>& arm, const Pose<T>& p) {
    const Mat3<T> J = jacobian(arm, p);
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::tip_mobility(arm, p, J);
    const Mat3<T> M = mass_matrix(arm, p);
    const T inverse_det = 1.0 / (M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2));
    Mat3<T> W;
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            const T lower =
                J(i, 1) * (M(2, 2) * J(j, 1) - M(1, 2) * J(j, 2)) + J(i, 2) * (M(1, 1) * J(j, 2) - M(1, 2) * J(j, 1));
            W(i, j) = J(i, 0) * J(j, 0) / M(0, 0) + lower * inverse_det;
            W(j, i) = W(i, j);
        }
    }
    return W;
}

// m_n = 1 / (n^T J M^-1 J^T n): kg, the mass that the tip shows along the unit vector n (3.11).
template <class P, class T>
ARM3R_INLINE T effective_mass(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& n) {
    const Mat3<T> W = tip_mobility(arm, p);
    const T diagonal = W(0, 0) * n[0] * n[0] + W(1, 1) * n[1] * n[1] + W(2, 2) * n[2] * n[2];
    return 1.0 / (diagonal + 2.0 * (W(0, 1) * n[0] * n[1] + W(0, 2) * n[0] * n[2] + W(1, 2) * n[1] * n[2]));
}

// Lambda = J^-T M J^-1: kg (3.11). Grows without bound towards a singular pose.
template <class P, class T>
ARM3R_INLINE Mat3<T> operational_space_inertia(const Arm<P>& arm, const Pose<T>& p) {
    const Mat3<T> M = mass_matrix(arm, p);
    const Mat3<T> K = inverse_jacobian(arm, p);
    if (arm.is_elbow) [[unlikely]]
        return elbow_arm::transformed(M, K);
    Mat3<T> L;
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            L(i, j) = M(0, 0) * K(0, i) * K(0, j) + M(1, 1) * K(1, i) * K(1, j) + M(2, 2) * K(2, i) * K(2, j) +
                      M(1, 2) * (K(1, i) * K(2, j) + K(2, i) * K(1, j));
            L(j, i) = L(i, j);
        }
    }
    return L;
}

// Whether the mass matrix is positive definite beyond its rounding error.
template <class P, class T>
ARM3R_INLINE auto is_well_conditioned(const Arm<P>& arm, const Pose<T>& p) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    if (arm.is_elbow) [[unlikely]] {
        const elbow_arm::Pivots<T> pivots = elbow_arm::pivots(arm, p);
        return pivots.lower > T(8 * epsilon) && pivots.first > T(8 * epsilon * pivots.diagonal);
    }
    const Mat3<T> M = mass_matrix(arm, p);
    return M(0, 0) > T(0.0) && T(M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2)) > T(8 * epsilon * M(1, 1) * M(2, 2));
}

}  // namespace arm3r
