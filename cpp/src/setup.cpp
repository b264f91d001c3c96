#include "setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "at.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;
constexpr double infinite = std::numeric_limits<double>::infinity();

// One number x stands for (x along `axis`), three for themselves.
template <Name path>
Vec3<double> vector_along(std::span<const double> params, const Vec3<double>& axis) {
    const Vec3<double> given = vector_at<path>(params);
    return std::isnan(given[1]) ? Vec3<double>(given[0] * axis[0], given[0] * axis[1], given[0] * axis[2]) : given;
}

double given_or(double given, double otherwise) { return std::isnan(given) ? otherwise : given; }

// What a shape says of mass and inertia, with `mass` in place of density*volume where it is given.
struct Solid {
    double mass;
    Vec3<double> inertia;  // x along the length
};

template <Name link>
Solid solid_of(std::span<const double> params, double length) {
    const double given = at<link + ".mass">(params);
    if (is<link + ".shape", "brick">(params)) {
        const double h = at<link + ".section">(params, 0), w = at<link + ".section">(params, 1);
        const double m = given_or(given, at<link + ".density">(params) * length * h * w);
        return {m, {m * (w * w + h * h) / 12, m * (length * length + w * w) / 12, m * (length * length + h * h) / 12}};
    }
    if (is<link + ".shape", "cylinder">(params)) {
        const double R = at<link + ".radius">(params);
        const double m = given_or(given, at<link + ".density">(params) * length * pi * R * R);
        const double across = m * (3 * R * R + length * length) / 12;
        return {m, {m * R * R / 2, across, across}};
    }
    const double across = given * length * length / 12;  // slender
    return {given, {0, across, across}};
}

Turret<double> turret_of(std::span<const double> params) {
    const Turret<double> given{at<"arm.link1.mass">(params), at<"arm.link1.com">(params),
                               at<"arm.link1.inertia_axial">(params)};
    if (is<"arm.link1.shape", "explicit">(params)) return given;
    const double length = at<"arm.link1.length">(params);
    const Solid solid = solid_of<"arm.link1">(params, length);
    return {solid.mass, given_or(given.com, length / 2), given_or(given.inertia_axial, solid.inertia[0])};
}

