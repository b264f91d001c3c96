#pragma once
// An elbow arm: a second and a third axis that are parallel to each other and across the first, wherever they, the masses
// and the tip are; docs/model.md, section 10. Slide convention: u, v, k are radial, across and along axis 1, and joints 2
// and 3 turn about -v.

#include <array>

#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

// A rigid body in its link's frame: x along u where the joint is at zero, z along the axis of its joint.
template <class P>
struct RigidBody {
    P mass;            // kg
    Vec3<P> com;       // m
    Vec3<P> inertia;   // kg m^2, xx, yy, zz of the tensor about the centre of mass
    Vec3<P> products;  // kg m^2, xy, xz, yz of it
};

// The rotor of a motor, which the link before its joint carries. It turns `ratio` times as fast as the joint.
template <class P>
struct Rotor {
    P inertia;     // kg m^2, about its axis
    P ratio;       // negative where it turns the other way
    P mass;        // kg, at the joint's origin
    Vec3<P> axis;  // a unit vector in the frame of the link that carries it
};

struct ElbowChoices {
    bool base_is_turned = false, has_skew_rotors = false;

    bool operator==(const ElbowChoices&) const = default;
};

template <class P>
struct Elbow : ElbowChoices {
    Vec3<P> position;   // m, scenario axes: the point of axis 1 at the height of joint 2
    Mat3<P> rotation;   // from base axes to those of the scenario
    P shoulder_offset;  // m, a1: of joint 2, along u
    P offset;           // m, of the origin of link 3, along the axis of joint 2
    Vec3<P> tip;        // m, in the frame of link 3
    std::array<RigidBody<P>, 3> links;
    std::array<Rotor<P>, 3> rotors;

    // Of all this, what determines the motion beside Lumped (10.6).
    P lateral;                 // m, e: of the tip, along v
    P D2, D3, E2, F2, E3, F3;  // kg m^2: products of inertia
    P Gy2, Gy3;                // kg m: first moments across links 2 and 3
    P Hu, Hv;                  // kg m: first moments along u and v that no angle but q1 moves
    P K12, E23, F23;           // kg m^2: of rotors that spin across their joints
    Vec3<P> gravity;           // m/s^2, base axes
    P fixed_energy;            // J: of gravity, where u, v and the links are level

    bool is_far_from_singular = false;  // in no pose is the mass matrix nearly singular
};

// The sum of a body and a point mass.
template <class P>
RigidBody<P> with_point_mass(const RigidBody<P>& body, const P& mass, const Vec3<P>& at) {
    const P total = body.mass + mass, share = total > P(0.0) ? P(mass / total) : P(0.0);
    const Vec3<P> d = minus(at, body.com), com = plus(body.com, scaled(share, d));
    const P reduced = body.mass * share;
    const auto square = [&](int i) { return d[i] * d[i]; };
    return {total,
            com,
            {body.inertia[0] + reduced * (square(1) + square(2)), body.inertia[1] + reduced * (square(0) + square(2)),
             body.inertia[2] + reduced * (square(0) + square(1))},
            {body.products[0] - reduced * (d[0] * d[1]), body.products[1] - reduced * (d[0] * d[2]),
             body.products[2] - reduced * (d[1] * d[2])}};
}

// First moments, kg m, and the tensor, kg m^2, about the origin of the frame moved by `offset` along z.
template <class P>
struct Moments {
    P mass, x, y, z, xx, yy, zz, xy, xz, yz;

    Moments(const RigidBody<P>& body, const P& offset) : mass(body.mass) {
        const P cx = body.com[0], cy = body.com[1], cz = body.com[2] + offset;
        x = mass * cx, y = mass * cy, z = mass * cz;
        xx = body.inertia[0] + (y * cy + z * cz);
        yy = body.inertia[1] + (x * cx + z * cz);
        zz = body.inertia[2] + (x * cx + y * cy);
        xy = body.products[0] - x * cy;
        xz = body.products[1] - x * cz;
        yz = body.products[2] - y * cz;
    }
};

}  // namespace arm3r
