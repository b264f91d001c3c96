// What is allowed of a controller but probably a slip: gains that its linear loop does not bear, references that lead
// nowhere.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "arm3r/control/energy_reserve.hpp"
#include "base/number_text.hpp"
#include "setup/make_controller.hpp"
#include "validate/stability_limits.hpp"
#include "validate/warnings.hpp"

namespace arm3r {
namespace {

using Slips = std::vector<std::string>;

// To six digits.
std::string rounded(double x) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::general, 6).ptr};
}

std::string word_of(Controls type) { return known_key("controller.type").choices[static_cast<std::size_t>(type)]; }

// Of gains of the three base axes, the one along a unit vector.
double along(const Vec3<double>& n, const Vec3<double>& gains) {
    return n[0] * n[0] * gains[0] + n[1] * n[1] * gains[1] + n[2] * n[2] * gains[2];
}

// Of masses of the three base axes, the one that a force along a unit vector moves.
double mass_along(const Vec3<double>& n, const Vec3<double>& masses) {
    return 1 / (n[0] * n[0] / masses[0] + n[1] * n[1] / masses[1] + n[2] * n[2] / masses[2]);
}

// A loop that the wall's spring closes: its stiffness, the face's normal, the mass that the tip shows along it.
struct Loop {
    double k_e, m_n;  // N/m, kg
    Vec3<double> n;
};

// ---- stability of the force loops against the wall as it stands at t = 0

void slip_of_cubic(double m, double b, double c, double d, double gain, const std::string& loop, Slips& slips) {
    if (is_stable(m, b, c, d)) return;
    slips.push_back("the force loop of " + loop + " is unstable: s^3, s^2, s and 1 have " + rounded(m) + ", " +
                    rounded(b) + ", " + rounded(c) + " and " + rounded(d) +
                    (b > 0 && c > 0 ? ", and controller.force_integral_gain must stay below " +
                                          rounded(gain * b * c / (m * d)) + " 1/s"
                                    : ", and nothing damps it"));
}

void slip_of_force_loop(const Controller<double>& controller, const Loop& loop, Slips& slips) {
    const Gains<double>& g = controller.gains;
    const double k = loop.k_e, kI = g.force_integral;
    const std::string name = "controller.type " + word_of(controller.type);
    if (controller.type == Controls::parallel)
        slip_of_cubic(g.force_mass, along(loop.n, g.damping), along(loop.n, g.stiffness) + k * g.force, k * kI, kI,
                      name, slips);
    if (controller.type == Controls::operational_space) {
        const double fed = controller.force_term == ForceTerm::feedforward ? g.force_mass / loop.m_n : 0;
        slip_of_cubic(g.force_mass, g.force_damping, k * (g.force + fed), k * kI, kI, name, slips);
    }
    if (controller.type == Controls::hybrid && controller.variant == Variant::dynamic)
        slip_of_cubic(g.force_mass, g.force_damping, k * g.force, k * kI, kI, name, slips);
    if (controller.type == Controls::hybrid && controller.variant == Variant::jacobian_transpose)
        slip_of_cubic(loop.m_n, g.force_damping, k * (1 + g.force), k * kI, kI, name, slips);
}

void slip_of_admittance(const Controller<double>& controller, const Loop& loop, Slips& slips) {
    if (controller.type != Controls::admittance || controller.inner != Inner::position) return;
    const Gains<double>& g = controller.gains;
    const double limit = admittance_limit(mass_along(loop.n, g.mass), along(loop.n, g.damping),
                                          along(loop.n, g.stiffness), g.inner_bandwidth, g.inner_damping_ratio);
    if (loop.k_e > limit)
        slips.push_back("wall.contact.stiffness is " + shortest(loop.k_e) +
                        " N/m, and this admittance over this inner loop is stable on walls up to " + rounded(limit) +
                        " N/m only; raise controller.damping, controller.mass or controller.inner_bandwidth");
}

