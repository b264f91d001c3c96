#pragma once
// Forces and motion of an elbow arm in closed form; docs/model.md, section 10. Slide convention.

#include "arm3r/model/elbow_kinematics.hpp"

namespace arm3r::elbow_arm {

// The mass matrix of the angles q1, q2, q2 + q3 (10.6).
template <class T>
struct AngleInertia {
    T N11, N12, N13, N22, N23, N33;
};

// The first moments of links 2 and 3 about their joints along u and k, kg m; of link 2 with what hangs on its end.
template <class T>
struct FirstMoments {
    T X2, Z2, X3, Z3;
};

template <class P, class T>
ARM3R_INLINE FirstMoments<T> first_moments(const Arm<P>& arm, const Pose<T>& p) {
    const Lumped<P>& l = arm.lumped;
    const Elbow<P>& e = arm.elbow;
    return {l.G2 * p.C2 - e.Gy2 * p.S2, l.G2 * p.S2 + e.Gy2 * p.C2, l.G3 * p.C23 - e.Gy3 * p.S23,
            l.G3 * p.S23 + e.Gy3 * p.C23};
}

// Products that the terms of the mass matrix and its derivatives share, kg m^2.
template <class T>
struct SharedProducts {
    T D2S2, A2C2, D3S3, A3C3, aX3, aZ3;  // a: the length of link 2

    template <class P>
    ARM3R_INLINE SharedProducts(const Arm<P>& arm, const Pose<T>& p, const FirstMoments<T>& g)
        : D2S2(arm.elbow.D2 * p.S2),
          A2C2(arm.lumped.A2 * p.C2),
          D3S3(arm.elbow.D3 * p.S23),
          A3C3(arm.lumped.A3 * p.C23),
          aX3(arm.link2.length * g.X3),
          aZ3(arm.link2.length * g.Z3) {}
};

template <class P, class T>
ARM3R_INLINE AngleInertia<T> angle_inertia(const Arm<P>& arm, const Pose<T>& p, const FirstMoments<T>& g) {
    const Lumped<P>& l = arm.lumped;
    const Elbow<P>& e = arm.elbow;
    const SharedProducts<T> s(arm, p, g);
    const T once = s.D2S2 + s.aX3, offset = e.shoulder_offset * (g.X2 + g.X3);
    AngleInertia<T> N;
    N.N11 = l.A1 + (p.C2 * ((s.A2C2 + once) + once) + p.C23 * ((s.A3C3 + s.D3S3) + s.D3S3)) + (offset + offset);
    N.N12 = e.E2 * p.S2 + e.F2 * p.C2;
    N.N13 = e.E3 * p.S23 + e.F3 * p.C23;
    if (e.has_skew_rotors) {
        const T skew = e.E23 * p.S2 + e.F23 * p.C2;
        N.N12 = N.N12 + (e.K12 - skew);
        N.N13 = N.N13 + skew;
    }
    N.N22 = T(l.B2 + l.J3);
    N.N23 = (p.C2 * s.aX3 + p.S2 * s.aZ3) - l.J3;
    N.N33 = T(l.B3 + l.J3);
    return N;
}

// M on the joints: N on the angles by (q1, q2, q2 + q3).
template <class P, class T>
ARM3R_INLINE Mat3<T> mass_matrix(const Arm<P>& arm, const Pose<T>& p) {
    const AngleInertia<T> N = angle_inertia(arm, p, first_moments(arm, p));
    const T M12 = N.N12 + N.N13, M23 = N.N23 + N.N33;
    return from_rows<T>({N.N11, M12, N.N13}, {M12, N.N22 + (N.N23 + M23), M23}, {N.N13, M23, N.N33});
}

// The derivatives of the mass matrix with respect to the angles, as far as the velocity terms need them (10.7):
// half of those of N11, that of N23 by q2 + q3, those of N12 and N13 by their own angle, and that of the skew rotors.
template <class T>
struct VelocityTerms {
    T h2, h3, k, m12, m13, x;
};

template <class P, class T>
ARM3R_INLINE VelocityTerms<T> velocity_terms(const Arm<P>& arm, const Pose<T>& p, const FirstMoments<T>& g) {
    const Elbow<P>& e = arm.elbow;
    const P& a1 = e.shoulder_offset;
    const SharedProducts<T> s(arm, p, g);
    const T once = s.D2S2 + s.aX3, C2aZ3 = p.C2 * s.aZ3;
    VelocityTerms<T> v;
    v.h2 = p.C2 * (e.D2 * p.C2) - p.S2 * (s.A2C2 + once) - a1 * g.Z2;
    v.h3 = p.C23 * (e.D3 * p.C23) - p.S23 * (s.A3C3 + s.D3S3) - (a1 * g.Z3 + C2aZ3);
    v.k = p.S2 * s.aX3 - C2aZ3;
    v.m12 = e.E2 * p.C2 - e.F2 * p.S2;
    v.m13 = e.E3 * p.C23 - e.F3 * p.S23;
    v.x = e.has_skew_rotors ? T(e.E23 * p.C2 - e.F23 * p.S2) : T(0.0);
    return v;
}

// C w on the angles (10.7); w: their rates.
template <class P, class T>
ARM3R_INLINE Vec3<T> angle_velocity_product(const Elbow<P>& elbow, const VelocityTerms<T>& v, const Vec3<T>& w) {
    const T w1_2 = w[0] * w[0], w2_2 = w[1] * w[1], w3_2 = w[2] * w[2];
    Vec3<T> product(2.0 * ((v.h2 * w[1] + v.h3 * w[2]) * w[0]) + (v.m12 * w2_2 + v.m13 * w3_2),
                    v.k * w3_2 - v.h2 * w1_2, -(v.h3 * w1_2 + v.k * w2_2));
    if (!elbow.has_skew_rotors) return product;
    product[0] = product[0] + v.x * (w[1] * (w[2] - w[1]));
    product[1] = product[1] - v.x * (w[0] * w[2]);
    product[2] = product[2] + v.x * (w[0] * w[1]);
    return product;
}

// C on the joints, the Christoffel choice (10.8).
template <class P, class T>
ARM3R_INLINE Mat3<T> coriolis_matrix(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
    const VelocityTerms<T> v = velocity_terms(arm, p, first_moments(arm, p));
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2], half = 0.5 * v.x;
    // on the angles, with dN12/dq2 = m12 - x, dN13/dq2 = x, dN13/d(q2 + q3) = m13
    const T m12 = v.m12 - v.x;
    const T c11 = v.h2 * w2 + v.h3 * w3;
    const T c12 = v.h2 * w1 + m12 * w2 + half * w3, c13 = v.h3 * w1 + half * w2 + v.m13 * w3;
    const T c21 = -(v.h2 * w1) - half * w3, c22 = T(0.0), c23 = v.k * w3 - half * w1;
    const T c31 = half * w2 - v.h3 * w1, c32 = half * w1 - v.k * w2, c33 = T(0.0);
    return from_rows<T>({c11, c12 + c13, c13},                              //
                        {c21 + c31, (c22 + c23) + (c32 + c33), c23 + c33},  //
                        {c31, c32 + c33, c33});
}

