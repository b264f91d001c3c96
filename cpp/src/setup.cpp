#include "setup.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "numbers.hpp"
#include "schema.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double deepest_start = 0.1;      // m
constexpr double smallest_inertia = 1e-9;  // kg m^2

Vec3<double> vector_of(std::span<const double> params, std::string_view path) {
    return {param(params, path, 0), param(params, path, 1), param(params, path, 2)};
}

// One number x stands for (x along `axis`), three for themselves.
Vec3<double> vector_along(std::span<const double> params, std::string_view path, const Vec3<double>& axis) {
    const Vec3<double> given = vector_of(params, path);
    return std::isnan(given[1]) ? Vec3<double>(given[0] * axis[0], given[0] * axis[1], given[0] * axis[2]) : given;
}

double given_or(double given, double otherwise) { return std::isnan(given) ? otherwise : given; }

// What a shape says of mass and inertia, with `mass` in place of density*volume where it is given.
struct Solid {
    double mass;
    Vec3<double> inertia;  // x along the length
};

Solid solid_of(std::span<const double> params, const std::string& link, double length) {
    const std::string& shape = choice_of(params, link + ".shape");
    const double given = param(params, link + ".mass");
    if (shape == "brick") {
        const double h = param(params, link + ".section", 0), w = param(params, link + ".section", 1);
        const double m = given_or(given, param(params, link + ".density") * length * h * w);
        return {m, {m * (w * w + h * h) / 12, m * (length * length + w * w) / 12, m * (length * length + h * h) / 12}};
    }
    if (shape == "cylinder") {
        const double R = param(params, link + ".radius");
        const double m = given_or(given, param(params, link + ".density") * length * pi * R * R);
        const double across = m * (3 * R * R + length * length) / 12;
        return {m, {m * R * R / 2, across, across}};
    }
    const double across = given * length * length / 12;  // slender
    return {given, {0, across, across}};
}

Turret<double> turret_of(std::span<const double> params) {
    const std::string link = "arm.link1";
    if (choice_of(params, link + ".shape") == "explicit")
        return {param(params, link + ".mass"), param(params, link + ".com"), param(params, link + ".inertia_axial")};
    const double length = param(params, link + ".length");
    const Solid solid = solid_of(params, link, length);
    return {solid.mass, given_or(param(params, link + ".com"), length / 2),
            given_or(param(params, link + ".inertia_axial"), solid.inertia[0])};
}

Link<double> link_of(std::span<const double> params, const std::string& link) {
    const double length = param(params, link + ".length");
    const Solid solid = solid_of(params, link, length);
    const Vec3<double> given = vector_of(params, link + ".inertia");
    return {length, solid.mass, given_or(param(params, link + ".com"), length / 2),
            std::isnan(given[0]) ? solid.inertia : given};
}

bool any_above_zero(const Vec3<double>& v) { return v[0] > 0 || v[1] > 0 || v[2] > 0; }

void finish(Arm<double>& arm) {
    arm.lumped = lump(arm);
    arm.gravity_is_vertical = arm.gravity[0] == 0 && arm.gravity[1] == 0;
    arm.has_damping = any_above_zero(arm.damping);
    arm.has_dry_friction = any_above_zero(arm.friction);
    arm.has_torque_limit =
        std::isfinite(arm.torque_limit[0]) || std::isfinite(arm.torque_limit[1]) || std::isfinite(arm.torque_limit[2]);
}

bool is_simscape(std::span<const double> params) { return choice_of(params, "arm.convention") == "simscape"; }

Vec3<double> to_slide(std::span<const double> params, const Vec3<double>& joint_vector) {
    return is_simscape(params) ? flipped(joint_vector) : joint_vector;
}

Controller<double> make_controller(std::span<const double> params) {
    Controller<double> controller{};
    const std::string& type = choice_of(params, "controller.type");
    controller.type = type == "none"       ? Controls::none
                      : type == "constant" ? Controls::constant
                                           : Controls::gravity_compensation;
    controller.algorithm =
        choice_of(params, "controller.algorithm") == "closed_form" ? Algorithm::closed_form : Algorithm::recursion;
    controller.model = make_arm(with_model(params));
    if (controller.type == Controls::constant)
        controller.torque = to_slide(params, vector_of(params, "controller.torque"));
    if (controller.type == Controls::gravity_compensation) {
        controller.model.gravity = vector_along(params, "controller.gravity", {0, 0, -1});
        finish(controller.model);
    }
    return controller;
}

