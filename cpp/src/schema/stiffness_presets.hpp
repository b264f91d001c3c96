#pragma once
// Stiffness of parts of the human body, for the contact of a wall: the spring constants of the body model behind the
// power and force limits of ISO/TS 15066:2016, annex A, as three secondary sources agree on them. They have not been
// compared with the standard itself, and are no basis for a safety assessment.

#include <array>
#include <string_view>

namespace arm3r {

struct StiffnessPreset {
    std::string_view name;
    double stiffness;  // N/m
};

inline constexpr std::array stiffness_presets{
    StiffnessPreset{"skull_and_forehead", 150e3},
    StiffnessPreset{"face", 75e3},
    StiffnessPreset{"neck", 50e3},
    StiffnessPreset{"back_and_shoulders", 35e3},
    StiffnessPreset{"chest", 25e3},
    StiffnessPreset{"abdomen", 10e3},
    StiffnessPreset{"pelvis", 25e3},
    StiffnessPreset{"upper_arms_and_elbows", 30e3},
    StiffnessPreset{"lower_arms_and_wrists", 40e3},
    StiffnessPreset{"hands_and_fingers", 75e3},
    StiffnessPreset{"thighs_and_knees", 50e3},
    StiffnessPreset{"lower_legs", 60e3},
};

}  // namespace arm3r
