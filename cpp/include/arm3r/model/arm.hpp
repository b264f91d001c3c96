#pragma once
// The constants of the arm: the data that its maker states, and the nine lumped numbers that determine its dynamics.
// All code of the library uses the slide convention (positive q2, q3 raise the arm); D converts where data enter and
// leave (1.1). P is the number type of the parameters, T that of the state: double, Pack<N>, Dual<N> or Expr.

#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

// A link on joint 2 or 3. Axes: x along the link, y in the arm's vertical plane, z along the joint axis.
template <class P>
struct Link {
    P length;         // m, from joint to joint, or from joint to tip
    P mass;           // kg
    P com;            // m from the joint, along x
    Vec3<P> inertia;  // kg m^2, principal, about the centre of mass
};

// Link 1 turns about the vertical axis: only its inertia about that axis affects the motion.
template <class P>
struct BaseLink {
    P mass;           // kg
    P com;            // m, height of the centre of mass in the base frame
    P inertia_axial;  // kg m^2
};

template <class P>
struct Lumped {  // (3.2)
    P A1, A2, A3, B, B2, B3, J3, G2, G3;
};

template <class P>
struct Arm {
    P base_height;  // m, d1
    BaseLink<P> link1;
    Link<P> link2, link3;
    P payload;             // kg, a point mass at the tip
    Vec3<P> gravity;       // m/s^2, base axes
    Vec3<P> armature;      // kg m^2
    Vec3<P> damping;       // N m s/rad
    Vec3<P> friction;      // N m
    P friction_velocity;   // rad/s
    Vec3<P> torque_limit;  // N m
    Lumped<P> lumped;

    // A flag is false if no lane of P has the term, which is then not computed. Leaving out a term of exact zeros
    // changes no value.
    bool gravity_is_vertical = false, has_damping = false, has_dry_friction = false, has_torque_limit = false;
};

// m: the largest distance of the tip from the shoulder.
template <class P>
ARM3R_INLINE P reach(const Arm<P>& arm) {
    return arm.link2.length + arm.link3.length;
}

template <class P>
Lumped<P> lump(const Arm<P>& arm) {  // (3.2)
    const Link<P>&l2 = arm.link2, &l3 = arm.link3;
    const P a2 = l2.length, a3 = l3.length;
    const P beyond_elbow = l3.mass + arm.payload;
    const P about_elbow = l3.mass * l3.com + arm.payload * a3;
    const P second2 = l2.mass * l2.com * l2.com + beyond_elbow * a2 * a2;
    const P second3 = l3.mass * l3.com * l3.com + arm.payload * a3 * a3;
    return {
        .A1 = arm.link1.inertia_axial + arm.armature[0] + l2.inertia[0] + l3.inertia[0],
        .A2 = l2.inertia[1] - l2.inertia[0] + second2,
        .A3 = l3.inertia[1] - l3.inertia[0] + second3,
        .B = a2 * about_elbow,
        .B2 = l2.inertia[2] + second2 + arm.armature[1],
        .B3 = l3.inertia[2] + second3,
        .J3 = arm.armature[2],
        .G2 = l2.mass * l2.com + beyond_elbow * a2,
        .G3 = about_elbow,
    };
}

// D = diag(1, -1, -1) converts q, qd, qdd and torques between the slide and the simscape convention, both ways (1.1).
template <class T>
ARM3R_INLINE Vec3<T> change_convention(const Vec3<T>& joint_vector) {
    return {joint_vector[0], -joint_vector[1], -joint_vector[2]};
}

}  // namespace arm3r
