#pragma once
// The constants of the arm: the data that its maker states, and the nine lumped numbers that determine its dynamics.
// All code of the library uses the slide convention (positive q2, q3 raise the arm); D converts where data enter and
// leave (1.1). P is the number type of the parameters, T that of the state: double, Pack<N>, Dual<N> or Expr.

#include "arm3r/model/elbow.hpp"

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

// A flag is false if no lane has the term, which is then not computed. Leaving out a term of exact zeros changes no value.
struct ArmChoices {
    bool gravity_is_vertical = false, has_damping = false, has_dry_friction = false, has_torque_limit = false;
    bool is_elbow = false;  // else planar: the links lie in one plane with axis 1, and begin on it

    bool operator==(const ArmChoices&) const = default;
};

template <class P>
struct Arm : ArmChoices {
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
    Elbow<P> elbow;  // where is_elbow; length and mass of the links, base_height and lumped hold its numbers, too
};

// m: no tip is farther from the point of axis 1 at the height of joint 2.
template <class P>
ARM3R_INLINE P reach(const Arm<P>& arm) {
    const P length = arm.link2.length + arm.link3.length;
    return arm.is_elbow ? P(length + abs(arm.elbow.shoulder_offset) + abs(arm.elbow.lateral)) : length;
}

// m, scenario axes: the point of axis 1 at the height of joint 2.
template <class P>
ARM3R_INLINE Vec3<P> base_position(const Arm<P>& arm) {
    return arm.is_elbow ? arm.elbow.position : Vec3<P>(P(0.0), P(0.0), arm.base_height);
}

template <class P>
Lumped<P> lump_planar(const Arm<P>& arm) {  // (3.2)
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

// The base parameters of an elbow arm (10.6). The rotors' own inertia and mass count with the links that carry them.
template <class P>
void lump_elbow(Arm<P>& arm) {
    Elbow<P>& elbow = arm.elbow;
    const auto [rotor1, rotor2, rotor3] = elbow.rotors;
    const P o(0.0), a1 = elbow.shoulder_offset, a2 = arm.link2.length;
    const Moments<P> one(with_point_mass(elbow.links[0], rotor2.mass, Vec3<P>(a1, o, o)), o);
    const Moments<P> two(with_point_mass(elbow.links[1], rotor3.mass, Vec3<P>(a2, o, elbow.offset)), o);
    const Moments<P> three(with_point_mass(elbow.links[2], arm.payload, elbow.tip), elbow.offset);
    const P beyond_shoulder = two.mass + three.mass;

    const P geared2 = rotor2.ratio * rotor2.inertia, geared3 = rotor3.ratio * rotor3.inertia;
    const Vec3<P>&w2 = rotor2.axis, &w3 = rotor3.axis;
    const Vec3<P> spun = scaled(rotor3.inertia, w3);  // the rotor of joint 3 as a part of link 2: the tensor I w w^T
    const P XX2 = two.xx + spun[0] * w3[0], YY2 = two.yy + spun[1] * w3[1];
    const P turned = geared3 * w3[2];

    elbow.lateral = -(elbow.offset + elbow.tip[2]);
    arm.lumped.A1 = one.zz + rotor2.inertia * w2[2] * w2[2] + arm.armature[0] +
                    rotor1.ratio * rotor1.ratio * rotor1.inertia + a1 * a1 * beyond_shoulder + XX2 + three.xx;
    arm.lumped.A2 = YY2 - XX2 + three.mass * a2 * a2;
    arm.lumped.A3 = three.yy - three.xx;
    arm.lumped.G2 = two.x + three.mass * a2;
    arm.lumped.G3 = three.x;
    arm.lumped.B = a2 * three.x;
    arm.lumped.B2 = two.zz + spun[2] * w3[2] + three.mass * a2 * a2 + arm.armature[1] + rotor2.ratio * geared2 - turned;
    arm.lumped.B3 = three.zz + turned;
    arm.lumped.J3 = arm.armature[2] + rotor3.ratio * geared3 - turned;
    elbow.D2 = two.xy + spun[0] * w3[1];
    elbow.D3 = three.xy;
    elbow.E2 = two.xz + spun[0] * w3[2] - a2 * three.z;
    elbow.F2 = two.yz + spun[1] * w3[2];
    elbow.E3 = three.xz;
    elbow.F3 = three.yz;
    elbow.Gy2 = two.y;
    elbow.Gy3 = three.y;
    elbow.Hu = one.x + a1 * beyond_shoulder;
    elbow.Hv = one.y - two.z - three.z;
    elbow.K12 = geared2 * w2[2];
    elbow.E23 = geared3 * w3[0];
    elbow.F23 = geared3 * w3[1];
    elbow.gravity = transposed_times(elbow.rotation, arm.gravity);
    elbow.fixed_energy =
        -((one.mass + beyond_shoulder + rotor1.mass) * dot(arm.gravity, elbow.position) + one.z * elbow.gravity[2]);
}

// How a user counts the angles of the joints: theta = sign q + zero, where theta is that of slide (1.1).
struct JointConvention {
    Vec3<double> sign{1, 1, 1}, zero{0, 0, 0};

    // Rates and torques, which have no zero; both ways.
    template <class T>
    ARM3R_INLINE Vec3<T> flipped(const Vec3<T>& v) const {
        return {v[0] * sign[0], v[1] * sign[1], v[2] * sign[2]};
    }
    template <class T>
    ARM3R_INLINE Vec3<T> to_slide(const Vec3<T>& q) const {
        return {q[0] * sign[0] + zero[0], q[1] * sign[1] + zero[1], q[2] * sign[2] + zero[2]};
    }
    template <class T>
    ARM3R_INLINE Vec3<T> from_slide(const Vec3<T>& theta) const {
        return {(theta[0] - zero[0]) * sign[0], (theta[1] - zero[1]) * sign[1], (theta[2] - zero[2]) * sign[2]};
    }
};

}  // namespace arm3r
