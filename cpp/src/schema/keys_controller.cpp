// The keys of the controller: which law takes which gain. The laws themselves: docs/model.md, section 7.

#include "schema/keys.hpp"

#include <algorithm>

#include "schema/choice_words.hpp"
#include "schema/key_builders.hpp"

namespace arm3r {
namespace {

Words with_a_torque() {
    return laws_that([](const LawProperties& law) { return law.type != ControllerType::none; });
}
Words with_a_model() {
    return laws_that([](const LawProperties& law) { return law.has_model; });
}
Words controlling_force() {
    return laws_that([](const LawProperties& law) { return law.controls_force; });
}
Words integrating_force() {
    return laws_that([](const LawProperties& law) { return law.integrates_force; });
}

// A gain per axis, or one for all three.
Key gain(const std::string& name, double fallback, std::string unit, std::string doc) {
    return with_form(Form::number_or_vector, number("controller." + name, {fallback, unset, unset}, Source::ours,
                                                    not_negative, std::move(unit), std::move(doc)));
}

Key one_gain(const std::string& name, double fallback, Bounds bounds, std::string unit, std::string doc) {
    return number("controller." + name, {fallback}, Source::ours, bounds, std::move(unit), std::move(doc));
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
        if (key.when_key.empty()) key = for_laws(with_a_model(), key);
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
        for_laws(integrating_force(), one_gain("force_mass", 1, {1e-6, 1e9}, "kg", "Apparent mass along the normal.")));
    keys.push_back(for_laws({"operational_space", "hybrid"},
                            one_gain("force_damping", 70, not_negative, "N s/m", "Damping along the normal.")));
    keys.push_back(for_laws(integrating_force(),
                            one_gain("force_gain", 0.5, not_negative, "", "Proportional gain of the force error.")));
    keys.push_back(
        for_laws(integrating_force(), but({{"parallel", {6}}}, one_gain("force_integral_gain", 5, not_negative, "1/s",
                                                                        "Gain of the integral of the force error."))));
    keys.push_back(for_laws(integrating_force(),
                            or_infinite(one_gain("integral_limit", infinite, not_negative, "N s",
                                                 "Limit of the integral of the force error, in both directions."))));
    keys.push_back(for_laws(
        integrating_force(),
        choice(
            "controller.anti_windup", words_of<AntiWindup>(), Source::ours,
            "How the integral of the force error behaves while a torque is at its limit: it continues, waits, or runs back.")));
    keys.push_back(
        where("controller.anti_windup", {"back_calculation"},
              one_gain("tracking_time", 0.1, {1e-6, 1e6}, "s",
                       "Time constant with which back-calculation returns the integral of the force error.")));
    keys.push_back(for_laws(
        controlling_force(),
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

}  // namespace

void append_controller(std::vector<Key>& keys) {
    keys.push_back(choice("controller.type", words_of<ControllerType>(), Source::ours, "The control law."));
    keys.push_back(
        for_laws({"constant"}, needed(number("controller.torque", {unset, unset, unset}, Source::ours, {-1e12, 1e12},
                                             "N m", "The constant torque, in the arm's convention."))));
    keys.push_back(for_laws(
        with_a_model(),
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
        with_a_torque(),
        choice("controller.saturation", words_of<Saturation>(), Source::ours,
               "At arm.torque_limit: each joint for itself, or all by one factor, which keeps the direction.")));
    append_model(keys);
}

}  // namespace arm3r