template <class T>
ARM3R_INLINE Vec3<T> on_joints(const Vec3<T>& on_angles) {
    return {on_angles[0], on_angles[1] + on_angles[2], on_angles[2]};
}

// J^T f
template <class P, class T>
ARM3R_INLINE Vec3<T> tip_force_torque(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& f_on_tip) {
    return on_joints(angle_torques(arm, reaches(arm, p), components(arm, p, f_on_tip)));
}

template <class P, class T>
ARM3R_INLINE Vec3<T> velocity_product(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
    const Vec3<T> w(qd[0], qd[1], qd[1] + qd[2]);
    return on_joints(angle_velocity_product(arm.elbow, velocity_terms(arm, p, first_moments(arm, p)), w));
}

// Along u, v and k, m/s^2.
template <class P, class T>
ARM3R_INLINE Vec3<T> gravity_components(const Arm<P>& arm, const Pose<T>& p) {
    const Vec3<P>& g = arm.elbow.gravity;
    if (arm.gravity_is_vertical) return {T(0.0), T(0.0), T(g[2])};
    return {g[0] * p.C1 + g[1] * p.S1, g[1] * p.C1 - g[0] * p.S1, T(g[2])};
}

// The weight of the links on the three angles (10.9).
template <class P, class T>
ARM3R_INLINE Vec3<T> weight(const Arm<P>& arm, const Pose<T>& p, const FirstMoments<T>& m) {
    const Elbow<P>& e = arm.elbow;
    if (arm.gravity_is_vertical) return {T(0.0), -(m.X2 * e.gravity[2]), -(m.X3 * e.gravity[2])};
    const Vec3<T> g = gravity_components(arm, p);
    return {e.Hv * g[0] - (e.Hu + (m.X2 + m.X3)) * g[1], m.Z2 * g[0] - m.X2 * g[2], m.Z3 * g[0] - m.X3 * g[2]};
}

template <class P, class T>
ARM3R_INLINE Vec3<T> link_weight(const Arm<P>& arm, const Pose<T>& p) {
    return weight(arm, p, first_moments(arm, p));
}

template <class P, class T>
ARM3R_INLINE T kinetic_energy(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& qd) {
    const T w1 = qd[0], w2 = qd[1], w3 = qd[1] + qd[2];
    const AngleInertia<T> N = angle_inertia(arm, p, first_moments(arm, p));
    return 0.5 * (N.N11 * (w1 * w1) + N.N22 * (w2 * w2) + N.N33 * (w3 * w3)) +
           ((N.N12 * w2 + N.N13 * w3) * w1 + N.N23 * (w2 * w3));
}

