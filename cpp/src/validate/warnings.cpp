// Warnings of what is allowed but probably a mistake.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "base/number_text.hpp"
#include "schema/param_access.hpp"
#include "setup/make_controller.hpp"
#include "setup/setup.hpp"
#include "setup/time_instants.hpp"
#include "validate/fixed_step.hpp"
#include "validate/warnings.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;

double norm(const Vec3<double>& v) { return std::sqrt(dot(v, v)); }

template <class V>
std::string vector_text(const V& v, int digits = 17) {
    const auto number = [&](double x) { return digits < 17 ? rounded(x + 0.0, digits) : shortest(x + 0.0); };
    return "[" + number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + "]";
}

bool uses_gravity(const Controller<double>& controller) {
    return has_model(controller.type) &&
           (controller.type != ControllerType::joint_pd || controller.compensates_gravity);
}

// The plant's gravity and the compensated one differ by so little that a typing error is likely.
bool is_nearly_equal(const Vec3<double>& feels, const Vec3<double>& compensates) {
    const double distance = norm(minus(feels, compensates));
    return distance > 0 && distance < 0.01 * norm(feels);
}

// A law that compensates the weight and nothing else may be meant to compensate a part of it.
bool is_part_of(const Vec3<double>& given, const Vec3<double>& needed, ControllerType law) {
    const double square = dot(needed, needed), share = square > 0 ? dot(given, needed) / square : 0;
    const bool is_along = norm(minus(given, scaled(share, needed))) <= 1e-9 * norm(needed);
    return law == ControllerType::gravity_compensation && is_along && share >= 0 && share <= 1;
}

void warn_of_gravity(const Setup& setup, std::vector<std::string>& warnings) {
    const Controller<double>& controller = setup.controller();
    const Vec3<double>&feels = setup.plant.arm.gravity, &compensates = controller.model.gravity;
    if (uses_gravity(controller) && is_nearly_equal(feels, compensates))
        warnings.push_back("the plant feels g = " + shortest(norm(feels)) + " m/s^2 and the controller compensates " +
                           shortest(norm(compensates)) +
                           ": less than 1 % apart but not equal, so the arm will drift; is this a typing mistake?");
}

void warn_of_angles(const Setup& setup, std::vector<std::string>& warnings) {
    const Vec3<double> q = setup.convention.from_slide(setup.q);
    for (int i = 0; i < 3; ++i) {
        const double angle = q[i], in_degrees = angle * 180 / pi;
        const bool was_degrees = std::abs(in_degrees - std::round(in_degrees)) < 1e-9 * std::abs(in_degrees);
        if (std::abs(angle) > 2 * pi && !was_degrees)
            warnings.push_back("initial.q[" + std::to_string(i) + "] is more than a full turn, " + shortest(angle) +
                               " rad; plain numbers are radians: write `" + shortest(angle) +
                               " deg` if degrees were meant");
    }
}

void warn_of_links(const Arm<double>& arm, std::vector<std::string>& warnings) {
    if (arm.is_elbow) return;  // its links are bodies of any shape
    const Link<double>* links[] = {&arm.link2, &arm.link3};
    for (int i = 0; i < 2; ++i) {
        if (links[i]->com < 0 || links[i]->com > links[i]->length)
            warnings.push_back("the centre of mass of link " + std::to_string(i + 2) + " lies outside the link, at " +
                               shortest(links[i]->com) + " m of " + shortest(links[i]->length) + " m");
    }
}

// The largest principal inertia less the sum of the other two, kg m^2, by the eigenvalues of the tensor.
double triangle_excess(const RigidBody<double>& body) {
    Mat3<double> tensor;
    for (int i = 0; i < 3; ++i) tensor(i, i) = body.inertia[i];
    tensor(0, 1) = tensor(1, 0) = body.products[0];
    tensor(0, 2) = tensor(2, 0) = body.products[1];
    tensor(1, 2) = tensor(2, 1) = body.products[2];
    const Vec3<double> principal =
        Eigen::SelfAdjointEigenSolver<Mat3<double>>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
    return principal[2] - principal[1] - principal[0];
}

// Published robots have such tensors, so they are no error.
void warn_of_tensors(const Arm<double>& arm, std::vector<std::string>& warnings) {
    if (!arm.is_elbow) return;
    for (std::size_t i = 0; i < 3; ++i) {
        const RigidBody<double>& body = arm.elbow.links[i];
        const double size = std::max({body.inertia[0], body.inertia[1], body.inertia[2]});
        const bool is_axial = i == 0 && body.inertia[0] == 0 && body.inertia[1] == 0;  // link 1 needs no more
        if (!is_axial && triangle_excess(body) > 1e-9 * size)
            warnings.push_back("arm.link" + std::to_string(i + 1) +
                               ".inertia is not that of a body: its largest principal inertia exceeds the sum of the "
                               "other two by " +
                               rounded(triangle_excess(body), 4) + " kg m^2");
    }
}

