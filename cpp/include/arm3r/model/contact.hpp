#pragma once
// The force of the wall on a point that presses on it; docs/model.md, section 4. The contact law depends on an
// indentation, not on the arm.

#include <array>

#include "arm3r/model/wall.hpp"

namespace arm3r {

enum class ContactLaw { spring, diagonal, kelvin_voigt, hunt_crossley };

// What a contact law is, for all that does not compute its force.
struct ContactLawTraits {
    ContactLaw law;
    const char* word;
    bool is_linear;  // the normal force, in the depth and its rate; of any other law `exponent` says how it grows
    // It pushes less while it is unloaded than while it is loaded, so that the force may end before the depth is zero. A law
    // that is not linear counts as damped: its contact is followed by its force, and not by its depth.
    bool is_damped;
    bool acts_along_plate;  // it has springs along the plate, too
};

inline constexpr std::array contact_law_table = std::to_array<ContactLawTraits>({
    {ContactLaw::spring, "spring", true, false, false},
    {ContactLaw::diagonal, "diagonal", true, false, true},
    {ContactLaw::kelvin_voigt, "kelvin_voigt", true, true, false},
    {ContactLaw::hunt_crossley, "hunt_crossley", false, true, false},
});

// The laws with a property, a bit each: a look into the table would stop the inner loops.
constexpr unsigned laws_that(bool ContactLawTraits::* property) {
    unsigned laws = 0;
    for (const ContactLawTraits& one : contact_law_table)
        if (one.*property) laws |= 1u << static_cast<unsigned>(one.law);
    return laws;
}
inline constexpr unsigned linear_laws = laws_that(&ContactLawTraits::is_linear),
                          damped_laws = laws_that(&ContactLawTraits::is_damped),
                          laws_along_plate = laws_that(&ContactLawTraits::acts_along_plate),
                          spring_laws = linear_laws & ~damped_laws & ~laws_along_plate;

constexpr bool is_among(unsigned laws, ContactLaw law) { return (laws >> static_cast<unsigned>(law) & 1u) != 0; }
constexpr bool is_linear(ContactLaw law) { return is_among(linear_laws, law); }
constexpr bool is_damped(ContactLaw law) { return is_among(damped_laws, law); }
constexpr bool acts_along_plate(ContactLaw law) { return is_among(laws_along_plate, law); }
// Whether it is a spring along the normal, and nothing else.
constexpr bool is_spring(ContactLaw law) { return is_among(spring_laws, law); }

struct ContactChoices {
    ContactLaw law = ContactLaw::spring;
    bool has_friction = false;

