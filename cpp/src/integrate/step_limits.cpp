#include "integrate/step_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace arm3r {
namespace {

// The stiffness along the normal, N/m, that gives the mass m_n the highest frequency that all springs of the contact
// together can give.
double stiffness_felt(const Plant<double>& plant, const Axes<double>& axis, const Pose<double>& p,
                      const Indentation<double>& in, double m_n) {
    const Contact<double>& contact = plant.contact;
    const Vec3<double>& k = contact.stiffness;
    if (contact.law == ContactLaw::diagonal)
        return k[0] + k[1] * m_n / effective_mass(plant.arm, p, axis.e1) +
               k[2] * m_n / effective_mass(plant.arm, p, axis.e2);
    if (contact.law != ContactLaw::hunt_crossley) return k[0];
    const double exponent = contact.exponent;
    const double energy = normal_force_law(contact, in).stored + 0.5 * m_n * in.rate * in.rate;
    const double deepest = power((exponent + 1) * energy / k[0], 1 / (exponent + 1));
    return deepest > 0 ? exponent * (exponent + 1) * energy / (deepest * deepest) : 0;  // the tangent stiffness there
}

}  // namespace

double max_wall_step(const Wall<double>& wall) {
    double h = infinite;
    if (wall.motion == Motion::sinusoid) h = std::min(h, 1 / (16 * wall.sinusoid.frequency));
    if (wall.rotation == Rotation::sinusoid) h = std::min(h, 1 / (16 * wall.turn_sinusoid.frequency));
    if (wall.rotation == Rotation::constant) h = std::min(h, two_pi / (16 * std::abs(wall.turn_rate)));
    return h;
}

double contact_time(const Plant<double>& plant, const WallState<double>& wall, const Pose<double>& p,
                    const Indentation<double>& in) {
    const Axes<double> axis = axes(plant.wall, wall);
    const double m_n = effective_mass(plant.arm, p, axis.n);
    const double stiffness = stiffness_felt(plant, axis, p, in, m_n);
    if (!(stiffness > 0)) return infinite;
    const Contact<double>& contact = plant.contact;
    const bool swings =
        contact.law != ContactLaw::kelvin_voigt || contact.damping * contact.damping < 4 * stiffness * m_n;
    return swings ? 0.25 * std::numbers::pi * std::sqrt(m_n / stiffness) : infinite;
}

double time_to_break(const Contact<double>& contact, const Indentation<double>& in, double contact_time, double rtol) {
    if (contact.law != ContactLaw::hunt_crossley || contact.exponent == 1 || in.rate >= 0) return infinite;
    const double negligible = contact_time * power(100 * rtol, 1 / (contact.exponent + 1));
    return std::max(0.9 * in.depth / -in.rate, negligible);
}

}  // namespace arm3r
