#include "setup/setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "arm3r/model/restitution.hpp"
#include "base/spline.hpp"
#include "schema/param_access.hpp"
#include "setup/make_controller.hpp"
#include "setup/make_elbow.hpp"
#include "setup/make_reference.hpp"
#include "setup/make_sampling.hpp"
#include "setup/time_instants.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;

// A single number x stands for x times `axis`, three numbers for the vector.
template <Name path>
Vec3<double> vector_along(std::span<const double> params, const Vec3<double>& axis) {
    const Vec3<double> given = vector_at<path>(params);
    return std::isnan(given[1]) ? Vec3<double>(given[0] * axis[0], given[0] * axis[1], given[0] * axis[2]) : given;
}

double given_or(double given, double otherwise) { return std::isnan(given) ? otherwise : given; }

// Mass and inertia of a shape, with `mass` in place of density*volume if it is given.
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

BaseLink<double> base_link_of(std::span<const double> params) {
    const BaseLink<double> given{at<"arm.link1.mass">(params), at<"arm.link1.com">(params),
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
    Elbow<double>& elbow = arm.elbow;
    if (arm.is_elbow) lump_elbow(arm);
    else arm.lumped = lump_planar(arm);
    elbow.has_skew_rotors = arm.is_elbow && (elbow.K12 != 0 || elbow.E23 != 0 || elbow.F23 != 0);
    const Vec3<double>& g = arm.is_elbow ? elbow.gravity : arm.gravity;
    arm.gravity_is_vertical = g[0] == 0 && g[1] == 0;
    arm.has_damping = any_above_zero(arm.damping);
    arm.has_dry_friction = any_above_zero(arm.friction);
    arm.has_torque_limit =
        std::isfinite(arm.torque_limit[0]) || std::isfinite(arm.torque_limit[1]) || std::isfinite(arm.torque_limit[2]);
}

// The controller's model of the arm, with the gravity that it compensates.
void set_model(std::span<const double> params, const Arm<double>& plant_arm, Arm<double>& model) {
    model = model_differs(params) ? make_arm(with_model(params)) : plant_arm;
    if (!has_model(controller_type_of(params))) return;
    model.gravity = vector_along<"controller.gravity">(params, {0, 0, -1});
    finish(model);
}

Vec3<double> normalised(const Vec3<double>& v) {
    const double length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
}

template <Name section>
Sinusoid<double> sinusoid_of(std::span<const double> params) {
    return {at<section + ".amplitude">(params), at<section + ".frequency">(params), at<section + ".phase">(params)};
}

template <Name path>
AlignedVector<double> numbers_of(std::span<const double> params) {
    const std::span<const double> numbers = list_at<path>(params);
    return {numbers.begin(), numbers.end()};
}

QuinticTable<double> table_of(std::span<const double> params) {
    QuinticTable<double> table{numbers_of<"wall.motion.t">(params), numbers_of<"wall.motion.s">(params),
                               numbers_of<"wall.motion.v">(params), numbers_of<"wall.motion.a">(params)};
    if (table.v.empty()) move_with_minimum_jerk(table);
    return table;
}

void set_motion(Wall<double>& wall, std::span<const double> params) {
    wall.motion = choice_at<"wall.motion.type", Motion>(params);
    wall.velocity = {0, 0, 0};
    if (wall.motion == Motion::constant) wall.velocity = vector_along<"wall.motion.velocity">(params, wall.n);
    const Vec3<double> direction = vector_at<"wall.motion.direction">(params);
    wall.direction = std::isnan(direction[0]) ? wall.n : normalised(direction);
    if (wall.motion == Motion::sinusoid) wall.sinusoid = sinusoid_of<"wall.motion">(params);
    if (wall.motion == Motion::ramp)
        wall.ramp = {at<"wall.motion.distance">(params), at<"wall.motion.start">(params),
                     at<"wall.motion.duration">(params)};
    if (wall.motion == Motion::table) wall.table = std::make_shared<QuinticTable<double>>(table_of(params));
}

void set_rotation(Wall<double>& wall, std::span<const double> params) {
    wall.rotation = choice_at<"wall.rotation.type", Rotation>(params);
    wall.axis = {0, 0, 0};
    if (wall.rotation != Rotation::none) wall.axis = normalised(vector_at<"wall.rotation.axis">(params));
    if (wall.rotation == Rotation::constant) wall.turn_rate = at<"wall.rotation.rate">(params);
    if (wall.rotation == Rotation::sinusoid) wall.turn_sinusoid = sinusoid_of<"wall.rotation">(params);
}

Wall<double> make_wall(std::span<const double> params) {
    Wall<double> wall{};
    wall.point = vector_at<"wall.point">(params);
    wall.n = normalised(vector_at<"wall.normal">(params));
    const Vec3<double> sideways = cross(wall.n, Vec3<double>(0, 0, 1));
    const double level = std::sqrt(dot(sideways, sideways));
    if (level < 1e-12) wall.e1 = {0, 1, 0};  // (4.1)
    else wall.e1 = {sideways[0] / level, sideways[1] / level, sideways[2] / level};
    wall.e2 = cross(wall.e1, wall.n);
    wall.half1 = at<"wall.size">(params, 0) / 2;
    wall.half2 = at<"wall.size">(params, 1) / 2;
    wall.has_outline = std::isfinite(wall.half1) || std::isfinite(wall.half2);
    wall.face_offset = at<"wall.face_offset">(params);
    set_motion(wall, params);
    set_rotation(wall, params);
    return wall;
}

// The effective mass of the tip towards the wall at the start, kg.
double mass_at_start(const Setup& setup) {
    const Wall<double>& wall = setup.plant.wall;
    return effective_mass(setup.plant.arm, pose(setup.q), normal(wall, wall_at(wall, setup.start)));
}

double damping_of(std::span<const double> params, double stiffness, double mass) {
    const double restitution = at<"wall.contact.restitution">(params);
    if (std::isnan(restitution)) return at<"wall.contact.damping">(params);
    return 2 * damping_ratio_for(restitution) * std::sqrt(stiffness * mass);
}

double dissipation_of(std::span<const double> params) {
    const double restitution = at<"wall.contact.restitution">(params);
    if (std::isnan(restitution)) return at<"wall.contact.dissipation">(params);
    return hunt_crossley_number_for(restitution) / at<"wall.contact.impact_speed">(params);
}

Contact<double> make_contact(std::span<const double> params, double mass) {
    const Vec3<double> k = vector_at<"wall.contact.stiffness">(params);
    Contact<double> contact{};
    contact.law = choice_at<"wall.contact.law", ContactLaw>(params);
    contact.stiffness = acts_along_plate(contact.law) ? k : Vec3<double>(k[0], 0, 0);
    if (contact.law == ContactLaw::kelvin_voigt) contact.damping = damping_of(params, k[0], mass);
    if (contact.law == ContactLaw::hunt_crossley) {
        contact.exponent = at<"wall.contact.exponent">(params);
        contact.dissipation = dissipation_of(params);
    }
    contact.friction = at<"wall.contact.friction.coefficient">(params);
    contact.slip_velocity = at<"wall.contact.friction.slip_velocity">(params);
    contact.has_friction = contact.friction > 0;
    return contact;
}

Solver make_solver(std::span<const double> params) {
    return {.method = choice_at<"solver.method", SolverMethod>(params),
            .rtol = at<"solver.rtol">(params),
            .atol = at<"solver.atol">(params),
            .tol = at<"solver.tol">(params),
            .max_step = given_or(at<"solver.max_step">(params), infinite),
            .step = at<"solver.step">(params),
            .max_steps = at<"solver.max_steps">(params),
            .events = choice_at<"solver.events", StepEvents>(params)};
}

ColumnSet logged_columns(std::span<const double> params) {
    ColumnSet logged;
    for (std::size_t i = 0; i < column_count && !std::isnan(at<"time.log_columns">(params, i)); ++i)
        logged.set(static_cast<std::size_t>(at<"time.log_columns">(params, i)));
    if (logged.none()) return logged.set();
    return logged.set(ColumnIndex("t"));
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

Setup::Setup() = default;
Setup::Setup(const Setup&) = default;
Setup::Setup(Setup&&) noexcept = default;
Setup& Setup::operator=(const Setup&) = default;
Setup& Setup::operator=(Setup&&) noexcept = default;
Setup::~Setup() = default;

Arm<double> make_arm(std::span<const double> params) {
    Arm<double> arm{};
    arm.is_elbow = is<"arm.model", "elbow">(params);
    if (arm.is_elbow) {
        set_elbow(params, arm);
    } else {
        arm.base_height = at<"arm.base_height">(params);
        arm.link1 = base_link_of(params);
        arm.link2 = link_of<"arm.link2">(params);
        arm.link3 = link_of<"arm.link3">(params);
    }
    arm.payload = at<"arm.payload.mass">(params);
    arm.gravity = vector_at<"arm.gravity">(params);
    arm.armature = vector_at<"arm.armature">(params);
    arm.damping = vector_at<"arm.damping">(params);
    arm.friction = vector_at<"arm.friction">(params);
    arm.friction_velocity = at<"arm.friction_velocity">(params);
    arm.torque_limit = vector_at<"arm.torque_limit">(params);
    finish(arm);
    arm.elbow.is_far_from_singular = arm.is_elbow && is_far_from_singular(least_pivots(arm));
    return arm;
}

// Sets sensors, observer and sampling. With sampling, `digital.controller` becomes the controller of the scenario; the
// plant has none, and holds the torque that the sampled one sets.
static void wire_sampling(std::span<const double> params, Setup& setup) {
    Plant<double>& plant = setup.plant;
    DigitalController<double>& digital = setup.digital;
    if (at<"sensors">(params) != 0) plant.sensors = digital.sensors = make_sensors(params);
    if (at<"observer">(params) != 0) digital.observer = make_observer(params);
    // a user's law computes sample by sample
    if (at<"sampling">(params) != 0 || plant.controller.type == ControllerType::user) {
        digital.sampling = make_sampling(params);
        digital.controller = plant.controller;
        static_cast<ControllerChoices&>(plant.controller) = {};
        plant.controller.model = plant.arm;
        plant.held_torque = {0, 0, 0};
    } else {
        plant.observer = digital.observer;
        plant.held_torque = plant.controller.torque;
    }
    plant.holds_torque = digital.sampling.on || plant.controller.type == ControllerType::constant;
    plant.needs_azimuth = has_law(setup.controller().type) || setup.digital.sampling.on || setup.observes() ||
                          setup.estimation.on || plant.external_force.on;
}

Setup::Setup(std::span<const double> params) : Setup() {
    convention = convention_of(params);
    start = at<"time.start">(params);
    plant.arm = make_arm(params);
    set_controller(params, plant.controller);
    set_model(params, plant.arm, plant.controller.model);
    plant.has_wall = at<"wall">(params) != 0;
    plant.wall = make_wall(params);
    set_start_and_contact(params);
    plant.acts_on_arm = plant.has_wall && at<"wall.acts_on_arm">(params) != 0;
    if (has_law(plant.controller.type)) set_reference(params, *this, plant.controller.reference);
    solver = make_solver(params);
    stop = at<"time.stop">(params);
    log_every = at<"time.log_every">(params);
    logged = logged_columns(params);
    if (at<"push">(params) != 0) plant.external_force = make_external_force(params);
    if (at<"estimator">(params) != 0) estimation = make_estimation(params, plant.contact);
    wire_sampling(params, *this);
    set_jumps_on_clock(*this);
}

bool Setup::ends_steps_at_singular_poses() const {
    const Vec3<double>& limit = plant.arm.torque_limit;
    const bool is_limited = std::isfinite(limit[0]) && std::isfinite(limit[1]) && std::isfinite(limit[2]);
    return inverts_jacobian(plant.controller) && is_limited && !solver.is_on_grid();
}

void Setup::set_start_and_contact(std::span<const double> params) {
    q = convention.to_slide(vector_at<"initial.q">(params));
    qd = convention.flipped(vector_at<"initial.qd">(params));
    plant.contact = make_contact(params, mass_at_start(*this));
}

}  // namespace arm3r
