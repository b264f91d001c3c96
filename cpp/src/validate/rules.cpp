// The rules between the keys of a scenario that concern the arm, the wall and the start as they come out of it.

#include <cmath>
#include <numbers>
#include <optional>

#include "base/number_text.hpp"
#include "schema/param_access.hpp"
#include "setup/setup.hpp"
#include "validate/rules.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;
constexpr double max_start_depth = 0.1;  // m
constexpr double min_period = 1e-14;     // of time.start: 45 to 90 units in its last place

std::string degrees(double angle) { return shortest(std::round(angle * 180 / pi * 100) / 100) + " deg"; }

std::string at_pose(const WorstPose& pose) {
    return "at q2 = " + degrees(pose.q2) + ", q3 = " + degrees(pose.q3) + ", any q1";
}

void check_pivots(const LeastPivots& least, ProblemList& problem_list) {
    if (!(least.lower.value > 1e-12))
        problem_list.add([&] {
            return Problem{.code = "scenario.singular_mass_matrix",
                           .path = "arm.link3.inertia",
                           .message = "the mass matrix is singular: the determinant of joints 2 and 3 falls to " +
                                      shortest(least.lower.value) + " of the product of its diagonal " +
                                      at_pose(least.lower),
                           .allowed = "a positive definite mass matrix",
                           .hint = "give arm.link3.inertia, or armature for joints 2 and 3"};
        });
    else if (!(least.first.value >= min_inertia))
        problem_list.add([&] {
            return Problem{.code = "scenario.singular_mass_matrix",
                           .path = "arm.link1.inertia",
                           .message = "the mass matrix is nearly singular: the inertia of joint 1 falls to " +
                                      shortest(least.first.value) + " kg m^2 " + at_pose(least.first),
                           .allowed = "at least 1e-9 kg m^2",
                           .hint =
                               "give arm.link1.inertia or arm.armature[0]; slender links have no inertia about "
                               "their own axis"};
        });
}

void check_mass_matrix(const Arm<double>& arm, ProblemList& problem_list) {
    if (arm.is_elbow && arm.elbow.is_far_from_singular) return;
    if (arm.is_elbow) return check_pivots(least_pivots(arm), problem_list);
    const WorstPose M11 = min_M11(arm.lumped);
    if (M11.value < min_inertia)
        problem_list.add([&] {
            return Problem{
                .code = "scenario.singular_mass_matrix",
                .path = "arm.link1.inertia_axial",
                .message = "the mass matrix is nearly singular: M11 falls to " + shortest(M11.value) + " kg m^2 " +
                           at_pose(M11),
                .got = shortest(arm.link1.inertia_axial),
                .allowed = "min M11 >= 1e-9 kg m^2",
                .hint =
                    "give arm.link1.inertia_axial or arm.armature[0]; slender links have no inertia about their own axis"};
        });
    const WorstPose lower = min_lower_determinant(arm.lumped);
    if (lower.value <= 0)
        problem_list.add([&] {
            return Problem{.code = "scenario.singular_mass_matrix",
                           .path = "arm.link3.inertia",
                           .message = "the mass matrix is singular: the determinant of joints 2 and 3 falls to " +
                                      shortest(lower.value) + " " + at_pose(lower),
                           .allowed = "determinant > 0",
                           .hint = "give arm.link3.inertia, or armature for joints 2 and 3"};
        });
}

void check_start(const Setup& setup, ProblemList& problem_list) {
    const Plant<double>& plant = setup.plant;
    const Pose<double> p = pose(setup.q);
    const Indentation<double> in = tip_indentation(plant, wall_at(plant.wall, setup.start), p, setup.qd);
    if (in.depth > max_start_depth && inside_outline(plant.wall, in) >= 0)
        problem_list.add([&] {
            return Problem{.code = "scenario.starts_inside_wall",
                           .path = "wall.point",
                           .message = "the tip starts deep inside the wall",
                           .got = shortest(in.depth) + " m deep",
                           .allowed = "at most 0.1 m",
                           .hint = "move wall.point back or change initial.q; does wall.normal point towards the arm?"};
        });
}

