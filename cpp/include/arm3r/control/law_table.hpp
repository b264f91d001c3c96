#pragma once
// The list of the control laws: the word that chooses each, and what sets it apart. Words of the schema, reading and rules
// follow from it; the laws themselves: control_laws.hpp.

#include <array>
#include <cstddef>
#include <string_view>

namespace arm3r {

enum class ControllerType {
    none,
    constant,
    gravity_compensation,
    joint_pd,
    computed_torque,
    resolved_acceleration,
    stiffness,
    joint_stiffness,
    impedance,
    shaped_impedance,
    operational_space,
    hybrid,
    parallel,
    admittance,
    adaptive_reference,
    energy_tank,
    virtual_wall,
    user,
};

enum : std::size_t { law_memory = 6 };  // numbers that a law remembers at most

struct LawProperties {
    ControllerType type;
    std::string_view word;          // of controller.type
    bool has_model = false;         // a copy of the arm, and a gravity that it compensates
    bool has_gains = false;         // more than a formula without gains: a file of its own
    bool follows_path = false;      // a reference
    bool in_joints = false;         // in joint angles, else in positions of the tip
    bool takes_force = false;       // reference.force
    bool controls_force = false;    // it brings the contact force to reference.force
    bool may_cancel_force = false;  // the contact moves nothing, if controller.cancel_force says so
    bool integrates_force = false;  // the integral of the force error is the first number that it remembers
    std::size_t memory = 0;         // numbers that it remembers; what each of them is, its formula says
};

// In the order of the enumerators.
inline constexpr std::array law_table = [] {
    constexpr auto basic = [](ControllerType type, std::string_view word) {
        return LawProperties{.type = type, .word = word};
    };
    constexpr auto with_model = [](ControllerType type, std::string_view word) {
        return LawProperties{.type = type, .word = word, .has_model = true};
    };
    constexpr auto motion = [](ControllerType type, std::string_view word, bool in_joints) {
        return LawProperties{.type = type,
                             .word = word,
                             .has_model = true,
                             .has_gains = true,
                             .follows_path = true,
                             .in_joints = in_joints};
    };
    constexpr auto cancelling = [](LawProperties law) {
        law.may_cancel_force = true;
        return law;
    };
    constexpr auto remembering = [](LawProperties law, std::size_t memory) {
        law.memory = memory;
        return law;
    };
    constexpr auto pressing = [](LawProperties law, bool controls, bool integrates) {
        law.takes_force = true;
        law.controls_force = controls;
        law.integrates_force = integrates;
        return law;
    };
    using enum ControllerType;
    LawProperties without_path = with_model(virtual_wall, "virtual_wall");
    without_path.has_gains = true;
    return std::array{
        basic(none, "none"),
        basic(constant, "constant"),
        with_model(gravity_compensation, "gravity_compensation"),
        motion(joint_pd, "joint_pd", true),
        cancelling(motion(computed_torque, "computed_torque", true)),
        cancelling(motion(resolved_acceleration, "resolved_acceleration", false)),
        motion(stiffness, "stiffness", false),
        motion(joint_stiffness, "joint_stiffness", true),
        motion(impedance, "impedance", false),
        motion(shaped_impedance, "shaped_impedance", false),
        remembering(pressing(motion(operational_space, "operational_space", false), true, true), 1),
        remembering(pressing(motion(hybrid, "hybrid", false), true, true), 1),
        remembering(pressing(motion(parallel, "parallel", false), true, true), 1),
        remembering(pressing(motion(admittance, "admittance", false), false, false), law_memory),
        remembering(pressing(motion(adaptive_reference, "adaptive_reference", false), true, false), 1),
        remembering(motion(energy_tank, "energy_tank", false), 1),
        without_path,
        basic(user, "user"),
    };
}();
static_assert([] {
    for (std::size_t i = 0; i < law_table.size(); ++i)
        if (law_table[i].type != ControllerType(i)) return false;
    return law_table.back().type == ControllerType::user;
}());

constexpr const LawProperties& properties(ControllerType type) { return law_table[std::size_t(type)]; }

constexpr bool has_law(ControllerType type) { return properties(type).has_gains; }
constexpr bool has_model(ControllerType type) { return properties(type).has_model; }
constexpr bool tracks_path(ControllerType type) { return properties(type).follows_path; }
constexpr bool is_in_joints(ControllerType type) { return properties(type).in_joints; }
constexpr bool tracks_force(ControllerType type) { return properties(type).controls_force; }
constexpr bool integrates_force(ControllerType type) { return properties(type).integrates_force; }
constexpr bool may_cancel_force(ControllerType type) { return properties(type).may_cancel_force; }
constexpr std::size_t memory_size(ControllerType type) { return properties(type).memory; }

}  // namespace arm3r