void slip_of_reference_gain(const Controller<double>& controller, const Loop& loop, Slips& slips) {
    if (controller.type != Controls::adaptive_reference || controller.adaptation != Adaptation::integral) return;
    const Gains<double>& g = controller.gains;
    const double limit = reference_gain_limit(mass_along(loop.n, g.mass), along(loop.n, g.damping),
                                              along(loop.n, g.stiffness), loop.k_e);
    if (g.reference >= limit)
        slips.push_back("controller.reference_gain is " + shortest(g.reference) +
                        " m/(N s), and the loop is stable below " + rounded(limit) +
                        "; a tenth of it is a good choice");
}

void slip_of_light_mass(const Controller<double>& controller, const Loop& loop, Slips& slips) {
    const bool shapes = controller.type == Controls::shaped_impedance ||
                        controller.type == Controls::adaptive_reference ||
                        (controller.type == Controls::admittance && controller.inner == Inner::exact);
    const double mass = mass_along(loop.n, controller.gains.mass);
    if (shapes && mass < loop.m_n / 3)
        slips.push_back("controller.mass is " + rounded(mass) +
                        " kg along the wall's normal, less than a third of the " + rounded(loop.m_n) +
                        " kg that the arm shows there: noise and delay of the force are amplified " +
                        rounded(loop.m_n / mass - 1) + " times");
}

// Whether the measured contact force enters the torque: to reach a wanted one, to yield to it, or to cancel it.
bool uses_force(const Controller<double>& controller) {
    switch (controller.type) {
        case Controls::shaped_impedance:
        case Controls::admittance: return true;
        case Controls::computed_torque:
        case Controls::resolved_acceleration: return controller.cancels_force;
        default: return wants_force(controller.type);
    }
}

void slips_of_contact(const Setup& setup, Slips& slips) {
    const Plant<double>& plant = setup.plant;
    if (!plant.has_wall) return;
    if (uses_force(setup.law()) && !plant.acts_on_arm)
        slips.push_back("controller.type " + word_of(setup.law().type) +
                        (wants_force(setup.law().type) ? " presses on the wall" : " uses the contact force") +
                        " and wall.acts_on_arm is false: the arm does not feel the force that "
                        "its controller measures; write acts_on_arm: true");
    const Pose<double> p = pose(setup.q);
    const Loop loop{plant.contact.stiffness[0], effective_mass(setup.law().model, p, plant.wall.n), plant.wall.n};
    slip_of_light_mass(setup.law(), loop, slips);
    if (!plant.acts_on_arm || (plant.contact.law != Law::spring && plant.contact.law != Law::diagonal)) return;
    slip_of_force_loop(setup.law(), loop, slips);
    slip_of_admittance(setup.law(), loop, slips);
    slip_of_reference_gain(setup.law(), loop, slips);
}

// J^-1 S_p turns errors of the tip into the wrong joint torques where M^-1 P has an eigenvalue below zero.
void slip_of_raibert_craig(const Setup& setup, Slips& slips) {
    const Controller<double>& controller = setup.law();
    if (controller.type != Controls::hybrid || controller.variant != Variant::raibert_craig || !setup.plant.has_wall)
        return;
    const double least = projected_mobility(controller.model, pose(setup.q), setup.plant.wall.n);
    slips.push_back("hybrid variant raibert_craig is unstable in part of the workspace" +
                    (least < 0 ? ", and at the start too: M^-1 P has the eigenvalue " + rounded(least) + " 1/(kg m^2)"
                               : std::string(", though not at the start")) +
                    "; projected and dynamic are not");
}

// ---- sampling

// Of the laws that ask for accelerations, on their own and held for a period.
void slip_of_slow_samples(const Setup& setup, Slips& slips) {
    const Controller<double>& controller = setup.law();
    const bool accelerates = controller.type == Controls::computed_torque ||
                             controller.type == Controls::resolved_acceleration ||
                             controller.type == Controls::operational_space ||
                             (controller.type == Controls::hybrid && controller.variant == Variant::dynamic);
    if (!setup.digital.sampling.on || !accelerates) return;
    const Vec3<double>&Kp = controller.gains.position, &Kd = controller.gains.velocity;
    double longest = longest_period(Kp[0], Kd[0]);
    for (int i = 1; i < 3; ++i) longest = std::min(longest, longest_period(Kp[i], Kd[i]));
    if (setup.digital.sampling.period >= longest)
        slips.push_back("the controller computes every " + rounded(setup.digital.sampling.period) +
                        " s, and these position and velocity gains are stable with periods below " + rounded(longest) +
                        " s only, min(2 Kd/Kp, 2/Kd); raise sampling.rate");
}

