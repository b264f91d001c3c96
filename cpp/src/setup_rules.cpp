// The rules between the keys of a scenario that concern the arm, the wall and the start as they come out of it.

#include <cmath>
#include <numbers>

#include "at.hpp"
#include "numbers.hpp"
#include "setup.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;
constexpr double deepest_start = 0.1;      // m
constexpr double smallest_inertia = 1e-9;  // kg m^2

std::string degrees(double angle) { return shortest(std::round(angle * 180 / pi * 100) / 100) + " deg"; }

std::string at_pose(const WorstPose& pose) {
    return "at q2 = " + degrees(pose.q2) + ", q3 = " + degrees(pose.q3) + ", any q1";
}

void check_mass_matrix(const Arm<double>& arm, Findings& findings) {
    const WorstPose M11 = smallest_M11(arm.lumped);
    if (M11.value < smallest_inertia)
        findings.add([&] {
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
    const WorstPose lower = smallest_lower_determinant(arm.lumped);
    if (lower.value <= 0)
        findings.add([&] {
            return Problem{.code = "scenario.singular_mass_matrix",
                           .path = "arm.link3.inertia",
                           .message = "the mass matrix is singular: the determinant of joints 2 and 3 falls to " +
                                      shortest(lower.value) + " " + at_pose(lower),
                           .got = "",
                           .allowed = "determinant > 0",
                           .hint = "give arm.link3.inertia, or armature for joints 2 and 3"};
        });
}

void check_start(const Setup& setup, Findings& findings) {
    const Plant<double>& plant = setup.plant;
    const Pose<double> p = pose(setup.q);
    const Indentation<double> in = tip_indentation(plant, wall_at(plant.wall, 0.0), p, setup.qd);
    if (in.depth > deepest_start && inside_outline(plant.wall, in) >= 0)
        findings.add([&] {
            return Problem{.code = "scenario.starts_inside_wall",
                           .path = "wall.point",
                           .message = "the tip starts deep inside the wall",
                           .got = shortest(in.depth) + " m deep",
                           .allowed = "at most 0.1 m",
                           .hint = "move wall.point back or change initial.q; does wall.normal point towards the arm?"};
        });
}

void check_normal(std::span<const double> params, Findings& findings) {
    const Vec3<double> normal = vector_at<"wall.normal">(params);
    if (sqrt(dot(normal, normal)) < 1e-9)
        findings.add([] {
            return Problem{.code = "scenario.range",
                           .path = "wall.normal",
                           .message = "a direction needs a length",
                           .got = "[0, 0, 0]",
                           .allowed = "any vector that is not zero",
                           .hint = ""};
        });
}

void check_law(std::span<const double> params, Findings& findings) {
    if (is<"wall.contact.law", "diagonal">(params) && at<"wall.acts_on_arm">(params) != 0)
        findings.add([] {
            return Problem{.code = "scenario.one_way_only",
                           .path = "wall.acts_on_arm",
                           .message = "a diagonal K_E can only be measured, not act on the arm",
                           .got = "true",
                           .allowed = "false with law: diagonal",
                           .hint = "use law: spring"};
        });
}

// A power series cannot pass the corner at which a changing torque meets its limit.
void check_corners(const Setup& setup, Findings& findings) {
    if (setup.solver.method == Solver::taylor && setup.plant.arm.has_torque_limit &&
        setup.plant.controller.type == Controls::gravity_compensation)
        findings.add([] {
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

// Its recurrences are those of the closed form.
void check_algorithm(const Setup& setup, Findings& findings) {
    const Controller<double>& controller = setup.plant.controller;
    if (setup.solver.method == Solver::taylor && controller.type == Controls::gravity_compensation &&
        controller.algorithm == Algorithm::recursion)
        findings.add([] {
            return Problem{.code = "scenario.no_series",
                           .path = "controller.algorithm",
                           .message = "taylor has no series of the Newton-Euler recursion",
                           .got = "recursion",
                           .allowed = "closed_form with solver.method: taylor",
                           .hint = "use algorithm: closed_form, or method: dopri5"};
        });
}

}  // namespace

WorstPose smallest_M11(const Lumped<double>& l) {  // (3.10)
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

WorstPose smallest_lower_determinant(const Lumped<double>& l) {  // (3.10)
    const double coupling = std::abs(l.B) + l.J3;
    return {(l.B2 + l.J3) * (l.B3 + l.J3) - coupling * coupling, 0, l.B > 0 ? pi : 0};
}

void check_setup(std::span<const double> params, Findings& findings) {
    check_normal(params, findings);
    if (at<"wall">(params) != 0) check_law(params, findings);
    if (!findings.none()) return;
    const Setup setup = make_setup(params);
    check_corners(setup, findings);
    check_algorithm(setup, findings);
    check_mass_matrix(setup.plant.arm, findings);
    if (findings.none() && setup.plant.has_wall) check_start(setup, findings);
}

}  // namespace arm3r