void check_time(std::span<const double> params, ProblemList& problem_list) {
    const double start = at<"time.start">(params), stop = at<"time.stop">(params);
    if (stop < start)
        problem_list.add([&] {
            return Problem{.code = "scenario.range",
                           .path = "time.stop",
                           .message = "the run ends before it starts",
                           .got = shortest(stop),
                           .allowed = "at least time.start = " + shortest(start),
                           .hint = "time.stop is an instant, not a duration"};
        });
}

// A period that is added to an instant must be longer than the spacing of the doubles near it.
void check_spacing(const char* path, double period, double start, ProblemList& problem_list) {
    const double least = min_period * std::abs(start);
    if (period < least)
        problem_list.add([&] {
            return Problem{.code = "scenario.clock",
                           .path = path,
                           .message = "time.start is too late for so short a period",
                           .got = shortest(period) + " s",
                           .allowed = "at least 1e-14 |time.start| = " + shortest(least) + " s",
                           .hint = "move the scenario towards t = 0, with all instants and phases in it"};
        });
}

void check_clock(const Setup& setup, ProblemList& problem_list) {
    check_spacing("time.log_every", setup.log_every, setup.start, problem_list);
    if (setup.solver.method == SolverMethod::rk4)
        check_spacing("solver.step", setup.solver.step, setup.start, problem_list);
    if (setup.digital.sampling.on)
        check_spacing("sampling.rate", setup.digital.sampling.period, setup.start, problem_list);
}

// A damped law takes one number that says how much it damps, or a restitution to find it from.
void check_damping(const std::string& name, double given, bool has_restitution, ProblemList& problem_list) {
    if (std::isnan(given) != has_restitution)
        problem_list.add([&] {
            return Problem{.code = has_restitution ? "scenario.conflict" : "scenario.missing_key",
                           .path = "wall.contact." + name,
                           .message = has_restitution ? "restitution says already how much the contact damps"
                                                      : "this law damps, but nothing says how much",
                           .got = has_restitution ? shortest(given) : "",
                           .allowed = "either " + name + " or restitution",
                           .hint = has_restitution ? "take one of the two out" : "give one of the two"};
        });
}

void check_law(std::span<const double> params, ProblemList& problem_list) {
    const bool has_restitution = !std::isnan(at<"wall.contact.restitution">(params));
    if (is<"wall.contact.law", "kelvin_voigt">(params))
        check_damping("damping", at<"wall.contact.damping">(params), has_restitution, problem_list);
    if (!is<"wall.contact.law", "hunt_crossley">(params)) return;
    check_damping("dissipation", at<"wall.contact.dissipation">(params), has_restitution, problem_list);
    const bool has_speed = !std::isnan(at<"wall.contact.impact_speed">(params));
    if (has_speed != has_restitution)
        problem_list.add([&] {
            return Problem{.code = has_speed ? "scenario.conflict" : "scenario.missing_key",
                           .path = "wall.contact.impact_speed",
                           .message = has_speed ? "this is the speed of a restitution, and none is given"
                                                : "the restitution of hunt_crossley depends on the speed of the impact",
                           .allowed = "restitution and impact_speed together",
                           .hint = has_speed ? "give wall.contact.restitution, or take impact_speed out"
                                             : "give the speed at which the restitution is to hold"};
        });
}

// A Taylor series cannot pass the corner at which a changing torque reaches its limit.
void check_corners(const Setup& setup, ProblemList& problem_list) {
    if (setup.solver.method == SolverMethod::taylor && setup.plant.arm.has_torque_limit && !setup.digital.sampling.on &&
        setup.controller().type == ControllerType::gravity_compensation)
        problem_list.add([] {
            return Problem{.code = "scenario.corner",
                           .path = "solver.method",
                           .message =
                               "taylor needs a law without corners, and arm.torque_limit puts corners into "
                               "controller.type gravity_compensation",
                           .got = "taylor",
                           .allowed = "taylor with arm.torque_limit: [inf, inf, inf]",
                           .hint = "use method: dopri5"};
        });
}