void slip_of_observer(const Setup& setup, Slips& slips) {
    if (!setup.digital.sampling.on || !setup.observes()) return;
    const Vec3<double>& gain = setup.digital.observer.gain;
    const double product = std::max({gain[0], gain[1], gain[2]}) * setup.digital.sampling.period;
    if (product > 0.2)
        slips.push_back("observer.gain times the period of sampling is " + rounded(product) +
                        (product >= 2 ? ": the residual diverges from 2 on; keep it below 0.2"
                                      : ", and above 0.2 the residual is no longer the filter of the external torque"));
}

// ---- references

double latest_turn(const Setpoint<double>& wanted) {
    switch (wanted.path) {
        case Path::hold:
        case Path::point: return 0;
        case Path::sinusoid: return wanted.start + (wanted.frequency > 0 ? 1 / wanted.frequency : 0);
        default: return wanted.end;
    }
}

// How far the wanted tip comes out of the arm's reach, m.
double beyond_reach(const Arm<double>& model, const Setpoint<double>& wanted, double start, double stop) {
    const double a2 = model.link2.length, a3 = model.link3.length,
                 length = std::max(0.0, std::min(stop, latest_turn(wanted)) - start);
    double farthest = 0;
    constexpr int looks = 200;
    for (int i = 0; i <= looks; ++i) {
        const Vec3<double> tip = wanted_at(wanted, start + length * i / looks).position;
        const double from_shoulder = hypot2(hypot2(tip[0], tip[1]), tip[2] - model.base_height);
        farthest = std::max({farthest, from_shoulder - (a2 + a3), std::abs(a2 - a3) - from_shoulder});
    }
    return farthest;
}

// Of a table, m.
double distance_at_start(const Controller<double>& controller, double start, const Vec3<double>& q) {
    const Vec3<double> off =
        minus(wanted_at(controller.setpoint, start).position, tip_position(controller.model, pose(q)));
    return std::sqrt(dot(off, off));
}

void slips_of_reference(const Setup& setup, Slips& slips) {
    const Controller<double>& controller = setup.law();
    const Setpoint<double>& wanted = controller.setpoint;
    if (!wants_path(controller.type)) return;
    const double beyond = wanted.in_joints ? 0 : beyond_reach(controller.model, wanted, setup.start, setup.stop);
    if (beyond > 1e-9)
        slips.push_back("the reference of the tip leaves the reach of the arm by " + rounded(beyond) + " m");
    const double apart = wanted.path == Path::table ? distance_at_start(controller, setup.start, setup.q) : 0;
    if (apart > 1e-3)
        slips.push_back("the table of the reference begins " + rounded(apart) + " m from where the tip starts");
    if (is_moving(wanted.path) && wanted.start > setup.stop)
        slips.push_back(std::string(wanted.path == Path::table ? "reference.t[0]" : "reference.start") + " is " +
                        shortest(wanted.start) + " s, and the run ends at " + shortest(setup.stop) + " s");
}

double smallest_force(const Setpoint<double>& wanted) {
    if (wanted.pressing == Pressing::constant) return wanted.force;
    if (wanted.pressing == Pressing::sinusoid) return wanted.force - std::abs(wanted.force_amplitude);
    return std::min(wanted.force, wanted.force_before);
}