template <Name link>
Link<double> link_of(std::span<const double> params) {
    const double length = at<link + ".length">(params);
    const Solid solid = solid_of<link>(params, length);
    const Vec3<double> given = vector_at<link + ".inertia">(params);
    return {length, solid.mass, given_or(at<link + ".com">(params), length / 2),
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

bool is_simscape(std::span<const double> params) { return is<"arm.convention", "simscape">(params); }

Vec3<double> to_slide(std::span<const double> params, const Vec3<double>& joint_vector) {
    return is_simscape(params) ? flipped(joint_vector) : joint_vector;
}

Controls controls_of(std::span<const double> params) {
    if (is<"controller.type", "constant">(params)) return Controls::constant;
    if (is<"controller.type", "gravity_compensation">(params)) return Controls::gravity_compensation;
    return Controls::none;
}

Controller<double> make_controller(std::span<const double> params, const Arm<double>& plant_arm) {
    Controller<double> controller{};
    controller.type = controls_of(params);
    controller.algorithm =
        is<"controller.algorithm", "closed_form">(params) ? Algorithm::closed_form : Algorithm::recursion;
    controller.model = model_differs(params) ? make_arm(with_model(params)) : plant_arm;
    controller.torque = {0, 0, 0};
    if (controller.type == Controls::constant)
        controller.torque = to_slide(params, vector_at<"controller.torque">(params));
    if (controller.type == Controls::gravity_compensation) {
        controller.model.gravity = vector_along<"controller.gravity">(params, {0, 0, -1});
        finish(controller.model);
    }
    return controller;
}

Motion motion_of(std::span<const double> params) {
    if (is<"wall.motion.type", "constant">(params)) return Motion::constant;
    if (is<"wall.motion.type", "sinusoid">(params)) return Motion::sinusoid;
    return Motion::fixed;
}

Wall<double> make_wall(std::span<const double> params) {
    Wall<double> wall{};
    wall.point = vector_at<"wall.point">(params);
    const Vec3<double> normal = vector_at<"wall.normal">(params);
    const double length = std::sqrt(dot(normal, normal));
    wall.n = {normal[0] / length, normal[1] / length, normal[2] / length};
    const Vec3<double> sideways = cross(wall.n, Vec3<double>(0, 0, 1));
    const double level = std::sqrt(dot(sideways, sideways));
    if (level < 1e-12) wall.e1 = {0, 1, 0};  // (4.1)
    else wall.e1 = {sideways[0] / level, sideways[1] / level, sideways[2] / level};
    wall.e2 = cross(wall.e1, wall.n);
    wall.half1 = at<"wall.size">(params, 0) / 2;
    wall.half2 = at<"wall.size">(params, 1) / 2;
    wall.has_outline = std::isfinite(wall.half1) || std::isfinite(wall.half2);
    wall.face_offset = at<"wall.face_offset">(params);
    wall.motion = motion_of(params);
    wall.velocity = {0, 0, 0};
    if (wall.motion == Motion::constant) wall.velocity = vector_along<"wall.motion.velocity">(params, wall.n);
    if (wall.motion == Motion::sinusoid) {
        wall.amplitude = at<"wall.motion.amplitude">(params);
        wall.frequency = at<"wall.motion.frequency">(params);
        wall.phase = at<"wall.motion.phase">(params);
    }
    return wall;
}

Contact<double> make_contact(std::span<const double> params) {
    const Vec3<double> k = vector_at<"wall.contact.stiffness">(params);
    if (is<"wall.contact.law", "diagonal">(params)) return {Law::diagonal, k};
    return {Law::spring, {k[0], 0, 0}};
}

Solver::Method method_of(std::span<const double> params) {
    if (is<"solver.method", "rk4">(params)) return Solver::rk4;
    if (is<"solver.method", "taylor">(params)) return Solver::taylor;
    return Solver::dopri5;
}

Solver make_solver(std::span<const double> params) {
    return {.method = method_of(params),
            .rtol = at<"solver.rtol">(params),
            .atol = at<"solver.atol">(params),
            .tol = at<"solver.tol">(params),
            .max_step = given_or(at<"solver.max_step">(params), infinite),
            .step = at<"solver.step">(params),
            .max_steps = at<"solver.max_steps">(params)};
}

}  // namespace

const std::vector<Replacement>& model_numbers() {
    static const auto numbers = [] {
        std::vector<Replacement> all;
        for (const Key& key : schema())
            for (std::size_t i = 0; key.plant && i < key.size; ++i)
                all.push_back({key.offset + i, key.plant->offset + i});
        return all;
    }();
    return numbers;
}

bool model_differs(std::span<const double> params) {
    return std::ranges::any_of(model_numbers(), [&](const Replacement& r) { return !std::isnan(params[r.from]); });
}

std::vector<double> with_model(std::span<const double> params) {
    std::vector<double> merged(params.begin(), params.end());
    for (const auto [from, to] : model_numbers()) merged[to] = given_or(params[from], merged[to]);
    return merged;
}

Arm<double> make_arm(std::span<const double> params) {
    Arm<double> arm;
    arm.base_height = at<"arm.base_height">(params);
    arm.link1 = turret_of(params);
    arm.link2 = link_of<"arm.link2">(params);
    arm.link3 = link_of<"arm.link3">(params);
    arm.payload = at<"arm.payload.mass">(params);
    arm.gravity = vector_at<"arm.gravity">(params);
    arm.armature = vector_at<"arm.armature">(params);
    arm.damping = vector_at<"arm.damping">(params);
    arm.friction = vector_at<"arm.friction">(params);
    arm.friction_velocity = at<"arm.friction_velocity">(params);
    arm.torque_limit = vector_at<"arm.torque_limit">(params);
    finish(arm);
    return arm;
}

Setup make_setup(std::span<const double> params) {
    Setup setup;
    setup.simscape = is_simscape(params);
    setup.plant.arm = make_arm(params);
    setup.plant.controller = make_controller(params, setup.plant.arm);
    setup.plant.has_wall = at<"wall">(params) != 0;
    setup.plant.wall = make_wall(params);
    setup.plant.contact = make_contact(params);
    setup.plant.acts_on_arm = setup.plant.has_wall && at<"wall.acts_on_arm">(params) != 0;
    setup.q = to_slide(params, vector_at<"initial.q">(params));
    setup.qd = to_slide(params, vector_at<"initial.qd">(params));
    setup.solver = make_solver(params);
    setup.stop = at<"time.stop">(params);
    setup.log_every = at<"time.log_every">(params);
    return setup;
}

}  // namespace arm3r
