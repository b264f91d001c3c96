// Warnings about a controller: gains with which its linearised loop is unstable, references that cannot be reached.

#include <algorithm>
#include <cmath>
#include <limits>

#include "arm3r/control/energy_reserve.hpp"
#include "base/number_text.hpp"
#include "setup/make_controller.hpp"
#include "validate/linear_loop.hpp"
#include "validate/stability_limits.hpp"
#include "validate/warnings.hpp"

namespace arm3r {
namespace {

using Warnings = std::vector<std::string>;

std::string short_number(double x) { return rounded(x, 6); }

// The gain along a unit vector, from gains of the three base axes.
double along(const Vec3<double>& n, const Vec3<double>& gains) {
    return n[0] * n[0] * gains[0] + n[1] * n[1] * gains[1] + n[2] * n[2] * gains[2];
}

// The mass that a force along a unit vector moves, from masses of the three base axes.
double mass_along(const Vec3<double>& n, const Vec3<double>& masses) {
    return 1 / (n[0] * n[0] / masses[0] + n[1] * n[1] / masses[1] + n[2] * n[2] / masses[2]);
}

// A loop that the wall's spring closes: its stiffness, the wall's normal, the effective mass of the tip along it.
struct Loop {
    double k_e, m_n;  // N/m, kg
    Vec3<double> n;
};

Loop loop_on_wall(const Setup& setup) {
    const Plant<double>& plant = setup.plant;
    return {plant.contact.stiffness[0], effective_mass(setup.controller().model, pose(setup.q), plant.wall.n),
            plant.wall.n};
}

// ---- stability of the force loops on the wall at t = 0

// "s^3 + 70 s^2 + 500 s + 40000"
std::string cubic_words(double m, double b, double c, double d) {
    std::string text = m == 1 ? "s^3" : short_number(m) + " s^3";
    if (b != 0) text += " + " + short_number(b) + " s^2";
    if (c != 0) text += " + " + short_number(c) + " s";
    return text + " + " + short_number(d);
}

void warn_of_cubic(double m, double b, double c, double d, double gain, const std::string& loop, Warnings& warnings) {
    if (is_stable(m, b, c, d)) return;
    warnings.push_back("the force loop of " + loop + " is unstable: its polynomial is " + cubic_words(m, b, c, d) +
                       (b > 0 && c > 0 ? ", and controller.force_integral_gain must stay below " +
                                             short_number(gain * b * c / (m * d)) + " 1/s"
                                       : ", and it has no damping"));
}

void warn_of_force_loop(const Controller<double>& controller, const Loop& loop, Warnings& warnings) {
    const Gains<double>& g = controller.gains;
    const double k = loop.k_e, kI = g.force_integral;
    const std::string name = "controller.type " + std::string(word_of(controller.type));
    if (controller.type == ControllerType::parallel)
        warn_of_cubic(g.force_mass, along(loop.n, g.damping), along(loop.n, g.stiffness) + k * g.force, k * kI, kI,
                      name, warnings);
    if (controller.type == ControllerType::operational_space) {
        const double fed = controller.force_term == ForceTerm::feedforward ? g.force_mass / loop.m_n : 0;
        warn_of_cubic(g.force_mass, g.force_damping, k * (g.force + fed), k * kI, kI, name, warnings);
    }
    if (controller.type == ControllerType::hybrid && controller.variant == Variant::dynamic)
        warn_of_cubic(g.force_mass, g.force_damping, k * g.force, k * kI, kI, name, warnings);
    if (controller.type == ControllerType::hybrid && controller.variant == Variant::jacobian_transpose)
        warn_of_cubic(loop.m_n, g.force_damping, k * (1 + g.force), k * kI, kI, name, warnings);
}

void warn_of_admittance(const Controller<double>& controller, const Loop& loop, Warnings& warnings) {
    if (controller.type != ControllerType::admittance || controller.inner != Inner::position) return;
    const Gains<double>& g = controller.gains;
    const double limit = admittance_limit(mass_along(loop.n, g.mass), along(loop.n, g.damping),
                                          along(loop.n, g.stiffness), g.inner_bandwidth, g.inner_damping_ratio);
    if (loop.k_e > limit)
        warnings.push_back("wall.contact.stiffness is " + shortest(loop.k_e) +
                           " N/m, and this admittance over this inner loop is stable on walls up to " +
                           short_number(limit) +
                           " N/m only; raise controller.damping, controller.mass or controller.inner_bandwidth");
}

void warn_of_reference_gain(const Controller<double>& controller, const Loop& loop, Warnings& warnings) {
    if (controller.type != ControllerType::adaptive_reference || controller.adaptation != Adaptation::integral) return;
    const Gains<double>& g = controller.gains;
    const double limit = reference_gain_limit(mass_along(loop.n, g.mass), along(loop.n, g.damping),
                                              along(loop.n, g.stiffness), loop.k_e);
    if (g.reference_gain >= limit)
        warnings.push_back("controller.reference_gain is " + shortest(g.reference_gain) +
                           " m/(N s), and the loop is stable below " + short_number(limit) +
                           "; a tenth of it is a good choice");
}

void warn_of_light_mass(const Controller<double>& controller, const Loop& loop, Warnings& warnings) {
    const bool shapes = controller.type == ControllerType::shaped_impedance ||
                        controller.type == ControllerType::adaptive_reference ||
                        (controller.type == ControllerType::admittance && controller.inner == Inner::exact);
    const double mass = mass_along(loop.n, controller.gains.mass);
    if (shapes && mass < loop.m_n / 3)
        warnings.push_back("controller.mass is " + short_number(mass) +
                           " kg along the wall's normal, less than a third of the " + short_number(loop.m_n) +
                           " kg that the arm shows there: noise and delay of the force are amplified " +
                           short_number(loop.m_n / mass - 1) + " times");
}

// Whether the torque depends on the measured contact force: to track a force, to yield to it, or to cancel it.
bool uses_force(const Controller<double>& controller) {
    if (may_cancel_force(controller.type)) return controller.cancels_force;
    return controller.type == ControllerType::shaped_impedance || controller.type == ControllerType::admittance ||
           tracks_force(controller.type);
}

void warn_of_contact(const Setup& setup, Warnings& warnings) {
    const Plant<double>& plant = setup.plant;
    if (!plant.has_wall) return;
    if (uses_force(setup.controller()) && !plant.acts_on_arm)
        warnings.push_back(
            "controller.type " + std::string(word_of(setup.controller().type)) +
            (tracks_force(setup.controller().type) ? " presses on the wall" : " uses the contact force") +
            " and wall.acts_on_arm is false: the arm does not feel the force that "
            "its controller measures; write acts_on_arm: true");
    const Loop loop = loop_on_wall(setup);
    warn_of_light_mass(setup.controller(), loop, warnings);
}

// Where a formula has the limit of a gain.
void warn_of_contact_loop(const Setup& setup, Warnings& warnings) {
    const Plant<double>& plant = setup.plant;
    if (!plant.has_wall || !plant.acts_on_arm || is_damped(plant.contact.law)) return;
    const Loop loop = loop_on_wall(setup);
    warn_of_force_loop(setup.controller(), loop, warnings);
    warn_of_admittance(setup.controller(), loop, warnings);
    warn_of_reference_gain(setup.controller(), loop, warnings);
}

// J^-1 S_p gives wrong joint torques for errors of the tip where M^-1 P has a negative eigenvalue.
void warn_of_raibert_craig(const Setup& setup, Warnings& warnings) {
    const Controller<double>& controller = setup.controller();
    if (controller.type != ControllerType::hybrid || controller.variant != Variant::raibert_craig ||
        !setup.plant.has_wall)
        return;
    const double least = projected_mobility(controller.model, pose(setup.q), setup.plant.wall.n);
    warnings.push_back("hybrid variant raibert_craig is unstable in part of the workspace" +
                       (least < 0
                            ? ", and at the start too: M^-1 P has the eigenvalue " + short_number(least) + " 1/(kg m^2)"
                            : std::string(", though not at the start")) +
                       "; projected and dynamic are not");
}

// ---- sampling

// For laws that command accelerations, held for a period.
void warn_of_slow_samples(const Setup& setup, Warnings& warnings) {
    const Controller<double>& controller = setup.controller();
    const bool accelerates = controller.type == ControllerType::computed_torque ||
                             controller.type == ControllerType::resolved_acceleration ||
                             controller.type == ControllerType::operational_space ||
                             (controller.type == ControllerType::hybrid && controller.variant == Variant::dynamic);
    if (!setup.digital.sampling.on || !accelerates) return;
    const Vec3<double>&Kp = controller.gains.position, &Kd = controller.gains.velocity;
    double longest = max_period(Kp[0], Kd[0]);
    for (int i = 1; i < 3; ++i) longest = std::min(longest, max_period(Kp[i], Kd[i]));
    if (setup.digital.sampling.period >= longest)
        warnings.push_back("the controller computes every " + short_number(setup.digital.sampling.period) +
                           " s, and these position and velocity gains are stable with periods below " +
                           short_number(longest) + " s only, min(2 Kd/Kp, 2/Kd); raise sampling.rate");
}

// Hz: the lowest rate found at which the loop is stable; 0: none.
double stable_rate(const Setup& setup, TipPlace place) {
    const auto is_stable_at = [&](double rate) {
        const auto growth = loop_growth(setup, place, 1 / rate);
        return growth && growth->per_second <= least_growth;
    };
    double low = 1 / setup.digital.sampling.period, high = 2 * low;
    constexpr int doublings = 8, halvings = 6;
    for (int i = 0; !is_stable_at(high); ++i, low = high, high *= 2)
        if (i == doublings) return 0;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (is_stable_at(middle) ? high : low) = middle;
    }
    return high;
}

std::string unstable_loop_text(const Setup& setup, TipPlace place, const LoopGrowth& growth) {
    const std::string where = place == TipPlace::in_contact ? " in contact" : "";
    if (growth.period == 0)
        return "the loop is unstable" + where + " at the pose of the start: its fastest mode grows by a factor e in " +
               rounded(1 / growth.per_second, 3) + " s; lower the gains, or raise the damping";
    const double rate = stable_rate(setup, place);
    const std::string factor = rounded(exp(growth.per_second * growth.period), 5);
    return "the sampled loop of " + rounded(1 / growth.period, 6) + " Hz is unstable" + where +
           " at the pose of the start: its fastest mode grows " + factor + " times a sample; " +
           (rate > 0 ? "from about " + rounded(rate, 3) +
                           " Hz on it is stable: raise sampling.rate, or take less delay "
                           "or lower gains"
                     : std::string("a higher sampling.rate alone does not help: take less delay or lower gains"));
}

// Where no formula has said it.
void warn_of_linear_loop(const Setup& setup, Warnings& warnings) {
    for (const TipPlace place : {TipPlace::free, TipPlace::in_contact}) {
        const std::optional<LoopGrowth> growth = loop_growth(setup, place);
        if (!growth || !(growth->per_second > least_growth)) continue;
        warnings.push_back(unstable_loop_text(setup, place, *growth));
        return;
    }
}

void warn_of_observer(const Setup& setup, Warnings& warnings) {
    if (!setup.digital.sampling.on || !setup.observes()) return;
    const Vec3<double>& gain = setup.digital.observer.gain;
    const double product = std::max({gain[0], gain[1], gain[2]}) * setup.digital.sampling.period;
    if (product > 0.2)
        warnings.push_back("observer.gain times the period of sampling is " + short_number(product) +
                           (product >= 2
                                ? ": the residual diverges from 2 on; keep it below 0.2"
                                : ", and above 0.2 the residual is no longer the filter of the external torque"));
}

// ---- references

double latest_turn(const Reference<double>& reference) {
    switch (reference.path) {
        case Path::hold:
        case Path::point: return 0;
        case Path::sinusoid: return reference.start + (reference.frequency > 0 ? 1 / reference.frequency : 0);
        default: return reference.end;
    }
}

// The largest distance of the desired tip position from the arm's workspace, m.
double workspace_excess(const Arm<double>& model, const Reference<double>& reference, double start, double stop) {
    const double length = std::max(0.0, std::min(stop, latest_turn(reference)) - start);
    double farthest = 0;
    constexpr int samples = 200;
    for (int i = 0; i <= samples; ++i) {
        const Vec3<double> tip = desired_motion_at(reference, start + length * i / samples).position;
        farthest = std::max(farthest, workspace_excess(model, tip));
    }
    return farthest;
}

// The distance of a table's first point from the tip, m.
double distance_at_start(const Controller<double>& controller, double start, const Vec3<double>& q) {
    const Vec3<double> off =
        minus(desired_motion_at(controller.reference, start).position, tip_position(controller.model, pose(q)));
    return std::sqrt(dot(off, off));
}

void warn_of_reference(const Setup& setup, Warnings& warnings) {
    const Controller<double>& controller = setup.controller();
    const Reference<double>& reference = controller.reference;
    if (!tracks_path(controller.type)) return;
    const double beyond =
        reference.in_joints ? 0 : workspace_excess(controller.model, reference, setup.start, setup.stop);
    if (beyond > 1e-9)
        warnings.push_back("the reference of the tip leaves the reach of the arm by " + short_number(beyond) + " m");
    const double distance = reference.path == Path::table ? distance_at_start(controller, setup.start, setup.q) : 0;
    if (distance > 1e-3)
        warnings.push_back("the table of the reference begins " + short_number(distance) +
                           " m from where the tip starts");
    if (is_moving(reference.path) && reference.start > setup.stop)
        warnings.push_back(std::string(reference.path == Path::table ? "reference.t[0]" : "reference.start") + " is " +
                           shortest(reference.start) + " s, and the run ends at " + shortest(setup.stop) + " s");
}

double min_force(const Reference<double>& reference) {
    if (reference.force_profile == ForceProfile::constant) return reference.force;
    if (reference.force_profile == ForceProfile::sinusoid) return reference.force - std::abs(reference.force_amplitude);
    return std::min(reference.force, reference.force_before);
}

void warn_of_pressing(const Setup& setup, Warnings& warnings) {
    const Controller<double>& controller = setup.controller();
    if (!tracks_force(controller.type) && controller.type != ControllerType::admittance) return;
    const Reference<double>& reference = controller.reference;
    if (const double least = min_force(reference); least < 0)
        warnings.push_back("the reference of the force falls to " + shortest(least) +
                           " N: a wall cannot pull, so the tip will leave it");
    const bool changes = reference.force_profile == ForceProfile::step || reference.force_profile == ForceProfile::ramp;
    if (changes && reference.force_start > setup.stop)
        warnings.push_back("reference.force.start is " + shortest(reference.force_start) + " s, and the run ends at " +
                           shortest(setup.stop) + " s");
    if (tracks_force(controller.type) && controller.anti_windup != AntiWindup::none &&
        !setup.plant.arm.has_torque_limit)
        warnings.push_back("controller.anti_windup has nothing to do: every arm.torque_limit is inf");
}

void warn_of_tank(const Setup& setup, Warnings& warnings) {
    const Controller<double>& controller = setup.controller();
    const Vec3<double>& K_0 = controller.gains.stiffness;
    const double least = std::min({K_0[0], K_0[1], K_0[2]});
    if (controller.type == ControllerType::energy_tank && controller.gains.stiffness_amplitude > least)
        warnings.push_back("controller.stiffness_amplitude is " + shortest(controller.gains.stiffness_amplitude) +
                           " N/m, more than the stiffness of " + shortest(least) +
                           " N/m about which it varies: the spring will push outwards");
}

// ---- the reserve of energy (8.8)

// The spring of a law with a reserve, along an axis, and the effective mass of the tip there.
struct Spring {
    double stiffness, damping, mass;  // N/m, N s/m, kg
    Vec3<double> axis;
};

std::vector<Spring> springs_of(const Controller<double>& controller, const Pose<double>& p) {
    const Gains<double>& g = controller.gains;
    const auto spring = [&](double stiffness, double damping, const Vec3<double>& axis) {
        return Spring{stiffness, damping, effective_mass(controller.model, p, axis), axis};
    };
    if (controller.type == ControllerType::virtual_wall) return {spring(g.stiffness[0], g.damping[0], g.plane_normal)};
    return {spring(g.stiffness[0], g.damping[0], {1, 0, 0}), spring(g.stiffness[1], g.damping[1], {0, 1, 0}),
            spring(g.stiffness[2], g.damping[2], {0, 0, 1})};
}

// A torque that acts T (1/2 + d) late on average makes a spring K put out the energy that a damping of K T (1/2 + d)
// takes.
void warn_of_held_spring(const Setup& setup, const Spring& spring, Warnings& warnings) {
    const Sampling<double>& sampling = setup.digital.sampling;
    const double lag = sampling.period * (0.5 + sampling.delay), reach = sampling.period * (1 + sampling.delay);
    const std::string held = "controller.stiffness is " + shortest(spring.stiffness) + " N/m";
    if (setup.controller().type == ControllerType::energy_tank && spring.stiffness * lag > spring.damping)
        warnings.push_back(held + ", and torques that act " + short_number(lag) +
                           " s late on average make such a spring give out more energy than controller.damping takes: "
                           "the tank empties, and then the brake acts all the time; keep the stiffness "
                           "below " +
                           short_number(spring.damping / lag) + " N/m, or raise sampling.rate");
    const double turn = reach * std::sqrt(spring.stiffness / spring.mass);
    if (turn > max_foreseen_turn)
        warnings.push_back(held + ": its oscillation turns by " + short_number(turn) +
                           " rad until a torque has acted, and beyond " + short_number(max_foreseen_turn) +
                           " rad the controller cannot foresee how much energy it gives out: it may create energy; "
                           "raise sampling.rate or lower sampling.delay");
}

// The deflection of the spring at which an actuator reaches its limit, m.
double pressed_at_limit(const Setup& setup, const Spring& spring) {
    const Pose<double> p = pose(setup.q);
    const Vec3<double> weight = gravity_torque(setup.controller().model, p);
    const Vec3<double> per_newton = tip_force_torque(setup.controller().model, p, spring.axis);
    double least = infinite;
    for (int i = 0; i < 3; ++i)
        if (per_newton[i] != 0)
            least = std::min(least, (setup.plant.arm.torque_limit[i] - std::abs(weight[i])) / std::abs(per_newton[i]));
    return std::max(0.0, least) / spring.stiffness;
}

// Energy that the controller cannot compute or predict exactly.
void warn_of_counting(const Setup& setup, const std::string& law, Warnings& warnings) {
    const Sampling<double>& sampling = setup.digital.sampling;
    const Sensors<double>& sensors = setup.digital.sensors;
    if (sensors.has_encoder || sensors.velocity != VelocityEstimate::exact)
        warnings.push_back(law + " computes its energy from sensors.encoder and sensors.velocity" +
                           (sensors.has_encoder ? ", here in steps of " + short_number(sensors.encoder_step) + " rad"
                                                : std::string()) +
                           ": it never creates energy only as far as they are exact");
    if (sampling.delay != std::floor(sampling.delay))
        warnings.push_back("sampling.delay is " + shortest(sampling.delay) +
                           " samples, and two torques act within each period of " + short_number(sampling.period) +
                           " s: " + law +
                           " computes its energy to the third order of the period only; "
                           "whole delays are counted exactly");
    if (setup.controller().type != ControllerType::virtual_wall) return;
    const Gains<double>& g = setup.controller().gains;
    const double depth =
        dot(g.plane_normal, minus(g.plane_point, tip_position(setup.controller().model, pose(setup.q))));
    if (depth > 0 && sampling.delay > 0)
        warnings.push_back("the tip starts " + short_number(depth) +
                           " m inside the virtual wall, and the first torque acts there for " +
                           short_number(1 + sampling.delay) +
                           " periods: it may create energy that is taken back later; start outside");
    const ExternalForce<double>& external_force = setup.plant.external_force;
    if (!external_force.on) return;
    const double size = std::sqrt(dot(external_force.force, external_force.force)),
                 reach = sampling.period * (1 + sampling.delay);
    if (size == 0) return;
    const Vec3<double> along(external_force.force[0] / size, external_force.force[1] / size,
                             external_force.force[2] / size);
    const double mass = effective_mass(setup.controller().model, pose(setup.q), along);
    warnings.push_back(
        "push.force moves the tip by " + short_number(0.5 * reach * reach * size / mass) +
        " m until a torque has acted, which the controller does not foresee: it takes the energy that it "
        "creates meanwhile back at the next samples");
}

void warn_of_reserve(const Setup& setup, Warnings& warnings) {
    const Controller<double>& controller = setup.controller();
    if (!has_reserve(controller)) return;
    const std::string law = "controller.type " + std::string(word_of(controller.type));
    double pressed = infinite;
    for (const Spring& spring : springs_of(controller, pose(setup.q))) {
        if (setup.digital.sampling.on) warn_of_held_spring(setup, spring, warnings);
        if (spring.stiffness > 0) pressed = std::min(pressed, pressed_at_limit(setup, spring));
    }
    if (setup.plant.arm.has_torque_limit)
        warnings.push_back(
            law + " never creates energy as long as no torque is at arm.torque_limit, which a spring pressed by " +
            short_number(pressed) + " m reaches at the start");
    if (setup.digital.sampling.on) warn_of_counting(setup, law, warnings);
}

void warn_of_push(const Setup& setup, Warnings& warnings) {
    if (!setup.plant.external_force.on) return;
    const Vec3<double>& force = setup.plant.external_force.force;
    if (force[0] == 0 && force[1] == 0 && force[2] == 0) warnings.push_back("push.force is [0, 0, 0]: nothing pushes");
    if (setup.plant.external_force.start > setup.stop)
        warnings.push_back("push.start is " + shortest(setup.plant.external_force.start) + " s, and the run ends at " +
                           shortest(setup.stop) + " s");
}

}  // namespace

Warnings unstable_loops(const Setup& setup) {
    Warnings warnings;
    warn_of_contact_loop(setup, warnings);
    warn_of_slow_samples(setup, warnings);
    if (warnings.empty()) warn_of_linear_loop(setup, warnings);
    return warnings;
}

void add_controller_warnings(const Setup& setup, Warnings& warnings) {
    warn_of_contact(setup, warnings);
    for (std::string& loop : unstable_loops(setup)) warnings.push_back(std::move(loop));
    warn_of_raibert_craig(setup, warnings);
    warn_of_observer(setup, warnings);
    warn_of_reference(setup, warnings);
    warn_of_pressing(setup, warnings);
    warn_of_tank(setup, warnings);
    warn_of_reserve(setup, warnings);
    warn_of_push(setup, warnings);
}

}  // namespace arm3r