// The energy of gravity beside its fixed part (10.10).
template <class P, class T>
ARM3R_INLINE T potential_energy_of_pose(const Arm<P>& arm, const Pose<T>& p) {
    const FirstMoments<T> m = first_moments(arm, p);
    const Elbow<P>& e = arm.elbow;
    if (arm.gravity_is_vertical) return -(e.gravity[2] * (m.Z2 + m.Z3));
    const Vec3<T> g = gravity_components(arm, p);
    return -((e.Hu + (m.X2 + m.X3)) * g[0] + e.Hv * g[1] + (m.Z2 + m.Z3) * g[2]);
}

// J: no change of it, from any pose to any other, is more than twice this.
template <class P>
ARM3R_INLINE P weight_times_reach(const Arm<P>& arm) {
    const Vec3<P>& g = arm.gravity;
    const Elbow<P>& e = arm.elbow;
    return sqrt(P(dot(g, g))) *
           (abs(arm.lumped.G2) + abs(e.Gy2) + abs(arm.lumped.G3) + abs(e.Gy3) + abs(e.Hu) + abs(e.Hv));
}

// The accelerations of the angles by the torques on them, velocity terms included: a Schur complement on q1 (10.11), times
// the determinant of the link angles, so that the two divisions do not wait for each other.
template <class T>
ARM3R_INLINE Vec3<T> solved(const AngleInertia<T>& N, const Vec3<T>& torque) {
    const T det = N.N22 * N.N33 - N.N23 * N.N23, inverse_det = 1.0 / det;
    const T z2 = N.N33 * N.N12 - N.N23 * N.N13, z3 = N.N22 * N.N13 - N.N23 * N.N12;
    const T y2 = N.N33 * torque[1] - N.N23 * torque[2], y3 = N.N22 * torque[2] - N.N23 * torque[1];
    const T first = (det * torque[0] - (z2 * torque[1] + z3 * torque[2])) / (det * N.N11 - (N.N12 * z2 + N.N13 * z3));
    return {first, (y2 - z2 * first) * inverse_det, (y3 - z3 * first) * inverse_det};
}

// qdd from the torques on the three angles.
template <class P, class T>
ARM3R_INLINE Vec3<T> acceleration_by_angle_torques(const Arm<P>& arm, const Pose<T>& p, const FirstMoments<T>& m,
                                                   const Vec3<T>& qd, const Vec3<T>& torque) {
    const Vec3<T> w(qd[0], qd[1], qd[1] + qd[2]);
    const Vec3<T> rest = minus(torque, angle_velocity_product(arm.elbow, velocity_terms(arm, p, m), w));
    const Vec3<T> a = solved(angle_inertia(arm, p, m), rest);
    return {a[0], a[1], a[2] - a[1]};
}

// M^-1 times torques on the joints.
template <class P, class T>
ARM3R_INLINE Vec3<T> by_inverse_mass(const Arm<P>& arm, const Pose<T>& p, const Vec3<T>& tau) {
    const AngleInertia<T> N = angle_inertia(arm, p, first_moments(arm, p));
    const Vec3<T> a = solved(N, Vec3<T>(tau[0], tau[1] - tau[2], tau[2]));
    return {a[0], a[1], a[2] - a[1]};
}

// J M^-1 J^T
template <class P, class T>
ARM3R_INLINE Mat3<T> tip_mobility(const Arm<P>& arm, const Pose<T>& p, const Mat3<T>& J) {
    Mat3<T> W;
    for (int i = 0; i < 3; ++i) {
        const Vec3<T> column = by_inverse_mass(arm, p, Vec3<T>(J(i, 0), J(i, 1), J(i, 2)));
        for (int j = i; j < 3; ++j) {
            W(i, j) = J(j, 0) * column[0] + J(j, 1) * column[1] + J(j, 2) * column[2];
            W(j, i) = W(i, j);
        }
    }
    return W;
}

// K^T M K
template <class T>
ARM3R_INLINE Mat3<T> transformed(const Mat3<T>& M, const Mat3<T>& K) {
    Mat3<T> L;
    for (int j = 0; j < 3; ++j) {
        const Vec3<T> column = times(M, Vec3<T>(K(0, j), K(1, j), K(2, j)));
        for (int i = 0; i <= j; ++i) {
            L(i, j) = K(0, i) * column[0] + K(1, i) * column[1] + K(2, i) * column[2];
            L(j, i) = L(i, j);
        }
    }
    return L;
}

// The pivots of the mass matrix: the determinant of the link angles over the product of their diagonal, and the inertia of
// q1 while they are free, kg m^2, beside its diagonal. Both vanish where M is singular.
template <class T>
struct Pivots {
    T lower, first, diagonal;
};

template <class P, class T>
ARM3R_INLINE Pivots<T> pivots(const Arm<P>& arm, const Pose<T>& p) {
    const AngleInertia<T> N = angle_inertia(arm, p, first_moments(arm, p));
    const T determinant = N.N22 * N.N33 - N.N23 * N.N23;
    const T z2 = N.N33 * N.N12 - N.N23 * N.N13, z3 = N.N22 * N.N13 - N.N23 * N.N12;
    return {determinant / (N.N22 * N.N33), N.N11 - (N.N12 * z2 + N.N13 * z3) / determinant, N.N11};
}

}  // namespace arm3r::elbow_arm