Wall<double> make_wall(std::span<const double> params) {
    Wall<double> wall{};
    wall.point = vector_of(params, "wall.point");
    const Vec3<double> normal = vector_of(params, "wall.normal");
    const double length = std::sqrt(dot(normal, normal));
    wall.n = {normal[0] / length, normal[1] / length, normal[2] / length};
    const Vec3<double> sideways = cross(wall.n, Vec3<double>(0, 0, 1));
    const double level = std::sqrt(dot(sideways, sideways));
    if (level < 1e-12) wall.e1 = {0, 1, 0};  // (4.1)
    else wall.e1 = {sideways[0] / level, sideways[1] / level, sideways[2] / level};
    wall.e2 = cross(wall.e1, wall.n);
    wall.half1 = param(params, "wall.size", 0) / 2;
    wall.half2 = param(params, "wall.size", 1) / 2;
    wall.face_offset = param(params, "wall.face_offset");
    const std::string& motion = choice_of(params, "wall.motion.type");
    wall.motion = motion == "constant" ? Motion::constant : motion == "sinusoid" ? Motion::sinusoid : Motion::fixed;
    wall.velocity = {0, 0, 0};
    if (wall.motion == Motion::constant) wall.velocity = vector_along(params, "wall.motion.velocity", wall.n);
    if (wall.motion == Motion::sinusoid) {
        wall.amplitude = param(params, "wall.motion.amplitude");
        wall.frequency = param(params, "wall.motion.frequency");
        wall.phase = param(params, "wall.motion.phase");
    }
    return wall;
}

Contact<double> make_contact(std::span<const double> params) {
    const Vec3<double> k = vector_of(params, "wall.contact.stiffness");
    if (choice_of(params, "wall.contact.law") == "diagonal") return {Law::diagonal, k};
    return {Law::spring, {k[0], 0, 0}};
}

Solver make_solver(std::span<const double> params) {
    return {choice_of(params, "solver.method") == "dopri5" ? Solver::dopri5 : Solver::rk4,
            param(params, "solver.rtol"),
            param(params, "solver.atol"),
            given_or(param(params, "solver.max_step"), infinite),
            param(params, "solver.step"),
            param(params, "solver.max_steps")};
}

std::string degrees(double angle) { return shortest(std::round(angle * 180 / pi * 100) / 100) + " deg"; }

std::string at_pose(const WorstPose& pose) {
    return "at q2 = " + degrees(pose.q2) + ", q3 = " + degrees(pose.q3) + ", any q1";
}

void check_mass_matrix(const Arm<double>& arm, std::vector<Problem>& problems) {
    const WorstPose M11 = smallest_M11(arm.lumped);
    if (M11.value < smallest_inertia)
        problems.push_back(
            {.code = "scenario.singular_mass_matrix",
             .path = "arm.link1.inertia_axial",
             .message =
                 "the mass matrix is nearly singular: M11 falls to " + shortest(M11.value) + " kg m^2 " + at_pose(M11),
             .got = shortest(arm.link1.inertia_axial),
             .allowed = "min M11 >= 1e-9 kg m^2",
             .hint =
                 "give arm.link1.inertia_axial or arm.armature[0]; slender links have no inertia about their own axis"});
    const WorstPose lower = smallest_lower_determinant(arm.lumped);
    if (lower.value <= 0)
        problems.push_back({.code = "scenario.singular_mass_matrix",
                            .path = "arm.link3.inertia",
                            .message = "the mass matrix is singular: the determinant of joints 2 and 3 falls to " +
                                       shortest(lower.value) + " " + at_pose(lower),
                            .got = "",
                            .allowed = "determinant > 0",
                            .hint = "give arm.link3.inertia, or armature for joints 2 and 3"});
}