// The recurrences are those of the closed form.
void check_algorithm(const Setup& setup, ProblemList& problem_list) {
    const Controller<double>& controller = setup.controller();
    if (setup.solver.method == SolverMethod::taylor && controller.type == ControllerType::gravity_compensation &&
        controller.algorithm == Algorithm::recursion && !setup.digital.sampling.on)
        problem_list.add([] {
            return Problem{.code = "scenario.no_series",
                           .path = "controller.algorithm",
                           .message = "taylor has no series of the Newton-Euler recursion",
                           .got = "recursion",
                           .allowed = "closed_form with solver.method: taylor",
                           .hint = "use algorithm: closed_form, or method: dopri5"};
        });
}

// The reason why there is no Taylor series for a wall: the recurrences are those of a wall that moves evenly or as a
// sinusoid, and of a spring.
struct NoSeries {
    const char *path, *of, *allowed;
};

std::optional<NoSeries> without_series(const Plant<double>& plant) {
    const Wall<double>& wall = plant.wall;
    if (wall.motion == Motion::ramp || wall.motion == Motion::table)
        return NoSeries{"wall.motion.type", "this motion", "fixed, constant or sinusoid with solver.method: taylor"};
    if (wall.rotation != Rotation::none)
        return NoSeries{"wall.rotation.type", "a wall that turns", "none with solver.method: taylor"};
    if (is_damped(plant.contact.law))
        return NoSeries{"wall.contact.law", "a damped contact", "spring or diagonal with solver.method: taylor"};
    if (plant.acts_on_arm && acts_along_plate(plant.contact.law))
        return NoSeries{"wall.contact.law", "springs along the plate", "spring where the wall acts on the arm"};
    if (plant.acts_on_arm && plant.contact.has_friction)
        return NoSeries{"wall.contact.friction.coefficient", "friction on the wall",
                        "0 where the wall acts on the arm"};
    return std::nullopt;
}

void check_series(const Setup& setup, ProblemList& problem_list) {
    if (setup.solver.method != SolverMethod::taylor) return;
    const Plant<double>& plant = setup.plant;
    if (plant.arm.elbow.has_skew_rotors || plant.controller.model.elbow.has_skew_rotors)
        return problem_list.add([] {
            return Problem{.code = "scenario.no_series",
                           .path = "solver.method",
                           .message = "taylor has no series of rotors that spin across their joints",
                           .got = "taylor",
                           .allowed = "rotor axes along the joints with solver.method: taylor",
                           .hint = "use method: dopri5"};
        });
    if (!setup.plant.has_wall) return;
    if (const std::optional<NoSeries> reason = without_series(setup.plant))
        problem_list.add([&] {
            return Problem{.code = "scenario.no_series",
                           .path = reason->path,
                           .message = std::string("taylor has no series of ") + reason->of,
                           .allowed = reason->allowed,
                           .hint = "use method: dopri5"};
        });
}

void check_motion_table(std::span<const double> params, ProblemList& problem_list) {
    const bool is_derived = list_at<"wall.motion.v">(params).empty() && list_at<"wall.motion.a">(params).empty();
    if (is_derived)
        return check_table<"wall.motion.t", "wall.motion.s">(
            params, "give a position at every instant, or a file with both", problem_list);
    check_table<"wall.motion.t", "wall.motion.s", "wall.motion.v", "wall.motion.a">(
        params, "give position, velocity and acceleration at every instant, or the position alone", problem_list);
}

}  // namespace

Problem missing(const Key& key, std::size_t count, std::string hint) {
    return {.code = "scenario.missing_key",
            .path = key.path,
            .message = "this must be given",
            .allowed = (count == 1 ? "a number" : "a list of " + list_sizes(key) + " numbers") +
                       (key.unit.empty() ? "" : ", " + key.unit),
            .hint = std::move(hint)};
}