// Wrong powers of ten in the units show in the proportions of a link.
void warn_of_units(const Arm<double>& arm, std::vector<std::string>& warnings) {
    constexpr double a_long_link = 50;  // m
    const Link<double>* links[] = {&arm.link2, &arm.link3};
    for (int i = 0; i < 2; ++i) {
        const Link<double>& link = *links[i];
        const std::string name = "arm.link" + std::to_string(i + 2);
        const bool has_tip = arm.is_elbow && i == 1;
        const double largest = std::max({link.inertia[0], link.inertia[1], link.inertia[2]});
        const double whole_mass_at_the_end = link.mass * link.length * link.length;
        if (link.length > a_long_link)
            warnings.push_back(name + (has_tip ? ".tip is " : ".length is ") + shortest(link.length) +
                               (has_tip ? " m from joint 3" : " m") + "; was it given in millimetres?");
        if (!arm.is_elbow && largest > whole_mass_at_the_end)  // an elbow arm's bodies may be wider than their links
            warnings.push_back(name + ".inertia has " + shortest(largest) +
                               " kg m^2, more than mass*length^2 = " + shortest(whole_mass_at_the_end) +
                               ": no body within the link has as much; was it given in g cm^2 (1e-7 kg m^2)?");
    }
}

// The largest distance of joint 2 behind the wall's plane during the run, m; < 0 if it is never behind it.
double max_shoulder_depth(const Setup& setup) {
    const Wall<double>& wall = setup.plant.wall;
    const Vec3<double> shoulder = base_position(setup.plant.arm);
    double deepest = -infinite;
    const auto look = [&](double t) {
        const Indentation<double> in = indentation(wall, wall_at(wall, t), shoulder, {0, 0, 0});
        if (inside_outline(wall, in) >= 0) deepest = std::max(deepest, in.depth);
    };
    constexpr int samples = 1000;
    for (int i = 0; i <= samples; ++i) look(setup.start + (setup.stop - setup.start) * i / samples);
    return deepest;
}

// A fixed step keeps its order only if a jump lies on its grid (5.8).
void warn_of_jump(const Setup& setup, std::vector<std::string>& warnings) {
    if (!setup.solver.is_on_grid()) return;
    const double step = setup.solver.step;
    for (double t = next_jump(setup, setup.start); t < setup.stop; t = next_jump(setup, t)) {
        if (t == setup.start + nearest_integer((t - setup.start) / step) * step) continue;
        warnings.push_back(
            "a push, the reference or the wall's table jumps at t = " + rounded(t, 15) +
            " s, within a step of rk4, which is of first order there; take a solver.step that reaches this "
            "instant in whole steps, solver.events: located, or method: dopri5");
        return;
    }
}

void warn_of_wall(const Setup& setup, std::vector<std::string>& warnings) {
    if (!setup.plant.has_wall) return;
    const double past = max_shoulder_depth(setup);
    if (past > 0)
        warnings.push_back("the wall passes the shoulder during the run, by " + shortest(past) +
                           " m at the most; the arm's base is then behind it");
}

}  // namespace

std::optional<std::string> compensation_warning(const Setup& setup, bool by_default) {
    const Controller<double>& controller = setup.controller();
    const Vec3<double>&feels = setup.plant.arm.gravity, &compensates = controller.model.gravity;
    if (!uses_gravity(controller)) return {};
    const bool differ = norm(minus(feels, compensates)) > 0 && !is_nearly_equal(feels, compensates);
    if (differ && by_default)
        return "the plant feels the gravity " + vector_text(feels) + " m/s^2 and the controller compensates " +
               vector_text(compensates) +
               " m/s^2, the default of controller.gravity; write controller.gravity: " + vector_text(feels) +
               ", or the value that its model must have";
    const auto out = [&](const Vec3<double>& tau) { return setup.convention.flipped(tau); };
    const Pose<double> start = pose(setup.q);
    const Vec3<double> needed = gravity_torque(setup.plant.arm, start), given = gravity_torque(controller.model, start);
    if (norm(compensates) == 0 || is_part_of(given, needed, controller.type)) return {};
    constexpr double a_study = 0.25;  // a model that is off by less is likely to be meant
    if (norm(minus(given, needed)) <= (differ ? 0.01 : a_study) * norm(needed)) return {};
    return "at its start the weight of the arm takes torques of " + vector_text(out(needed), 6) +
           " N m to hold, and the controller compensates " + vector_text(out(given), 6) + " N m, " +
           (differ
                ? "by a gravity of " + vector_text(compensates) + " m/s^2 where the plant feels " + vector_text(feels)
                : std::string("by a controller.model that is not the arm"));
}

std::optional<std::string> known_cause(const Setup& setup) {
    std::vector<std::string> causes = unstable_loops(setup);
    warn_of_fixed_step(setup, causes);
    if (causes.empty()) return {};
    return std::move(causes.front());
}

std::vector<std::string> scenario_warnings(const Setup& setup) {
    std::vector<std::string> warnings;
    warn_of_gravity(setup, warnings);
    warn_of_angles(setup, warnings);
    warn_of_links(setup.plant.arm, warnings);
    warn_of_units(setup.plant.arm, warnings);
    warn_of_tensors(setup.plant.arm, warnings);
    warn_of_wall(setup, warnings);
    warn_of_jump(setup, warnings);
    warn_of_fixed_step(setup, warnings);
    add_controller_warnings(setup, warnings);
    return warnings;
}

}  // namespace arm3r