void slips_of_pressing(const Setup& setup, Slips& slips) {
    const Controller<double>& controller = setup.law();
    if (!wants_force(controller.type) && controller.type != Controls::admittance) return;
    const Setpoint<double>& wanted = controller.setpoint;
    if (const double least = smallest_force(wanted); least < 0)
        slips.push_back("the wanted force falls to " + shortest(least) +
                        " N: a wall cannot pull, so the tip will leave it");
    const bool changes = wanted.pressing == Pressing::step || wanted.pressing == Pressing::ramp;
    if (changes && wanted.force_start > setup.stop)
        slips.push_back("reference.force.start is " + shortest(wanted.force_start) + " s, and the run ends at " +
                        shortest(setup.stop) + " s");
    if (wants_force(controller.type) && controller.anti_windup != AntiWindup::none && !setup.plant.arm.has_torque_limit)
        slips.push_back("controller.anti_windup has nothing to do: every arm.torque_limit is inf");
}

void slips_of_tank(const Setup& setup, Slips& slips) {
    const Controller<double>& controller = setup.law();
    const Vec3<double>& K_0 = controller.gains.stiffness;
    const double least = std::min({K_0[0], K_0[1], K_0[2]});
    if (controller.type == Controls::energy_tank && controller.gains.stiffness_amplitude > least)
        slips.push_back("controller.stiffness_amplitude is " + shortest(controller.gains.stiffness_amplitude) +
                        " N/m, more than the stiffness of " + shortest(least) +
                        " N/m about which it varies: the spring will push outwards");
}

// ---- the reserve of energy (8.8)

// What a law with a reserve holds: its spring along the axes, and the mass that the tip shows there.
struct Spring {
    double stiffness, damping, mass;  // N/m, N s/m, kg
    Vec3<double> axis;
};

std::vector<Spring> springs_of(const Controller<double>& controller, const Pose<double>& p) {
    const Gains<double>& g = controller.gains;
    const auto spring = [&](double stiffness, double damping, const Vec3<double>& axis) {
        return Spring{stiffness, damping, effective_mass(controller.model, p, axis), axis};
    };
    if (controller.type == Controls::virtual_wall) return {spring(g.stiffness[0], g.damping[0], g.plane_normal)};
    return {spring(g.stiffness[0], g.damping[0], {1, 0, 0}), spring(g.stiffness[1], g.damping[1], {0, 1, 0}),
            spring(g.stiffness[2], g.damping[2], {0, 0, 1})};
}

// A torque that comes late by T (1/2 + d) on average makes a spring K give out what a damping of K T (1/2 + d) takes.
void slips_of_held_spring(const Setup& setup, const Spring& spring, Slips& slips) {
    const Sampling<double>& sampling = setup.digital.sampling;
    const double lag = sampling.period * (0.5 + sampling.delay), reach = sampling.period * (1 + sampling.delay);
    const std::string held = "controller.stiffness is " + shortest(spring.stiffness) + " N/m";
    if (setup.law().type == Controls::energy_tank && spring.stiffness * lag > spring.damping)
        slips.push_back(held + ", and torques that act " + rounded(lag) +
                        " s late on average make such a spring give out more energy than controller.damping takes: "
                        "the tank pays until it is empty, and then a brake works all the time; keep the stiffness "
                        "below " +
                        rounded(spring.damping / lag) + " N/m, or raise sampling.rate");
    const double turn = reach * std::sqrt(spring.stiffness / spring.mass);
    if (turn > largest_foreseen_turn)
        slips.push_back(held + ": its oscillation turns by " + rounded(turn) +
                        " rad until a torque has acted, and beyond " + rounded(largest_foreseen_turn) +
                        " rad the controller cannot foresee how much energy it gives out: it may create energy; "
                        "raise sampling.rate or lower sampling.delay");
}

// How far the spring may be pressed until an actuator gives less than it asks for, m.
double pressed_at_limit(const Setup& setup, const Spring& spring) {
    const Pose<double> p = pose(setup.q);
    const Vec3<double> weight = gravity_torque(setup.law().model, p);
    const Vec3<double> per_newton = tip_force_torque(setup.law().model, p, spring.axis);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i)
        if (per_newton[i] != 0)
            least = std::min(least, (setup.plant.arm.torque_limit[i] - std::abs(weight[i])) / std::abs(per_newton[i]));
    return std::max(0.0, least) / spring.stiffness;
}