std::string distance_from_reach(const Arm<double>& arm, const Vec3<double>& tip, bool front) {
    if (arm.is_elbow) return shortest(reach_excess(arm, tip, front)) + " m out of reach";
    const Vec3<double> x = minus(tip, base_position(arm));
    return shortest(hypot2(hypot2(x[0], x[1]), x[2])) + " m from joint 2";
}

std::string reach_text(const Arm<double>& arm) {
    const double a2 = arm.link2.length, a3 = arm.link3.length;
    const std::string range = shortest(std::abs(a2 - a3)) + " to " + shortest(a2 + a3) + " m";
    return arm.is_elbow ? range + " from joint 2, outside the cylinder of radius " +
                              shortest(std::abs(arm.elbow.lateral)) + " m about axis 1"
                        : range;
}

const char* bend_text(const Arm<double>& arm) { return arm.is_elbow ? "the sine of the bend" : "sin(q3)"; }

const char* tip_at_axis_text(const Arm<double>& arm) {
    return arm.is_elbow ? "the tip is as close to the axis of joint 1 as its lateral offset lets it come"
                        : "the tip stands on the axis of joint 1";
}

WorstPose min_M11(const Lumped<double>& l) {  // (3.10)
    const double B = std::abs(l.B), toward = l.B > 0 ? -1 : 1;
    WorstPose worst{l.A1, pi / 2, 0};
    const auto consider = [&](double form, double C2, double C23) {
        if (l.A1 + form < worst.value) worst = {l.A1 + form, acos(C2), acos(C23) - acos(C2)};
    };
    consider(l.A2 + l.A3 - 2 * B, 1, toward);
    if (l.A3 > B) consider(l.A2 - B * B / l.A3, 1, toward * B / l.A3);
    if (l.A2 > B) consider(l.A3 - B * B / l.A2, toward * B / l.A2, 1);
    return worst;
}

WorstPose min_lower_determinant(const Lumped<double>& l) {  // (3.10)
    const double coupling = std::abs(l.B) + l.J3;
    return {(l.B2 + l.J3) * (l.B3 + l.J3) - coupling * coupling, 0, l.B > 0 ? pi : 0};
}

void check_setup(std::span<const double> params, std::optional<Setup>& setup, ProblemList& problem_list) {
    setup.reset();
    check_time(params, problem_list);
    check_direction<"wall.normal">(params, problem_list);
    check_direction<"wall.motion.direction">(params, problem_list);
    check_direction<"wall.rotation.axis">(params, problem_list);
    if (is<"wall.motion.type", "table">(params)) check_motion_table(params, problem_list);
    check_controller_keys(params, problem_list);
    check_sampling_keys(params, problem_list);
    if (at<"wall">(params) != 0) check_law(params, problem_list);
    if (!problem_list.empty()) return;
    setup.emplace(params);
    check_clock(*setup, problem_list);
    check_corners(*setup, problem_list);
    check_algorithm(*setup, problem_list);
    check_series(*setup, problem_list);
    check_controller(params, *setup, problem_list);
    check_sampling(params, *setup, problem_list);
    check_mass_matrix(setup->plant.arm, problem_list);
    if (problem_list.empty() && setup->plant.has_wall) check_start(*setup, problem_list);
    if (!problem_list.empty()) setup.reset();
}

void check_start_and_contact(std::span<const double> params, std::optional<Setup>& setup, ProblemList& problem_list) {
    if (setup->plant.has_wall) check_law(params, problem_list);
    if (problem_list.empty()) setup->set_start_and_contact(params);
    check_series(*setup, problem_list);
    if (problem_list.empty() && setup->plant.has_wall) check_start(*setup, problem_list);
    if (!problem_list.empty()) setup.reset();
}

}  // namespace arm3r