void check_start(const Setup& setup, std::vector<Problem>& problems) {
    const Plant<double>& plant = setup.plant;
    const Pose<double> p = pose(setup.q);
    const Indentation<double> in = tip_indentation(plant, wall_at(plant.wall, 0.0), p, setup.qd);
    if (in.depth > deepest_start && inside_outline(plant.wall, in) >= 0)
        problems.push_back(
            {.code = "scenario.starts_inside_wall",
             .path = "wall.point",
             .message = "the tip starts deep inside the wall",
             .got = shortest(in.depth) + " m deep",
             .allowed = "at most 0.1 m",
             .hint = "move wall.point back or change initial.q; does wall.normal point towards the arm?"});
}

double norm(const Vec3<double>& v) { return std::sqrt(dot(v, v)); }

void slip_of_gravity(const Setup& setup, std::vector<std::string>& slips) {
    if (setup.plant.controller.type != Controls::gravity_compensation) return;
    const Vec3<double>&feels = setup.plant.arm.gravity, &compensates = setup.plant.controller.model.gravity;
    const double apart = norm(minus(feels, compensates));
    if (apart > 0 && apart < 0.01 * norm(feels))
        slips.push_back("the plant feels g = " + shortest(norm(feels)) + " m/s^2 and the controller compensates " +
                        shortest(norm(compensates)) +
                        ": less than 1 % apart but not equal, so the arm will drift; a slip of typing?");
}

void slip_of_angles(std::span<const double> params, std::vector<std::string>& slips) {
    for (int i = 0; i < 3; ++i) {
        const double angle = param(params, "initial.q", i), in_degrees = angle * 180 / pi;
        const bool was_degrees = std::abs(in_degrees - std::round(in_degrees)) < 1e-9 * std::abs(in_degrees);
        if (std::abs(angle) > 2 * pi && !was_degrees)
            slips.push_back("initial.q[" + std::to_string(i) + "] is more than a full turn, " + shortest(angle) +
                            " rad; plain numbers are radians: write `" + shortest(angle) +
                            " deg` if degrees were meant");
    }
}

void slip_of_links(const Arm<double>& arm, std::vector<std::string>& slips) {
    const Link<double>* links[] = {&arm.link2, &arm.link3};
    for (int i = 0; i < 2; ++i) {
        if (links[i]->com < 0 || links[i]->com > links[i]->length)
            slips.push_back("the centre of mass of link " + std::to_string(i + 2) + " lies outside the link, at " +
                            shortest(links[i]->com) + " m of " + shortest(links[i]->length) + " m");
    }
}

// Units that are off by powers of ten show in the proportions of a link.
void slip_of_units(const Arm<double>& arm, std::vector<std::string>& slips) {
    constexpr double a_long_link = 50;  // m
    const Link<double>* links[] = {&arm.link2, &arm.link3};
    for (int i = 0; i < 2; ++i) {
        const Link<double>& link = *links[i];
        const std::string name = "arm.link" + std::to_string(i + 2);
        const double largest = std::max({link.inertia[0], link.inertia[1], link.inertia[2]});
        const double whole_mass_at_the_end = link.mass * link.length * link.length;
        if (link.length > a_long_link)
            slips.push_back(name + ".length is " + shortest(link.length) + " m; was it given in millimetres?");
        if (largest > whole_mass_at_the_end)
            slips.push_back(name + ".inertia has " + shortest(largest) +
                            " kg m^2, more than mass*length^2 = " + shortest(whole_mass_at_the_end) +
                            ": no body within the link has as much; was it given in g cm^2 (1e-7 kg m^2)?");
    }
}

// How far the wall's plane comes past joint 2 at the worst moment of the run, m; < 0 when it never does.
double past_shoulder(const Setup& setup) {
    const Wall<double>& wall = setup.plant.wall;
    const Vec3<double> shoulder(0, 0, setup.plant.arm.base_height);
    double deepest = -infinite;
    const auto look = [&](double t) {
        const Indentation<double> in = indentation(wall, wall_at(wall, t), shoulder, {0, 0, 0});
        if (inside_outline(wall, in) >= 0) deepest = std::max(deepest, in.depth);
    };
    constexpr int looks = 1000;
    for (int i = 0; i <= looks; ++i) look(setup.stop * i / looks);
    return deepest;
}