// What the controller cannot count exactly or foresee.
void slips_of_counting(const Setup& setup, const std::string& law, Slips& slips) {
    const Sampling<double>& sampling = setup.digital.sampling;
    const Sensors<double>& sensors = setup.digital.sensors;
    if (sensors.has_encoder || sensors.velocity != VelocityEstimate::exact)
        slips.push_back(
            law + " counts its energy by what sensors.encoder and sensors.velocity tell" +
            (sensors.has_encoder ? ", here in steps of " + rounded(sensors.encoder_step) + " rad" : std::string()) +
            ": it never creates energy only as far as they are exact");
    if (sampling.delay != std::floor(sampling.delay))
        slips.push_back("sampling.delay is " + shortest(sampling.delay) +
                        " samples, and two torques act within each period of " + rounded(sampling.period) +
                        " s: " + law +
                        " counts its energy to the third order of the period only; "
                        "whole delays are counted exactly");
    if (setup.law().type != Controls::virtual_wall) return;
    const Gains<double>& g = setup.law().gains;
    const double depth = dot(g.plane_normal, minus(g.plane_point, tip_position(setup.law().model, pose(setup.q))));
    if (depth > 0 && sampling.delay > 0)
        slips.push_back(
            "the tip starts " + rounded(depth) + " m inside the virtual wall, and the first torque acts there for " +
            rounded(1 + sampling.delay) + " periods: it may create energy that is taken back later; start outside");
    const TipLoad<double>& load = setup.plant.load;
    if (!load.on) return;
    const double size = std::sqrt(dot(load.force, load.force)), reach = sampling.period * (1 + sampling.delay);
    if (size == 0) return;
    const Vec3<double> along(load.force[0] / size, load.force[1] / size, load.force[2] / size);
    const double mass = effective_mass(setup.law().model, pose(setup.q), along);
    slips.push_back("push.force moves the tip by " + rounded(0.5 * reach * reach * size / mass) +
                    " m until a torque has acted, which the controller does not foresee: it takes the energy that it "
                    "creates meanwhile back at the next samples");
}

void slips_of_reserve(const Setup& setup, Slips& slips) {
    const Controller<double>& controller = setup.law();
    if (!keeps_reserve(controller)) return;
    const std::string law = "controller.type " + word_of(controller.type);
    double pressed = std::numeric_limits<double>::infinity();
    for (const Spring& spring : springs_of(controller, pose(setup.q))) {
        if (setup.digital.sampling.on) slips_of_held_spring(setup, spring, slips);
        if (spring.stiffness > 0) pressed = std::min(pressed, pressed_at_limit(setup, spring));
    }
    if (setup.plant.arm.has_torque_limit)
        slips.push_back(
            law + " never creates energy as long as no torque is at arm.torque_limit, which a spring pressed by " +
            rounded(pressed) + " m reaches at the start");
    if (setup.digital.sampling.on) slips_of_counting(setup, law, slips);
}

void slips_of_push(const Setup& setup, Slips& slips) {
    if (!setup.plant.load.on) return;
    const Vec3<double>& force = setup.plant.load.force;
    if (force[0] == 0 && force[1] == 0 && force[2] == 0) slips.push_back("push.force is [0, 0, 0]: nothing pushes");
    if (setup.plant.load.start > setup.stop)
        slips.push_back("push.start is " + shortest(setup.plant.load.start) + " s, and the run ends at " +
                        shortest(setup.stop) + " s");
}

}  // namespace

void add_controller_slips(const Setup& setup, Slips& slips) {
    slips_of_contact(setup, slips);
    slip_of_raibert_craig(setup, slips);
    slip_of_slow_samples(setup, slips);
    slip_of_observer(setup, slips);
    slips_of_reference(setup, slips);
    slips_of_pressing(setup, slips);
    slips_of_tank(setup, slips);
    slips_of_reserve(setup, slips);
    slips_of_push(setup, slips);
}

}  // namespace arm3r
