#include "validate/fixed_step.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "validate/linear_loop.hpp"

namespace arm3r {
namespace {

constexpr double most_per_step = 1;  // rate times step: rk4 is unstable from 2.8 on, and inaccurate long before

struct Rate {
    std::string key;  // what sets it
    double value;     // 1/s
};

// (M^-1)_ii x_i of the joint with the largest.
double fastest_joint(const Arm<double>& arm, const Vec3<double>& q, const Vec3<double>& x) {
    double fastest = 0;
    for (int i = 0; i < 3; ++i) {
        Vec3<double> tau(0, 0, 0);
        tau[i] = x[i];
        fastest = std::max(fastest, joint_acceleration(arm, pose(q), {0, 0, 0}, tau, {0, 0, 0})[i]);
    }
    return fastest;
}

void add_joints(const Setup& setup, std::vector<Rate>& rates) {
    const Arm<double>& arm = setup.plant.arm;
    rates.push_back({"arm.damping, as d/M,", fastest_joint(arm, setup.q, arm.damping)});
    const double by_friction = fastest_joint(arm, setup.q, arm.friction);
    if (by_friction > 0) rates.push_back({"arm.friction, as F/(v M),", by_friction / arm.friction_velocity});
}

void add_contact(const Setup& setup, std::vector<Rate>& rates) {
    const Contact<double>& contact = setup.plant.contact;
    if (!setup.plant.has_wall || !setup.plant.acts_on_arm || !is_linear(contact.law)) return;
    const double m_n = effective_mass(setup.plant.arm, pose(setup.q), setup.plant.wall.n);
    const double stiffest = std::max({contact.stiffness[0], contact.stiffness[1], contact.stiffness[2]});
    rates.push_back({"wall.contact.stiffness, as sqrt(K_E/m_n),", std::sqrt(stiffest / m_n)});
    if (contact.damping > 0) rates.push_back({"wall.contact.damping, as c/m_n,", contact.damping / m_n});
}

void add_controller(const Setup& setup, std::vector<Rate>& rates) {
    const Sensors<double>& sensors = setup.digital.sampling.on ? setup.digital.sensors : setup.plant.sensors;
    if (sensors.has_analog_filter) rates.push_back({"sensors.force.analog_cutoff, as 2 pi f,", sensors.analog_rate});
    if (setup.digital.sampling.on) return;
    const Vec3<double>& gain = setup.plant.observer.gain;
    if (setup.plant.observer.on) rates.push_back({"observer.gain,", std::max({gain[0], gain[1], gain[2]})});
    if (const auto loop = fastest_rate(setup))
        rates.push_back({"the gains of controller, by the fastest mode,", *loop});
}

std::vector<Rate> known_rates(const Setup& setup) {
    std::vector<Rate> rates;
    add_joints(setup, rates);
    add_contact(setup, rates);
    add_controller(setup, rates);
    return rates;
}

}  // namespace

void warn_of_fixed_step(const Setup& setup, std::vector<std::string>& warnings) {
    if (setup.solver.method != SolverMethod::rk4) return;
    for (const Rate& rate : known_rates(setup)) {
        const double product = setup.solver.step * rate.value;
        if (!(product > most_per_step)) continue;
        warnings.push_back("solver.step times the rate of " + rate.key + " " + rounded(rate.value, 4) + " 1/s, is " +
                           rounded(product, 4) +
                           ": rk4 loses its accuracy above 1 and diverges above 2.8; take a "
                           "solver.step of at most " +
                           rounded(most_per_step / rate.value, 2) + " s, or method: dopri5");
    }
}

}  // namespace arm3r