void slip_of_wall(const Setup& setup, std::vector<std::string>& slips) {
    if (!setup.plant.has_wall) return;
    const double past = past_shoulder(setup);
    if (past > 0)
        slips.push_back("the wall passes the shoulder during the run, by " + shortest(past) +
                        " m at the most; the arm's base is then behind it");
    if (setup.plant.acts_on_arm && setup.solver.method == Solver::rk4) {
        const double m_n = effective_mass(setup.plant.arm, pose(setup.q), setup.plant.wall.n);
        const double angle = setup.solver.step * std::sqrt(setup.plant.contact.stiffness[0] / m_n);
        if (angle > 1.414)
            slips.push_back(
                "step*sqrt(K_E/m_n) is " + shortest(angle) +
                ", more than half of what rk4 bears (2.828): the contact will not be resolved; take a smaller solver.step");
    }
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

std::vector<double> with_model(std::span<const double> params) {
    std::vector<double> merged(params.begin(), params.end());
    constexpr std::string_view prefix = "controller.model.";
    for (const Key& key : schema()) {
        if (!key.path.starts_with(prefix)) continue;
        const Key& plant_key = *find_key("arm." + key.path.substr(prefix.size()));
        for (std::size_t i = 0; i < key.size; ++i)
            merged[plant_key.offset + i] = given_or(params[key.offset + i], merged[plant_key.offset + i]);
    }
    return merged;
}

Arm<double> make_arm(std::span<const double> params) {
    Arm<double> arm;
    arm.base_height = param(params, "arm.base_height");
    arm.link1 = turret_of(params);
    arm.link2 = link_of(params, "arm.link2");
    arm.link3 = link_of(params, "arm.link3");
    arm.payload = param(params, "arm.payload.mass");
    arm.gravity = vector_of(params, "arm.gravity");
    arm.armature = vector_of(params, "arm.armature");
    arm.damping = vector_of(params, "arm.damping");
    arm.friction = vector_of(params, "arm.friction");
    arm.friction_velocity = param(params, "arm.friction_velocity");
    arm.torque_limit = vector_of(params, "arm.torque_limit");
    finish(arm);
    return arm;
}

Setup make_setup(std::span<const double> params) {
    Setup setup;
    setup.simscape = is_simscape(params);
    setup.plant.arm = make_arm(params);
    setup.plant.controller = make_controller(params);
    setup.plant.has_wall = param(params, "wall") != 0;
    setup.plant.wall = make_wall(params);
    setup.plant.contact = make_contact(params);
    setup.plant.acts_on_arm = setup.plant.has_wall && param(params, "wall.acts_on_arm") != 0;
    setup.q = to_slide(params, vector_of(params, "initial.q"));
    setup.qd = to_slide(params, vector_of(params, "initial.qd"));
    setup.solver = make_solver(params);
    setup.stop = param(params, "time.stop");
    setup.log_every = param(params, "time.log_every");
    return setup;
}

std::vector<Problem> check_setup(std::span<const double> params) {
    std::vector<Problem> problems;
    if (param(params, "wall") != 0) {
        if (norm(vector_of(params, "wall.normal")) < 1e-9)
            problems.push_back({.code = "scenario.range",
                                .path = "wall.normal",
                                .message = "a direction needs a length",
                                .got = "[0, 0, 0]",
                                .allowed = "any vector that is not zero",
                                .hint = ""});
        if (choice_of(params, "wall.contact.law") == "diagonal" && param(params, "wall.acts_on_arm") != 0)
            problems.push_back({.code = "scenario.one_way_only",
                                .path = "wall.acts_on_arm",
                                .message = "a diagonal K_E can only be measured, not act on the arm",
                                .got = "true",
                                .allowed = "false with law: diagonal",
                                .hint = "use law: spring"});
    }
    if (!problems.empty()) return problems;
    const Setup setup = make_setup(params);
    check_mass_matrix(setup.plant.arm, problems);
    if (problems.empty() && setup.plant.has_wall) check_start(setup, problems);
    return problems;
}

std::vector<std::string> likely_slips(std::span<const double> params) {
    const Setup setup = make_setup(params);
    std::vector<std::string> slips;
    slip_of_gravity(setup, slips);
    slip_of_angles(params, slips);
    slip_of_links(setup.plant.arm, slips);
    slip_of_units(setup.plant.arm, slips);
    slip_of_wall(setup, slips);
    return slips;
}

}  // namespace arm3r
