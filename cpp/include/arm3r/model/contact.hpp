#pragma once
// What the wall does to a point that presses on it; docs/model.md, section 4. It sees an indentation, never the arm.

#include "arm3r/model/wall.hpp"

namespace arm3r {

enum class Law { spring, diagonal, kelvin_voigt, hunt_crossley };

template <class P>
struct Contact {
    Law law = Law::spring;
    Vec3<P> stiffness;        // N/m along n, e1, e2; only diagonal uses all; N/m^p for hunt_crossley
    P damping;                // N s/m, of kelvin_voigt
    P exponent, dissipation;  // 1 and s/m, of hunt_crossley
    bool has_friction = false;
    P friction, slip_velocity;  // 1 and m/s
};

// Whether it pushes less on the way out than on the way in, so that it may have to let go of a wall still dented.
inline bool is_damped(Law law) { return law == Law::kelvin_voigt || law == Law::hunt_crossley; }

// The law along the normal, smoothly continued to where it would pull and to depths below zero (4.5).
template <class T>
struct Push {
    T elastic, total;  // N: of the spring alone, and with damping
    T stored;          // J
    T release;         // below zero where the law would pull, in units of its own
};

template <class P, class T>
ARM3R_INLINE Push<T> push(const Contact<P>& contact, const Indentation<T>& in) {
    if (contact.law == Law::hunt_crossley) {
        const T spring = contact.stiffness[0] * copysign(power(abs(in.depth), T(contact.exponent)), in.depth);
        const T factor = 1.0 + contact.dissipation * in.rate;
        return {spring, spring * factor, spring * in.depth / (contact.exponent + 1.0), factor};
    }
    const T spring = contact.stiffness[0] * in.depth;
    const T stored = 0.5 * spring * in.depth;
    if (contact.law != Law::kelvin_voigt) return {spring, spring, stored, spring};
    const T total = spring + contact.damping * in.rate;
    return {spring, total, stored, total};
}

// N, of the same while the tip is inside: never pulling.
template <class P, class T>
ARM3R_INLINE T normal_force(const Contact<P>& contact, const Indentation<T>& in) {
    return max_where(in.depth > T(0.0), T(0.0), push(contact, in).total);
}

// J, of the springs along the plate, which hold the tip to its centre (4.7).
template <class P, class T>
ARM3R_INLINE T stored_sideways(const Contact<P>& contact, const Indentation<T>& in) {
    if (contact.law != Law::diagonal) return T(0.0);
    return 0.5 * (contact.stiffness[1] * in.across1 * in.across1 + contact.stiffness[2] * in.across2 * in.across2);
}

template <class T>
struct ContactForce {
    Vec3<T> on_tip;   // N, base axes; the wall feels the opposite
    T normal;         // N, along n, >= 0 when pressing
    T stored;         // J, elastic energy of the indentation
    T dissipated;     // W, turned into heat
    T friction_loss;  // W, the part of it that friction along the plate turns into heat
};

enum class Grip {
    smooth,    // the law as it stands, whatever its sign: who calls knows when it ends
    clipped,   // no force where it would pull
    released,  // no force, on a surface that is still dented (4.8)
};

template <class T, class V>
ARM3R_INLINE ContactForce<T> along_normal(const V& n, const T& normal, const T& stored, const T& dissipated) {
    return {{normal * n[0], normal * n[1], normal * n[2]}, normal, stored, dissipated, T(0.0)};
}

// A spring along a normal that stands still asks for the depth alone.
template <class P>
bool is_plain(const Wall<P>& wall, const Contact<P>& contact) {
    return contact.law == Law::spring && !contact.has_friction && wall.rotation == Rotation::none;
}

// The force of the law at an indentation (4.5) to (4.7).
template <class P, class T>
ARM3R_INLINE ContactForce<T> contact_force(const Wall<P>& wall, const WallState<T>& state, const Contact<P>& contact,
                                           const Indentation<T>& in, Grip grip) {
    const Push<T> along = push(contact, in);
    if (is_plain(wall, contact)) return along_normal(wall.n, along.total, along.stored, T(0.0));
    const Axes<T> axis = axes(wall, state);
    T normal = along.total, dissipated(0.0);
    if (is_damped(contact.law)) {
        if (grip == Grip::clipped) normal = max(normal, T(0.0));
        if (grip == Grip::released) normal = T(0.0);
        dissipated = (normal - along.elastic) * in.rate;
    }
    ContactForce<T> force = along_normal(axis.n, normal, along.stored, dissipated);
    const auto sideways = [&](const T& f1, const T& f2) ARM3R_INLINE_LAMBDA {
        for (int i = 0; i < 3; ++i) force.on_tip[i] = force.on_tip[i] + f1 * axis.e1[i] + f2 * axis.e2[i];
    };
    if (contact.law == Law::diagonal) {
        sideways(-contact.stiffness[1] * in.across1, -contact.stiffness[2] * in.across2);
        force.stored = force.stored + stored_sideways(contact, in);
    }
    if (contact.has_friction) {
        const T slip_2 = in.slip1 * in.slip1 + in.slip2 * in.slip2;
        const T drag = contact.friction * normal / sqrt(T(slip_2 + contact.slip_velocity * contact.slip_velocity));
        sideways(-drag * in.slip1, -drag * in.slip2);
        force.friction_loss = drag * slip_2;
        force.dissipated = force.dissipated + force.friction_loss;
    }
    return force;
}

template <class T>
ARM3R_INLINE ContactForce<T> no_contact() {
    return {{T(0.0), T(0.0), T(0.0)}, T(0.0), T(0.0), T(0.0), T(0.0)};
}

// The same where `touching`, nothing elsewhere.
template <class M, class T>
ARM3R_INLINE ContactForce<T> only_where(const M& touching, const ContactForce<T>& force) {
    const T o(0.0);
    return {{select(touching, force.on_tip[0], o), select(touching, force.on_tip[1], o),
             select(touching, force.on_tip[2], o)},
            select(touching, force.normal, o),
            select(touching, force.stored, o),
            select(touching, force.dissipated, o),
            select(touching, force.friction_loss, o)};
}

}  // namespace arm3r
