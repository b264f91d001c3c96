#include "schema/schema.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "arm3r/model/scalar_motion.hpp"
#include "schema/choice_words.hpp"
#include "schema/columns.hpp"
#include "schema/stiffness_presets.hpp"
#include "schema/suggest.hpp"

namespace arm3r {
namespace {

constexpr double unset = std::numeric_limits<double>::quiet_NaN();
using std::numbers::pi;

using Words = std::vector<std::string>;

constexpr Bounds any_position{-1e6, 1e6};
constexpr Bounds not_negative{0, 1e12};
constexpr Bounds a_length{1e-6, 1e6};
constexpr Bounds a_mass{1e-9, 1e9};
constexpr Bounds a_density{1e-3, 1e6};
constexpr Bounds an_instant{-1e9, 1e9};
constexpr Bounds no_bounds{-1e300, 1e300};
constexpr std::size_t table_size = max_knots;

Key number(std::string path, std::vector<double> fallback, Source source, Bounds bounds, std::string unit,
           std::string doc) {
    const std::size_t size = fallback.size();
    return {.path = std::move(path),
            .kind = Kind::number,
            .size = size,
            .form = Form::fixed,
            .fallback = std::move(fallback),
            .source = source,
            .bounds = bounds,
            .unit = std::move(unit),
            .doc = std::move(doc)};
}

Key choice(std::string path, std::vector<std::string> words, Source source, std::string doc) {
    return {.path = std::move(path),
            .kind = Kind::choice,
            .size = 1,
            .form = Form::fixed,
            .fallback = {0},
            .source = source,
            .bounds = no_bounds,
            .unit = "",
            .doc = std::move(doc),
            .choices = std::move(words)};
}

Key of_kind(Kind kind, Key key) {
    key.kind = kind;
    return key;
}

Key with_form(Form form, Key key, std::string word = {}) {
    key.form = form;
    key.word = std::move(word);
    return key;
}

Key list_of(std::size_t min_size, std::size_t most, Key key) {
    key.form = Form::list;
    key.size = most;
    key.min_size = min_size;
    key.fallback.assign(most, unset);
    return key;
}

Key where(std::string when_key, std::vector<std::string> when, Key key) {
    key.when_key = std::move(when_key);
    key.when = std::move(when);
    return key;
}

Key needed(Key key) {
    key.required = true;
    return key;
}

Key derived(std::string unset_means, Key key) {
    key.unset = std::move(unset_means);
    return key;
}

Key or_infinite(Key key) {
    key.allow_infinity = true;
    return key;
}

// The keys of a shape, for any link. The key of the shape itself comes before them.
void append_shape(std::vector<Key>& keys, const std::string& link) {
    const std::string shape = link + ".shape";
    keys.push_back(where(shape, {"brick"},
                         number(link + ".section", {0.01, 0.01}, Source::inferred, a_length, "m",
                                "Brick: height along y, width along z of the link's axes.")));
    keys.push_back(
        where(shape, {"cylinder"},
              needed(number(link + ".radius", {unset}, Source::ours, a_length, "m", "Radius of the cylinder."))));
    keys.push_back(where(shape, {"brick", "cylinder"},
                         number(link + ".density", {7850}, Source::inferred, a_density, "kg/m^3",
                                "Density; not used when the mass is given.")));
}

void append_link1(std::vector<Key>& keys, const std::string& link) {
    keys.push_back(choice(
        link + ".shape", {"explicit", "brick", "cylinder", "slender"}, Source::ours,
        "Shape of the column on joint 1, its length along z; explicit: mass, com and inertia_axial as they stand."));
    keys.push_back(
        where(link + ".shape", {"brick", "cylinder", "slender"},
              number(link + ".length", {1}, Source::inferred, a_length, "m", "Length along the joint-1 axis.")));
    append_shape(keys, link);
    keys.push_back(derived("from the shape", number(link + ".mass", {0.785}, Source::lecture, a_mass, "kg", "Mass.")));
    keys.push_back(derived("length/2", number(link + ".com", {0}, Source::inferred, any_position, "m",
                                              "Height of the centre of mass on the joint-1 axis.")));
    keys.push_back(derived("from the shape", number(link + ".inertia_axial", {1.3083333333333334e-5}, Source::inferred,
                                                    not_negative, "kg m^2", "Inertia about the joint-1 axis.")));
}

void append_link(std::vector<Key>& keys, const std::string& link) {
    keys.push_back(choice(link + ".shape", {"brick", "cylinder", "slender"}, Source::inferred,
                          "Gives mass, centre of mass and inertia; each of these given beside it replaces that one."));
    keys.push_back(
        number(link + ".length", {1}, Source::lecture, a_length, "m", "Length, from joint to joint (or tip)."));
    append_shape(keys, link);
    keys.push_back(derived("from the shape", number(link + ".mass", {unset}, Source::lecture, a_mass, "kg",
                                                    "Mass; the inertia of the shape scales with it.")));
    keys.push_back(derived("length/2", number(link + ".com", {unset}, Source::lecture, any_position, "m",
                                              "Centre of mass, along the link from its joint.")));
    keys.push_back(derived(
        "from the shape",
        number(
            link + ".inertia", {unset, unset, unset}, Source::inferred, not_negative, "kg m^2",
            "Principal inertias [Ix, Iy, Iz] about the centre of mass; x along the link, y in the arm's vertical plane, z along the joint.")));
}

void append_arm(std::vector<Key>& keys, const std::string& arm) {
    keys.push_back(number(arm + ".base_height", {0}, Source::inferred, any_position, "m",
                          "Height of joint 2 above the base frame."));
    append_link1(keys, arm + ".link1");
    append_link(keys, arm + ".link2");
    append_link(keys, arm + ".link3");
    keys.push_back(number(arm + ".armature", {0, 0, 0}, Source::lecture, not_negative, "kg m^2",
                          "Rotor inertia seen at each joint."));
    keys.push_back(number(arm + ".damping", {0, 0, 0}, Source::lecture, not_negative, "N m s/rad",
                          "Viscous friction of each joint."));
    keys.push_back(number(arm + ".friction", {0, 0, 0}, Source::lecture, not_negative, "N m",
                          "Dry friction of each joint: friction*tanh(qd/friction_velocity)."));
    keys.push_back(number(arm + ".friction_velocity", {1e-3}, Source::ours, {1e-12, 1e6}, "rad/s",
                          "Rate at which dry friction sets in."));
    keys.push_back(or_infinite(number(arm + ".torque_limit", {infinite, infinite, infinite}, Source::lecture,
                                      not_negative, "N m", "Largest torque of each actuator, either way.")));
    keys.push_back(number(arm + ".payload.mass", {0}, Source::lecture, {0, 1e9}, "kg", "Point mass at the tip."));
}

// The motions of the wall that follow a curve given in points.
void append_paths(std::vector<Key>& keys) {
    const std::string type = "wall.motion.type";
    keys.push_back(where(
        type, {"ramp"},
        needed(number("wall.motion.distance", {unset}, Source::ours, {-1e3, 1e3}, "m", "How far the ramp goes."))));
    keys.push_back(where(type, {"ramp"},
                         number("wall.motion.start", {0}, Source::ours, an_instant, "s", "When the ramp begins.")));
    keys.push_back(
        where(type, {"ramp"},
              needed(number(
                  "wall.motion.duration", {unset}, Source::ours, {1e-6, 1e9}, "s",
                  "How long the ramp takes: a quintic without a jump of acceleration; the wall stays at its end."))));
    keys.push_back(where(type, {"table"},
                         needed(list_of(2, table_size,
                                        number("wall.motion.t", {}, Source::ours, an_instant, "s",
                                               "Instants of the table, increasing; before and after them the wall "
                                               "stands still.")))));
    keys.push_back(where(
        type, {"table"},
        needed(list_of(
            2, table_size,
            number("wall.motion.s", {}, Source::ours, {-1e3, 1e3}, "m",
                   "Position of the wall along its direction at the instants wall.motion.t; quintics in between.")))));
    keys.push_back(where(type, {"table"},
                         needed(list_of(2, table_size,
                                        number("wall.motion.v", {}, Source::ours, {-1e4, 1e4}, "m/s",
                                               "Velocity of the wall at the instants wall.motion.t.")))));
    keys.push_back(where(type, {"table"},
                         needed(list_of(2, table_size,
                                        number("wall.motion.a", {}, Source::ours, {-1e6, 1e6}, "m/s^2",
                                               "Acceleration of the wall at the instants wall.motion.t.")))));
    keys.push_back(where(
        type, {"sinusoid", "ramp", "table"},
        derived("the normal", number("wall.motion.direction", {unset, unset, unset}, Source::ours, any_position, "",
                                     "Which way the wall moves, in base axes; normalised on "
                                     "reading. Along the plate it slides under the tip."))));
}

void append_rotation(std::vector<Key>& keys) {
    const std::string type = "wall.rotation.type";
    keys.push_back(choice(type, words_of<Rotation>(), Source::ours,
                          "How the plate turns about the origin of its frame; at t = 0 it stands as `normal` says."));
    keys.push_back(where(type, {"constant", "sinusoid"},
                         needed(number("wall.rotation.axis", {unset, unset, unset}, Source::ours, any_position, "",
                                       "Axis about which the wall turns, in base axes; normalised on reading."))));
    keys.push_back(
        where(type, {"constant"},
              needed(of_kind(Kind::angle, number("wall.rotation.rate", {unset}, Source::ours, {-1e4, 1e4}, "rad/s",
                                                 "Angular rate of the wall; 10 deg means 10 deg/s.")))));
    keys.push_back(
        where(type, {"sinusoid"},
              needed(of_kind(Kind::angle, number("wall.rotation.amplitude", {unset}, Source::ours, {-100, 100}, "rad",
                                                 "Amplitude A of the angle A sin(2 pi f t + phase) - A "
                                                 "sin(phase).")))));
    keys.push_back(
        where(type, {"sinusoid"},
              needed(number("wall.rotation.frequency", {unset}, Source::ours, {0, 1e4, true}, "Hz", "Frequency f."))));
    keys.push_back(where(
        type, {"sinusoid"},
        of_kind(Kind::angle, number("wall.rotation.phase", {0}, Source::ours, {-1e4, 1e4}, "rad", "Phase at t = 0."))));
}

void append_contact(std::vector<Key>& keys) {
    const std::string law = "wall.contact.law";
    keys.push_back(
        choice(law, words_of<ContactLaw>(), Source::lecture,
               "The normal force at depth d: spring: k d; diagonal: a spring, and two more that tie the tip "
               "sideways to the plate's centre; kelvin_voigt: k d + c d'; hunt_crossley: k d^p (1 + beta d')."));
    std::vector<std::string> words = {"none"};
    for (const StiffnessPreset& preset : stiffness_presets) words.emplace_back(preset.name);
    keys.push_back(where(law, {"spring", "kelvin_voigt"},
                         choice("wall.contact.preset", words, Source::ours,
                                "A part of the body whose stiffness is the default of `stiffness`.")));
    keys.push_back(
        where(law, {"spring", "diagonal", "kelvin_voigt", "hunt_crossley"},
              needed(with_form(Form::by_choice,
                               number("wall.contact.stiffness", {1000, unset, unset}, Source::ours, {0, 1e15}, "N/m",
                                      "K_E: one number k, in N/m^p for hunt_crossley, or [kn, k1, k2] for diagonal."),
                               "diagonal"))));
    keys.push_back(where(law, {"kelvin_voigt"},
                         derived("from restitution", number("wall.contact.damping", {unset}, Source::ours, not_negative,
                                                            "N s/m", "c: force per rate of depth."))));
    keys.push_back(where(law, {"hunt_crossley"},
                         number("wall.contact.exponent", {1.5}, Source::ours, {1, 3}, "",
                                "p: 1.5 is a sphere on a half-space (Hertz).")));
    keys.push_back(where(law, {"hunt_crossley"},
                         derived("from restitution", number("wall.contact.dissipation", {unset}, Source::ours, {0, 1e6},
                                                            "s/m", "beta: damping per stiffness."))));
    keys.push_back(where(
        law, {"kelvin_voigt", "hunt_crossley"},
        derived("not asked for", number("wall.contact.restitution", {unset}, Source::ours, {0, 1, true}, "",
                                        "Instead of damping or dissipation: speed after over speed before an impact "
                                        "of the mass that the arm shows along the normal at the start."))));
    keys.push_back(
        where(law, {"hunt_crossley"},
              derived("not asked for", number("wall.contact.impact_speed", {unset}, Source::ours, {0, 1e4, true}, "m/s",
                                              "The speed at which `restitution` holds."))));
    keys.push_back(number("wall.contact.friction.coefficient", {0}, Source::lecture, {0, 1e3}, "",
                          "mu: friction along the plate is -mu f_n v_t/sqrt(v_t^2 + slip_velocity^2)."));
    keys.push_back(number("wall.contact.friction.slip_velocity", {1e-3}, Source::ours, {1e-9, 1e4}, "m/s",
                          "Sliding speed at which the friction of the wall sets in."));
}

void append_wall(std::vector<Key>& keys) {
    keys.push_back(of_kind(Kind::section, number("wall", {0}, Source::lecture, no_bounds, "",
                                                 "The moving plate. Absent: no wall; `wall: {}` is the lecture's.")));
    keys.push_back(number("wall.point", {2, 0, 0}, Source::lecture, any_position, "m",
                          "Origin of the plate's frame, its centre, at t = 0."));
    keys.push_back(number("wall.normal", {-1, 0, 0}, Source::lecture, any_position, "",
                          "From the wall towards the arm; normalised on reading."));
    keys.push_back(
        with_form(Form::vector_or_word,
                  number("wall.size", {1, 1}, Source::lecture, a_length, "m", "Extent along e1 and e2, or infinite."),
                  "infinite"));
    keys.push_back(number("wall.face_offset", {0}, Source::lecture, any_position, "m",
                          "How far the contact face lies in front of the frame."));
    keys.push_back(choice("wall.motion.type", words_of<Motion>(), Source::lecture,
                          "How the wall moves: its point is wall.point + s(t) direction, but for constant."));
    keys.push_back(where(
        "wall.motion.type", {"constant"},
        with_form(
            Form::number_or_vector,
            number(
                "wall.motion.velocity", {0.05, unset, unset}, Source::lecture, {-1e4, 1e4}, "m/s",
                "Velocity of the wall: a number along its normal, positive towards the arm, or a vector in base axes."))));
    keys.push_back(where("wall.motion.type", {"sinusoid"},
                         needed(number("wall.motion.amplitude", {unset}, Source::ours, {-1e3, 1e3}, "m",
                                       "Amplitude A of s = A sin(2 pi f t + phase) - A sin(phase)."))));
    keys.push_back(
        where("wall.motion.type", {"sinusoid"},
              needed(number("wall.motion.frequency", {unset}, Source::ours, {0, 1e4, true}, "Hz", "Frequency f."))));
    keys.push_back(where(
        "wall.motion.type", {"sinusoid"},
        of_kind(Kind::angle, number("wall.motion.phase", {0}, Source::ours, {-1e4, 1e4}, "rad", "Phase at t = 0."))));
    append_paths(keys);
    append_rotation(keys);
    append_contact(keys);
    keys.push_back(of_kind(
        Kind::flag, number("wall.acts_on_arm", {0}, Source::lecture, no_bounds, "",
                           "false: the force is only measured, as in the lecture; true: the arm feels f_on_tip.")));
}

// ---- controllers: which law takes which gain. The laws themselves: docs/model.md, section 7.

// The words of the laws of which `holds` is true.
template <class Holds>
Words laws_that(Holds holds) {
    Words words;
    for (const LawProperties& law : law_table)
        if (holds(law)) words.emplace_back(law.word);
    return words;
}

const Words with_a_torque = laws_that([](const LawProperties& law) { return law.type != ControllerType::none; });
const Words with_a_model = laws_that([](const LawProperties& law) { return law.has_model; });
const Words with_a_path = laws_that([](const LawProperties& law) { return law.follows_path; });
const Words with_a_sensor =
    laws_that([](const LawProperties& law) { return law.has_model || law.type == ControllerType::user; });
const Words of_force = laws_that([](const LawProperties& law) { return law.takes_force; });
const Words controlling_force = laws_that([](const LawProperties& law) { return law.controls_force; });
const Words integrating_force = laws_that([](const LawProperties& law) { return law.integrates_force; });

Key for_laws(Words which, Key key) { return where("controller.type", std::move(which), std::move(key)); }

// A key that exists for these laws only.
void append_for_laws(std::vector<Key>& keys, const Words& which, std::vector<Key> some) {
    for (Key& key : some) keys.push_back(key.when_key.empty() ? for_laws(which, std::move(key)) : std::move(key));
}

// A key with a default of its own for some laws.
Key but(std::map<std::string, std::vector<double>> fallback_for, Key key) {
    key.fallback_for = std::move(fallback_for);
    return key;
}

// A gain per axis, or one for all three.
Key gain(const std::string& name, double fallback, std::string unit, std::string doc) {
    return with_form(Form::number_or_vector, number("controller." + name, {fallback, unset, unset}, Source::ours,
                                                    not_negative, std::move(unit), std::move(doc)));
}

Key one_gain(const std::string& name, double fallback, Bounds bounds, std::string unit, std::string doc) {
    return number("controller." + name, {fallback}, Source::ours, bounds, std::move(unit), std::move(doc));
}

Key flag(std::string path, bool fallback, std::string doc) {
    return of_kind(Kind::flag,
                   number(std::move(path), {double(fallback)}, Source::ours, no_bounds, "", std::move(doc)));
}

// The controller's copy of the arm: the same keys, each "as the plant" unless given.
void append_model(std::vector<Key>& keys) {
    const std::string prefix = "controller.model";
    std::vector<Key> copy;
    append_arm(copy, prefix);
    for (Key& key : copy) {
        std::fill(key.fallback.begin(), key.fallback.end(), unset);
        key.source = Source::ours;
        key.required = false;
        key.unset = "as the plant";
        if (key.when_key.empty()) key = for_laws(with_a_model, key);
        keys.push_back(std::move(key));
    }
}

void append_joint_gains(std::vector<Key>& keys) {
    const std::vector<std::string> in_joints = {"joint_pd", "hybrid", "admittance"};
    keys.push_back(
        for_laws(in_joints, number("controller.joint_stiffness", {200, 200, 100}, Source::ours, not_negative, "N m/rad",
                                   "Kp of each joint; in hybrid of raibert_craig and projected.")));
    keys.push_back(
        for_laws(in_joints, number("controller.joint_damping", {30, 30, 10}, Source::ours, not_negative, "N m s/rad",
                                   "Kd of each joint; in hybrid of raibert_craig and projected.")));
    keys.push_back(for_laws({"joint_pd"}, flag("controller.compensate_gravity", true,
                                               "Whether the torque that holds the model is added.")));
}

void append_motion_gains(std::vector<Key>& keys) {
    const std::vector<std::string> accelerations = {"computed_torque", "resolved_acceleration", "operational_space",
                                                    "hybrid"};
    keys.push_back(
        for_laws(accelerations, but({{"operational_space", {400, unset, unset}}, {"hybrid", {400, unset, unset}}},
                                    gain("position_gain", 100, "1/s^2",
                                         "Acceleration per error of position, of each joint or base axis: w^2."))));
    keys.push_back(for_laws(accelerations,
                            but({{"operational_space", {40, unset, unset}}, {"hybrid", {40, unset, unset}}},
                                gain("velocity_gain", 20, "1/s",
                                     "Acceleration per error of velocity, of each joint or base axis: 2 zeta w."))));
}

void append_impedances(std::vector<Key>& keys) {
    const Words compliant = {"stiffness", "joint_stiffness", "impedance",          "shaped_impedance", "hybrid",
                             "parallel",  "admittance",      "adaptive_reference", "energy_tank",      "virtual_wall"};
    const Words damped = compliant;
    keys.push_back(
        for_laws({"shaped_impedance", "admittance", "adaptive_reference"},
                 with_form(Form::number_or_vector, number("controller.mass", {2, unset, unset}, Source::ours,
                                                          {1e-6, 1e9}, "kg", "Apparent mass along the base axes."))));
    keys.push_back(
        for_laws(compliant, but({{"shaped_impedance", {200, unset, unset}},
                                 {"parallel", {100, unset, unset}},
                                 {"admittance", {200, unset, unset}},
                                 {"adaptive_reference", {200, unset, unset}},
                                 {"energy_tank", {200, unset, unset}},
                                 {"virtual_wall", {5000, unset, unset}}},
                                gain("stiffness", 500, "N/m",
                                     "Force per displacement along the base axes; in hybrid of jacobian_transpose."))));
    keys.push_back(
        for_laws(damped, but({{"shaped_impedance", {40, unset, unset}},
                              {"parallel", {80, unset, unset}},
                              {"admittance", {40, unset, unset}},
                              {"adaptive_reference", {80, unset, unset}},
                              {"energy_tank", {0.3, unset, unset}},
                              {"virtual_wall", {0, unset, unset}}},
                             gain("damping", 100, "N s/m",
                                  "Force per velocity along the base axes; in hybrid of jacobian_transpose."))));
}

void append_force_loop(std::vector<Key>& keys) {
    keys.push_back(for_laws(
        {"hybrid"}, choice("controller.variant", words_of<Variant>(), Source::ours,
                           "How motion and force are joined; raibert_craig is unstable in part of the workspace.")));
    keys.push_back(
        for_laws({"operational_space"},
                 choice("controller.force_term", words_of<ForceTerm>(), Source::ours,
                        "What becomes of the contact force: cancelled as measured, or the reference fed forward.")));
    keys.push_back(
        for_laws(integrating_force, one_gain("force_mass", 1, {1e-6, 1e9}, "kg", "Apparent mass along the normal.")));
    keys.push_back(for_laws({"operational_space", "hybrid"},
                            one_gain("force_damping", 70, not_negative, "N s/m", "Damping along the normal.")));
    keys.push_back(for_laws(integrating_force,
                            one_gain("force_gain", 0.5, not_negative, "", "Proportional gain of the force error.")));
    keys.push_back(
        for_laws(integrating_force, but({{"parallel", {6}}}, one_gain("force_integral_gain", 5, not_negative, "1/s",
                                                                      "Gain of the integral of the force error."))));
    keys.push_back(for_laws(integrating_force,
                            or_infinite(one_gain("integral_limit", infinite, not_negative, "N s",
                                                 "Limit of the integral of the force error, in both directions."))));
    keys.push_back(for_laws(
        integrating_force,
        choice(
            "controller.anti_windup", words_of<AntiWindup>(), Source::ours,
            "How the integral of the force error behaves while a torque is at its limit: it continues, waits, or runs back.")));
    keys.push_back(
        where("controller.anti_windup", {"back_calculation"},
              one_gain("tracking_time", 0.1, {1e-6, 1e6}, "s",
                       "Time constant with which back-calculation returns the integral of the force error.")));
    keys.push_back(for_laws(
        controlling_force,
        choice(
            "controller.switching", words_of<Switching>(), Source::ours,
            "When force is controlled: while there is contact, from the first contact on, or from the start; else the tip keeps to the reference in all directions.")));
    keys.push_back(where("controller.switching", {"in_contact", "latched"},
                         one_gain("contact_on", 1, not_negative, "N",
                                  "Measured force above which a sampled controller assumes that contact has begun.")));
    keys.push_back(where("controller.switching", {"in_contact", "latched"},
                         one_gain("contact_off", 0.5, not_negative, "N",
                                  "Measured force below which a sampled controller assumes that contact has ended.")));
}

void append_special_laws(std::vector<Key>& keys) {
    keys.push_back(
        for_laws({"admittance"},
                 choice("controller.inner", words_of<Inner>(), Source::ours,
                        "Inner loop: exact tracking with feedforward, position tracking without, or joint PD.")));
    keys.push_back(
        where("controller.inner", {"position"},
              one_gain("inner_bandwidth", 50, {1e-6, 1e6}, "rad/s", "Bandwidth w of the inner position loop.")));
    keys.push_back(
        where("controller.inner", {"position"},
              one_gain("inner_damping_ratio", 1, not_negative, "", "Damping ratio z of the inner position loop.")));
    keys.push_back(for_laws({"adaptive_reference"},
                            choice("controller.adaptation", words_of<Adaptation>(), Source::ours,
                                   "The reference integrates the force error, or is computed from a wall stiffness.")));
    keys.push_back(where("controller.adaptation", {"integral"},
                         one_gain("reference_gain", 0.02, not_negative, "m/(N s)",
                                  "Gain k_r with which the reference integrates the force error.")));
    keys.push_back(
        where("controller.adaptation", {"indirect"},
              needed(one_gain("assumed_stiffness", unset, {1e-3, 1e12}, "N/m",
                              "The wall stiffness that the reference is computed from; an estimator replaces it."))));
    keys.push_back(for_laws({"energy_tank"}, one_gain("stiffness_amplitude", 120, not_negative, "N/m",
                                                      "Amplitude of the sinusoidal variation of the stiffness.")));
    keys.push_back(for_laws({"energy_tank"}, one_gain("stiffness_frequency", 6.25, not_negative, "Hz",
                                                      "Frequency of the sinusoidal variation of the stiffness.")));
    keys.push_back(for_laws(
        {"energy_tank"},
        flag("controller.tank", true, "Whether the energy of the tank limits the variation of the stiffness.")));
    const std::pair<const char*, std::pair<double, const char*>> levels[] = {
        {"tank_energy", {0.05, "Energy in the tank at the start."}},
        {"tank_low", {0.01, "Energy of the tank below which the stiffness does not vary."}},
        {"tank_high", {0.03, "Energy of the tank above which the stiffness varies fully."}},
        {"tank_capacity", {5, "Maximum energy of the tank."}}};
    for (const auto& [name, level] : levels)
        keys.push_back(for_laws({"energy_tank"}, one_gain(name, level.first, not_negative, "J", level.second)));
    keys.push_back(for_laws({"virtual_wall"}, number("controller.plane_point", {1.75, 0, 0}, Source::ours, any_position,
                                                     "m", "A point of the virtual wall's face.")));
    keys.push_back(
        for_laws({"virtual_wall"}, number("controller.plane_normal", {-1, 0, 0}, Source::ours, any_position, "",
                                          "Direction from the virtual wall towards the arm; normalised on reading.")));
    keys.push_back(for_laws({"virtual_wall"}, flag("controller.passivity_control", false,
                                                   "Whether a brake takes the energy that samples and delay would "
                                                   "create. It acts outside the wall too, where it pulls.")));
}

void append_controller(std::vector<Key>& keys) {
    keys.push_back(choice("controller.type", words_of<ControllerType>(), Source::ours, "The control law."));
    keys.push_back(
        for_laws({"constant"}, needed(number("controller.torque", {unset, unset, unset}, Source::ours, {-1e12, 1e12},
                                             "N m", "The constant torque, in the arm's convention."))));
    keys.push_back(for_laws(
        with_a_model,
        with_form(
            Form::number_or_vector,
            number(
                "controller.gravity", {9.80665, unset, unset}, Source::lecture, {-1e4, 1e4}, "m/s^2",
                "The gravity that is compensated, whatever the plant feels: a number along -z, or a vector in base axes."))));
    keys.push_back(
        for_laws({"gravity_compensation"},
                 choice("controller.algorithm", words_of<Algorithm>(), Source::lecture,
                        "How the torque is computed: by the lecture's formula or by the Newton-Euler recursion.")));
    append_joint_gains(keys);
    append_motion_gains(keys);
    append_impedances(keys);
    append_force_loop(keys);
    append_special_laws(keys);
    keys.push_back(
        for_laws({"computed_torque", "resolved_acceleration"},
                 but({{"resolved_acceleration", {1}}},
                     flag("controller.cancel_force", false, "Whether the measured contact force is cancelled."))));
    keys.push_back(
        for_laws({"resolved_acceleration", "shaped_impedance", "operational_space", "hybrid", "parallel", "admittance",
                  "adaptive_reference"},
                 flag("controller.ideal_cancellation", false,
                      "The force that is cancelled is the true one; only the force error suffers from the sensor.")));
    keys.push_back(for_laws(
        with_a_torque,
        choice("controller.saturation", words_of<Saturation>(), Source::ours,
               "At arm.torque_limit: each joint for itself, or all by one factor, which keeps the direction.")));
    append_model(keys);
}

std::vector<Key> reference_keys() {
    std::vector<Key> keys;
    const auto in = [](std::vector<std::string> types, Key key) {
        return where("reference.type", std::move(types), std::move(key));
    };
    keys.push_back(choice("reference.type", words_of<Path>(), Source::ours,
                          "The desired motion of the arm: hold keeps it where it starts."));
    keys.push_back(
        in({"point", "line", "minimum_jerk"},
           derived("not given",
                   number("reference.tip", {unset, unset, unset}, Source::ours, any_position, "m",
                          "Desired position of the tip, base axes; for a line or minimum_jerk the one at its end."))));
    keys.push_back(
        in({"point", "line", "minimum_jerk"},
           derived("not given",
                   of_kind(Kind::angle, number("reference.q", {unset, unset, unset}, Source::ours, {-1e5, 1e5}, "rad",
                                               "Desired joint angles, in place of reference.tip.")))));
    keys.push_back(in({"line", "minimum_jerk", "circle", "sinusoid"},
                      number("reference.start", {0}, Source::ours, an_instant, "s", "When the motion begins.")));
    keys.push_back(in({"line", "minimum_jerk"},
                      number("reference.duration", {1}, Source::ours, {1e-9, 1e9}, "s", "How long the motion takes.")));
    keys.push_back(in({"circle"}, number("reference.radius", {0.1}, Source::ours, {0, 1e6}, "m",
                                         "Radius of a circle on the wall's face through the tip's start.")));
    keys.push_back(in({"circle"}, number("reference.period", {4}, Source::ours, {1e-9, 1e9}, "s",
                                         "Time of one turn of the circle.")));
    keys.push_back(
        in({"circle"}, number("reference.turns", {1}, Source::ours, {1e-3, 1e6}, "",
                              "Number of turns of the circle, which begin and end at rest by a minimum-jerk law.")));
    keys.push_back(
        in({"sinusoid"},
           derived("not given", number("reference.tip_amplitude", {unset, unset, unset}, Source::ours, any_position,
                                       "m", "Amplitude of the tip's sinusoid about its start, base axes."))));
    keys.push_back(in(
        {"sinusoid"},
        derived("not given",
                of_kind(Kind::angle,
                        number("reference.q_amplitude", {unset, unset, unset}, Source::ours, {-1e5, 1e5}, "rad",
                               "Amplitude of the joints' sinusoid about their start, in place of tip_amplitude.")))));
    keys.push_back(in({"sinusoid"}, number("reference.frequency", {0.5}, Source::ours, {0, 1e4}, "Hz",
                                           "Frequency of the sinusoid.")));
    const auto column = [&](const char* path, Bounds bounds, const char* unit, const char* doc) {
        keys.push_back(
            in({"table"}, needed(list_of(2, table_size, number(path, {}, Source::ours, bounds, unit, doc)))));
    };
    column("reference.t", an_instant, "s",
           "Instants of the table, increasing; before the first and after the last one the reference is at rest.");
    column("reference.x", any_position, "m",
           "Desired x of the tip at the instants reference.t, base axes; in between it moves with minimum jerk.");
    column("reference.y", any_position, "m",
           "Desired y of the tip at the instants reference.t, base axes; in between it moves with minimum jerk.");
    column("reference.z", any_position, "m",
           "Desired z of the tip at the instants reference.t, base axes; in between it moves with minimum jerk.");
    return keys;
}

std::vector<Key> force_reference_keys() {
    std::vector<Key> keys;
    const auto in = [](std::vector<std::string> types, Key key) {
        return where("reference.force.type", std::move(types), std::move(key));
    };
    keys.push_back(choice("reference.force.type", words_of<ForceProfile>(), Source::ours,
                          "The desired pressing force as a function of time, along the wall's normal."));
    keys.push_back(for_laws(
        of_force, but({{"admittance", {0}}},
                      number("reference.force.value", {20}, Source::ours, {-1e9, 1e9}, "N",
                             "The desired force; for a step or ramp the one after it, for a sinusoid the mean."))));
    keys.push_back(in({"step", "ramp"}, number("reference.force.initial", {0}, Source::ours, {-1e9, 1e9}, "N",
                                               "The desired force before the step or ramp.")));
    keys.push_back(in({"step", "ramp"}, number("reference.force.start", {1}, Source::ours, an_instant, "s",
                                               "When the desired force begins to change.")));
    keys.push_back(in({"ramp"}, number("reference.force.duration", {1}, Source::ours, {1e-9, 1e9}, "s",
                                       "How long the ramp of the desired force takes.")));
    keys.push_back(in({"sinusoid"}, number("reference.force.amplitude", {2}, Source::ours, {-1e9, 1e9}, "N",
                                           "Amplitude of the desired force about its mean.")));
    keys.push_back(in({"sinusoid"}, number("reference.force.frequency", {2}, Source::ours, {0, 1e4}, "Hz",
                                           "Frequency of the desired force's sinusoid.")));
    return keys;
}

std::vector<Key> sampling_keys() {
    std::vector<Key> keys;
    keys.push_back(
        of_kind(Kind::section, number("sampling", {0}, Source::ours, no_bounds, "",
                                      "Sampling of the controller. Absent: the controller computes continuously.")));
    keys.push_back(number("sampling.rate", {1000}, Source::ours, {1e-3, 1e6}, "Hz",
                          "How often the controller computes; its torque is held in between."));
    keys.push_back(number("sampling.delay", {0}, Source::ours, {0, 64}, "samples",
                          "Delay from reading the sensors to the torque, in whole and fractional samples."));
    keys.push_back(of_kind(Kind::integer, number("sampling.seed", {1}, Source::ours, {0, 9007199254740991}, "",
                                                 "Seed of the sensors' noise: the same seed gives the same bits.")));
    keys.push_back(
        of_kind(Kind::section, number("sensors", {0}, Source::ours, no_bounds, "",
                                      "Errors of the controller's sensors. Absent: it reads the true values.")));
    keys.push_back(of_kind(Kind::integer, number("sensors.encoder.counts", {0}, Source::ours, {0, 1e9}, "",
                                                 "Counts per turn to which each joint's encoder rounds; 0: exact.")));
    keys.push_back(choice(
        "sensors.velocity.estimate", words_of<VelocityEstimate>(), Source::ours,
        "How joint rates are measured: exactly, as the difference of two samples, or as that difference after a low-pass."));
    keys.push_back(where("sensors.velocity.estimate", {"filtered"},
                         number("sensors.velocity.cutoff", {50}, Source::ours, {1e-6, 1e6}, "Hz",
                                "Cutoff frequency of the low-pass on the joint rates.")));
    keys.push_back(number("sensors.force.noise", {0}, Source::ours, not_negative, "N",
                          "Standard deviation of the noise in each component of the measured force, in each sample."));
    keys.push_back(number("sensors.force.bias", {0, 0, 0}, Source::ours, {-1e9, 1e9}, "N",
                          "Constant error that is added to the measured force, base axes."));
    keys.push_back(
        number("sensors.force.resolution", {0}, Source::ours, not_negative, "N",
               "Resolution of the measured force: each component is rounded to a multiple of it; 0: exact."));
    keys.push_back(
        derived("no filter", number("sensors.force.analog_cutoff", {unset}, Source::ours, {1e-6, 1e6}, "Hz",
                                    "Cutoff frequency of a first-order low-pass on the force before sampling.")));
    keys.push_back(derived("no filter",
                           number("sensors.force.cutoff", {unset}, Source::ours, {1e-6, 1e6}, "Hz",
                                  "Cutoff frequency of a first-order digital low-pass on the samples of the force.")));
    keys.push_back(number("sensors.force.delay", {0}, Source::ours, {0, 256}, "samples",
                          "Delay of the measured force, in whole and fractional samples."));
    keys.push_back(number("sensors.force.tool_mass", {0}, Source::ours, {0, 1e9}, "kg",
                          "Mass of a tool beyond the force sensor, which measures its weight too."));
    return keys;
}

void append_observer(std::vector<Key>& keys) {
    const auto vector = [](Key key) { return with_form(Form::number_or_vector, std::move(key)); };
    keys.push_back(of_kind(Kind::section, number("observer", {0}, Source::ours, no_bounds, "",
                                                 "Momentum observer of the external torque. Absent: none.")));
    keys.push_back(vector(number("observer.gain", {50, unset, unset}, Source::ours, {0, 1e6, true}, "1/s",
                                 "Gain K_O of the momentum observer: the pole of its first-order filter.")));
    keys.push_back(vector(number("observer.threshold", {0.5, unset, unset}, Source::ours, not_negative, "N m",
                                 "Residual above which there is a collision.")));
    keys.push_back(
        number("observer.hold", {0.02}, Source::ours, {0, 1e6}, "s",
               "How long all residuals must stay below half of observer.threshold until the collision is over."));
    keys.push_back(choice(
        "observer.reaction", words_of<Reaction>(), Source::ours,
        "Reaction from a collision on: none, hold the pose, only compensate gravity, push with the residual, or retreat."));
    keys.push_back(where("observer.reaction", {"reflex"},
                         number("observer.reflex_gain", {1}, Source::ours, not_negative, "",
                                "Gain K_R of the reflex tau = tau_g + K_R r.")));
    keys.push_back(where("observer.reaction", {"retreat"},
                         number("observer.retreat_gain", {0.1}, Source::ours, not_negative, "rad/(N m s)",
                                "Gain K_Q of the retreat: rate of the joint reference per residual.")));
    keys.push_back(where("observer.reaction", {"stop", "retreat"},
                         number("observer.joint_stiffness", {200, 200, 100}, Source::ours, not_negative, "N m/rad",
                                "Kp of the PD controller that holds the pose after a collision.")));
    keys.push_back(where("observer.reaction", {"stop", "retreat"},
                         number("observer.joint_damping", {30, 30, 10}, Source::ours, not_negative, "N m s/rad",
                                "Kd of the PD controller that holds the pose after a collision.")));
    keys.push_back(
        of_kind(Kind::section, number("estimator", {0}, Source::ours, no_bounds, "",
                                      "Recursive least squares of the wall's stiffness and speed. Absent: none.")));
    keys.push_back(number(
        "estimator.rate", {500}, Source::ours, {1e-3, 1e6}, "Hz",
        "How often the estimator takes a sample; with a controller without `sampling`, rk4 needs a whole number of steps in between."));
    keys.push_back(number("estimator.forgetting", {0.995}, Source::ours, {0.5, 1}, "",
                          "Forgetting factor: the weight of a sample is multiplied by it at each later one."));
    keys.push_back(
        choice("estimator.wall", {"moving", "fixed"}, Source::ours, "Whether the wall's speed is estimated too."));
    keys.push_back(
        number("estimator.start", {0}, Source::ours, an_instant, "s", "When the estimator takes its first sample."));
    keys.push_back(number("estimator.largest_condition", {1e8}, Source::ours, {1, 1e15}, "",
                          "Condition number of the data above which the wall is not identifiable."));
}

void append_push(std::vector<Key>& keys) {
    keys.push_back(of_kind(
        Kind::section,
        number(
            "push", {0}, Source::ours, no_bounds, "",
            "An external force on the tip, beside that of the wall; a force sensor measures it too. Absent: none.")));
    keys.push_back(
        number("push.force", {0, 0, 0}, Source::ours, {-1e9, 1e9}, "N", "The external force on the tip, base axes."));
    keys.push_back(number("push.start", {0}, Source::ours, an_instant, "s", "When the external force begins."));
    keys.push_back(number("push.rise", {0}, Source::ours, {0, 1e9}, "s",
                          "How long the external force grows linearly before it is constant."));
    keys.push_back(or_infinite(
        number("push.duration", {infinite}, Source::ours, {0, 1e9}, "s", "How long the external force lasts.")));
}

void append_solver(std::vector<Key>& keys) {
    keys.push_back(choice(
        "solver.method", words_of<SolverMethod>(), Source::ours,
        "dopri5: Dormand-Prince 5(4), adaptive; rk4: classical Runge-Kutta, fixed step; taylor: power series, adaptive; rodas4: Rosenbrock 4(3) for stiff contact, adaptive; auto: dopri5, and rodas4 where the motion is stiff."));
    keys.push_back(where("solver.method", {"dopri5", "rodas4", "auto"},
                         number("solver.rtol", {1e-9}, Source::ours, {2.220446049250313e-14, 0.1}, "",
                                "Relative tolerance of a step; not below 100 times the rounding unit.")));
    keys.push_back(
        where("solver.method", {"dopri5", "rodas4", "auto"},
              number("solver.atol", {1e-12}, Source::ours, {1e-20, 1}, "rad, rad/s", "Absolute tolerance of a step.")));
    keys.push_back(where("solver.method", {"taylor"},
                         number("solver.tol", {1e-9}, Source::ours, {1e-15, 1e-2}, "rad, rad/s",
                                "Tolerance of a step: absolute below 1, relative above.")));
    keys.push_back(where("solver.method", {"dopri5", "taylor", "rodas4", "auto"},
                         derived("no limit", number("solver.max_step", {unset}, Source::ours, {1e-12, 1e9}, "s",
                                                    "Maximum step size."))));
    keys.push_back(where("solver.method", {"rk4"},
                         number("solver.step", {1e-3}, Source::ours, {1e-12, 1e9}, "s", "Step size of rk4.")));
    keys.push_back(of_kind(Kind::integer, number("solver.max_steps", {1e7}, Source::ours, {1, 1e9}, "",
                                                 "Accepted and rejected steps after which the run ends as `budget`.")));
}

// Laws with three stiffnesses, or with another unit, have no default.
double default_stiffness(std::span<const double> params, double otherwise) {
    const std::string& law = choice_of(params, "wall.contact.law");
    if (law == "diagonal" || law == "hunt_crossley") return unset;
    const auto preset = static_cast<std::size_t>(param(params, "wall.contact.preset"));
    return preset == 0 ? otherwise : stiffness_presets[preset - 1].stiffness;
}

// Whether the choice that decides on a key is one of its words.
bool is_chosen(const Key& key, std::span<const double> params) {
    return std::ranges::find(key.when, choice_of(params, *key.decided_by)) != key.when.end();
}

const Key* known_among(const std::vector<Key>& keys, const std::string& path) {
    const auto found = std::ranges::find(keys, path, &Key::path);
    if (found == keys.end()) throw Error(ARM3R_E_INTERNAL, "no key '" + path + "' in the schema");
    return &*found;
}

void connect(std::vector<Key>& keys) {
    constexpr std::string_view model = "controller.model.";
    std::size_t offset = 0;
    for (Key& key : keys) {
        key.offset = offset;
        offset += key.size;
        if (!key.when_key.empty()) key.decided_by = known_among(keys, key.when_key);
        if (key.path.starts_with(model)) key.plant = known_among(keys, "arm." + key.path.substr(model.size()));
    }
}

Key log_columns() {
    Key key = list_of(1, column_count,
                      number("time.log_columns", {unset}, Source::ours, {0, double(column_count - 1)}, "",
                             "Names of the columns of the log; t is always one. The rest is not computed, and nothing "
                             "but the log changes."));
    for (const Column& column : column_table) key.choices.emplace_back(column.name);
    return of_kind(Kind::column, derived("all that the run has", key));
}

std::vector<Key> make_schema() {
    std::vector<Key> keys;
    keys.push_back(choice(
        "arm.convention", {"simscape", "slide"}, Source::lecture,
        "Sign of joints 2 and 3. simscape: positive angles lower the arm (axes +y); slide: they raise it (axes -y)."));
    keys.push_back(number("arm.gravity", {0, 0, -9.80665}, Source::lecture, {-1e4, 1e4}, "m/s^2",
                          "What the plant feels, in the base frame."));
    append_arm(keys, "arm");
    keys.push_back(of_kind(
        Kind::angle,
        number(
            "initial.q", {0, -30 * pi / 180, 60 * pi / 180}, Source::lecture, {-1e5, 1e5}, "rad",
            "Joint angles at the start. The default is the lecture's pose: [0, -30 deg, 60 deg], or [0, 30 deg, -60 deg] in the slide convention.")));
    keys.push_back(of_kind(Kind::angle, number("initial.qd", {0, 0, 0}, Source::lecture, {-1e6, 1e6}, "rad/s",
                                               "Joint rates at the start; 10 deg means 10 deg/s.")));
    append_wall(keys);
    append_controller(keys);
    append_for_laws(keys, with_a_path, reference_keys());
    append_for_laws(keys, of_force, force_reference_keys());
    append_for_laws(keys, with_a_sensor, sampling_keys());
    append_observer(keys);
    append_push(keys);
    append_solver(keys);
    keys.push_back(
        number("time.stop", {10}, Source::ours, an_instant, "s", "End of the run; one at time.start gives one row."));
    keys.push_back(
        number("time.log_every", {0.01}, Source::ours, {1e-12, 1e9}, "s",
               "Time between rows; the start and the end are always rows, and the log never changes the steps."));
    keys.push_back(number("time.start", {0}, Source::ours, an_instant, "s",
                          "Start of the run: rows, samples and fixed steps count from it, and `initial` holds there. "
                          "wall.point stays the place at t = 0, and no other key is shifted."));
    keys.push_back(log_columns());
    connect(keys);
    return keys;
}

const std::map<std::string, const Key*, std::less<>>& by_path() {
    static const auto index = [] {
        std::map<std::string, const Key*, std::less<>> paths;
        for (const Key& key : schema()) paths[key.path] = &key;
        return paths;
    }();
    return index;
}

}  // namespace

const std::vector<Key>& schema() {
    static const std::vector<Key> keys = make_schema();
    return keys;
}

const Key* find_key(std::string_view path) {
    const auto found = by_path().find(path);
    return found == by_path().end() ? nullptr : found->second;
}

const Key& known_key(std::string_view path) {
    const Key* key = find_key(path);
    if (!key) throw Error(ARM3R_E_INTERNAL, "no key '" + std::string(path) + "' in the schema");
    return *key;
}

const char* kind_name(Kind kind) {
    constexpr const char* names[] = {"number", "angle", "integer", "flag", "choice", "section", "column"};
    return names[static_cast<std::size_t>(kind)];
}

const Key& key_at(std::size_t index) {
    for (const Key& key : schema())
        if (index < key.offset + key.size) return key;
    throw Error(ARM3R_E_INDEX,
                "there is no parameter " + std::to_string(index) + "; there are " + std::to_string(param_count()));
}

std::size_t param_count() {
    const Key& last = schema().back();
    return last.offset + last.size;
}

std::string param_name(std::size_t index) {
    const Key& key = key_at(index);
    return key.size == 1 ? key.path : key.path + "[" + std::to_string(index - key.offset) + "]";
}

std::size_t param_index(std::string_view name) {
    const std::size_t bracket = name.find('[');
    const Key* key = find_key(name.substr(0, bracket));
    if (key && bracket == name.npos && (key->size == 1 || key->form != Form::fixed)) return key->offset;
    if (key && bracket != name.npos) {
        std::size_t item = key->size;
        const char* end = name.data() + name.size();
        const auto [stop, error] = std::from_chars(name.data() + bracket + 1, end, item);
        if (error == std::errc() && stop + 1 == end && *stop == ']' && item < key->size) return key->offset + item;
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < param_count(); ++i) names.push_back(param_name(i));
    const std::string near = key ? param_name(key->offset) : nearest(name, names);
    throw Error(ARM3R_E_INDEX, {{.code = "argument.parameter",
                                 .path = std::string(name),
                                 .message = "no parameter has this name",
                                 .hint = near.empty() ? "" : "did you mean " + near + "?"}});
}

std::string list_sizes(const Key& key) {
    return (key.form == Form::list ? std::to_string(key.min_size) + " to " : "") + std::to_string(key.size);
}

bool takes_list(const Key& key, std::span<const double> params) { return choice_of(params, key.when_key) == key.word; }

std::vector<double> default_of(const Key& key, std::span<const double> params) {
    std::vector<double> value = key.fallback;
    if (!key.fallback_for.empty())
        if (const auto other = key.fallback_for.find(choice_of(params, *key.decided_by));
            other != key.fallback_for.end())
            return other->second;
    const bool link1_by_shape =
        key.path.starts_with("arm.link1.") && !key.unset.empty() && choice_of(params, "arm.link1.shape") != "explicit";
    if (link1_by_shape) std::fill(value.begin(), value.end(), unset);
    if (key.path == "wall.contact.stiffness") value[0] = default_stiffness(params, value[0]);
    if (key.path == "initial.q" && choice_of(params, "arm.convention") == "slide")
        value = {value[0], -value[1], -value[2]};
    return value;
}

std::vector<double> param_defaults() {
    std::vector<double> params(param_count(), 0.0);
    for (const Key& key : schema()) {
        const std::vector<double> value = default_of(key, params);
        std::copy(value.begin(), value.end(), params.begin() + static_cast<std::ptrdiff_t>(key.offset));
    }
    return params;
}

double param(std::span<const double> params, std::string_view path, std::size_t item) {
    return params[known_key(path).offset + item];
}

const std::string& choice_of(std::span<const double> params, const Key& key) {
    const double stored = params[key.offset];
    if (std::isnan(stored) && key.plant) return choice_of(params, *key.plant);
    return key.choices.at(static_cast<std::size_t>(stored));
}

const std::string& choice_of(std::span<const double> params, std::string_view path) {
    return choice_of(params, known_key(path));
}

double choice_index(const Key& key, std::string_view word) {
    const auto found = std::ranges::find(key.choices, word);
    if (found == key.choices.end())
        throw Error(ARM3R_E_INTERNAL, "no choice '" + std::string(word) + "' at '" + key.path + "' in the schema");
    return static_cast<double>(found - key.choices.begin());
}

bool key_exists(const Key& key, std::span<const double> params) {
    if (!key.decided_by) return true;
    return is_chosen(key, params) && key_exists(*key.decided_by, params);
}

const Key& key_refused(const Key& key, std::span<const double> params) {
    const Key* refused = &key;
    while (is_chosen(*refused, params)) refused = refused->decided_by;
    return *refused;
}

std::vector<std::string> words_without(const Key& key) {
    std::vector<std::string> words = key.decided_by->choices;
    std::erase_if(words, [&](const std::string& word) { return std::ranges::find(key.when, word) != key.when.end(); });
    return words;
}

}  // namespace arm3r
