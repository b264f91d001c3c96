#pragma once
// What the wall does to a point that presses on it; docs/model.md, section 4. It sees an indentation, never the arm.

#include "arm3r/wall.hpp"

namespace arm3r {

enum class Law { spring, diagonal };

template <class P>
struct Contact {
    Law law;
    Vec3<P> stiffness;  // N/m along n, e1, e2; a spring uses the first
};

template <class T>
struct ContactForce {
    Vec3<T> on_tip;  // N, base axes; the wall feels the opposite
    T normal;        // N, along n, >= 0 when pressing
    T stored;        // J, elastic energy of the indentation
    T dissipated;    // W, turned into heat: damping and friction laws fill it, springs do not
};

// The force of the law at an indentation, whatever its sign: who calls knows whether there is contact (4.5), (4.6).
template <class P, class T>
ARM3R_INLINE ContactForce<T> contact_force(const Wall<P>& wall, const Contact<P>& contact, const Indentation<T>& in) {
    const T normal = contact.stiffness[0] * in.depth;
    ContactForce<T> force{
        {normal * wall.n[0], normal * wall.n[1], normal * wall.n[2]}, normal, 0.5 * normal * in.depth, T(0.0)};
    if (contact.law == Law::diagonal) {
        const T f1 = -contact.stiffness[1] * in.across1;
        const T f2 = -contact.stiffness[2] * in.across2;
        for (int i = 0; i < 3; ++i) force.on_tip[i] = force.on_tip[i] + f1 * wall.e1[i] + f2 * wall.e2[i];
    }
    return force;
}

template <class T>
ARM3R_INLINE ContactForce<T> no_contact() {
    return {{T(0.0), T(0.0), T(0.0)}, T(0.0), T(0.0), T(0.0)};
}

// The same where `touching`, nothing elsewhere.
template <class M, class T>
ARM3R_INLINE ContactForce<T> only_where(const M& touching, const ContactForce<T>& force) {
    const T o(0.0);
    return {{select(touching, force.on_tip[0], o), select(touching, force.on_tip[1], o),
             select(touching, force.on_tip[2], o)},
            select(touching, force.normal, o),
            select(touching, force.stored, o),
            select(touching, force.dissipated, o)};
}

}  // namespace arm3r
