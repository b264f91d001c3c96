#pragma once
// Limits of the step because of the wall, which error estimates do not see; docs/model.md (5.2). All in s, of every lane.

#include <numbers>

#include "arm3r/plant.hpp"

namespace arm3r {

// A sixteenth of the period of the wall's oscillation or rotation.
double max_wall_step(const Wall<double>& wall);

// The stiffness along the normal, N/m, that gives the mass m_n the highest frequency that all springs of the contact
// together can give.
template <class T>
ARM3R_INLINE T stiffness_felt(const Plant<T>& plant, const Axes<T>& axis, const Pose<T>& p, const Indentation<T>& in,
                              const T& m_n) {
    const Contact<T>& contact = plant.contact;
    const Vec3<T>& k = contact.stiffness;
    if (acts_along_plate(contact.law))
        return k[0] + k[1] * m_n / effective_mass(plant.arm, p, axis.e1) +
               k[2] * m_n / effective_mass(plant.arm, p, axis.e2);
    if (is_linear(contact.law)) return k[0];
    const T after = contact.exponent + 1.0;
    const T energy = normal_force_law(contact, in).stored + 0.5 * m_n * in.rate * in.rate;
    const T deepest = power(T(after * energy / k[0]), T(1.0 / after));
    const T at_deepest = contact.exponent * after * energy / (deepest * deepest);  // the tangent stiffness there
    return select(deepest > T(0.0), at_deepest, T(0.0));
}

// A quarter of the shortest half period of the present contact, so that contact cannot begin and end within a step;
// infinite if the contact is damped so much that it does not oscillate.
template <class T>
ARM3R_INLINE T contact_time(const Plant<T>& plant, const WallState<T>& wall, const Pose<T>& p,
                            const Indentation<T>& in) {
    const Axes<T> axis = axes(plant.wall, wall);
    const T m_n = effective_mass(plant.arm, p, axis.n);
    const T stiffness = stiffness_felt(plant, axis, p, in, m_n);
    const Contact<T>& contact = plant.contact;
    const auto swings = stiffness > T(0.0) && contact.damping * contact.damping < 4.0 * stiffness * m_n;
    return select(swings, T(0.25 * std::numbers::pi * sqrt(T(m_n / stiffness))), T(infinite));
}

// Nine tenths of the time after which a contact whose law is a power of the depth ends at its present rate, because error estimates
// do not see the error of a step beyond depth 0; but not less than the time in which the spring loses a negligible part
// of its energy. Infinite for other laws, and while the depth grows.
template <class T>
ARM3R_INLINE T time_to_break(const Contact<T>& contact, const Indentation<T>& in, const T& contact_time,
                             const T& rtol) {
    if (is_linear(contact.law)) return T(infinite);
    const T negligible = contact_time * power(T(100.0 * rtol), T(1.0 / (contact.exponent + 1.0)));
    const auto lasts = contact.exponent == T(1.0) || in.rate >= T(0.0);
    return select(lasts, T(infinite), max(T(0.9 * in.depth / -in.rate), negligible));
}

}  // namespace arm3r