    bool operator==(const ContactChoices&) const = default;
};

template <class P>
struct Contact : ContactChoices {
    Vec3<P> stiffness;          // N/m along n, e1, e2; only diagonal uses all; N/m^p for hunt_crossley
    P damping;                  // N s/m, of kelvin_voigt; 0 of other laws
    P exponent, dissipation;    // 1 and s/m, of hunt_crossley; 0 of other laws
    P friction, slip_velocity;  // 1 and m/s
};

// The contact law along the normal, smoothly continued to where it would pull and to depths below zero (4.5).
template <class T>
struct NormalForce {
    T elastic, total;  // N: of the spring alone, and with damping
    T stored;          // J
    T release;         // negative where the law would pull; its unit depends on the law
};

template <class P, class T>
ARM3R_INLINE NormalForce<T> spring_law(const Contact<P>& contact, const T& depth) {
    const T spring = contact.stiffness[0] * depth;
    return {spring, spring, 0.5 * spring * depth, spring};
}

template <class P, class T>
ARM3R_INLINE NormalForce<T> normal_force_law(const Contact<P>& contact, const Indentation<T>& in) {
    if (contact.law == ContactLaw::hunt_crossley) {
        const T spring = contact.stiffness[0] * copysign(power(abs(in.depth), T(contact.exponent)), in.depth);
        const T factor = 1.0 + contact.dissipation * in.rate;
        return {spring, spring * factor, spring * in.depth / (contact.exponent + 1.0), factor};
    }
    NormalForce<T> law = spring_law(contact, in.depth);
    if (contact.law == ContactLaw::kelvin_voigt) law.total = law.release = law.elastic + contact.damping * in.rate;
    return law;
}

// N: the normal force while the tip is inside; it never pulls.
template <class P, class T>
ARM3R_INLINE T normal_force(const Contact<P>& contact, const Indentation<T>& in) {
    return max_where(in.depth > T(0.0), T(0.0), normal_force_law(contact, in).total);
}

// J: the energy of the springs along the plate, which hold the tip to the centre of the plate (4.7).
template <class P, class T>
ARM3R_INLINE T stored_tangential(const Contact<P>& contact, const Indentation<T>& in) {
    if (!acts_along_plate(contact.law)) return T(0.0);
    return 0.5 * (contact.stiffness[1] * in.across1 * in.across1 + contact.stiffness[2] * in.across2 * in.across2);
}

template <class T>
struct ContactForce {
    Vec3<T> on_tip;   // N, base axes; the force on the wall is the opposite
    T normal;         // N, along n, >= 0 when pressing
    T stored;         // J, elastic energy of the indentation
    T dissipated;     // W, turned into heat
    T friction_loss;  // W, the part of it that friction along the plate turns into heat
};

enum class Clamping {
    smooth,    // the force of the law, whatever its sign: the caller knows when contact ends
    clamped,   // no force where the law would pull
    released,  // no force although the depth is positive (4.8)
};

template <class T, class V>
ARM3R_INLINE ContactForce<T> along_normal(const V& n, const T& normal, const T& stored, const T& dissipated) {
    return {{normal * n[0], normal * n[1], normal * n[2]}, normal, stored, dissipated, T(0.0)};
}

// A plain spring along a normal that does not turn needs the depth only.
template <class P>
bool is_plain_spring(const Wall<P>& wall, const Contact<P>& contact) {
    return is_spring(contact.law) && !contact.has_friction && wall.rotation == Rotation::none;
}

template <class P, class T>
ARM3R_INLINE ContactForce<T> plain_spring_force(const Wall<P>& wall, const Contact<P>& contact, const T& depth) {
    const NormalForce<T> law = spring_law(contact, depth);
    return along_normal(wall.n, law.elastic, law.stored, T(0.0));
}

// The force of the contact law at an indentation (4.5) to (4.7).
template <class P, class T>
ARM3R_INLINE ContactForce<T> contact_force(const Wall<P>& wall, const WallState<T>& state, const Contact<P>& contact,
                                           const Indentation<T>& in, Clamping clamping) {
    if (is_plain_spring(wall, contact)) return plain_spring_force(wall, contact, in.depth);
    const NormalForce<T> along = normal_force_law(contact, in);
    const Axes<T> axis = axes(wall, state);
    T normal = along.total, dissipated(0.0);
    if (is_damped(contact.law)) {
        if (clamping == Clamping::clamped) normal = max(normal, T(0.0));
        if (clamping == Clamping::released) normal = T(0.0);
        dissipated = (normal - along.elastic) * in.rate;
    }
    ContactForce<T> force = along_normal(axis.n, normal, along.stored, dissipated);
    const auto tangential = [&](const T& f1, const T& f2) ARM3R_INLINE_LAMBDA {
        for (int i = 0; i < 3; ++i) force.on_tip[i] = force.on_tip[i] + f1 * axis.e1[i] + f2 * axis.e2[i];
    };
    if (acts_along_plate(contact.law)) {
        tangential(-contact.stiffness[1] * in.across1, -contact.stiffness[2] * in.across2);
        force.stored = force.stored + stored_tangential(contact, in);
    }
    if (contact.has_friction) {
        const T slip_2 = in.slip1 * in.slip1 + in.slip2 * in.slip2;
        const T drag = contact.friction * normal / sqrt(T(slip_2 + contact.slip_velocity * contact.slip_velocity));
        tangential(-drag * in.slip1, -drag * in.slip2);
        force.friction_loss = drag * slip_2;
        force.dissipated = force.dissipated + force.friction_loss;
    }
    return force;
}

template <class T>
ARM3R_INLINE ContactForce<T> no_contact() {
    return {{T(0.0), T(0.0), T(0.0)}, T(0.0), T(0.0), T(0.0), T(0.0)};
}

// `a` where `here`, `b` in the other lanes.
template <class M, class T>
ARM3R_INLINE ContactForce<T> selected(const M& here, const ContactForce<T>& a, const ContactForce<T>& b) {
    return {{select(here, a.on_tip[0], b.on_tip[0]), select(here, a.on_tip[1], b.on_tip[1]),
             select(here, a.on_tip[2], b.on_tip[2])},
            select(here, a.normal, b.normal),
            select(here, a.stored, b.stored),
            select(here, a.dissipated, b.dissipated),
            select(here, a.friction_loss, b.friction_loss)};
}
template <class M, class T>
ARM3R_INLINE ContactForce<T> only_where(const M& touching, const ContactForce<T>& force) {
    return selected(touching, force, no_contact<T>());
}

}  // namespace arm3r
