#pragma once
// The part of make_setup() (setup.hpp) that concerns the controller.

#include <cmath>

#include "arm3r/plant.hpp"
#include "schema/param_access.hpp"
#include "setup/setup.hpp"

namespace arm3r {

inline bool is_simscape(std::span<const double> params) { return is<"arm.convention", "simscape">(params); }

// A joint vector as it stands in the file, in the slide convention.
inline Vec3<double> to_slide(std::span<const double> params, const Vec3<double>& joint_vector) {
    return is_simscape(params) ? flipped(joint_vector) : joint_vector;
}

// The word that a choice stands at; the enumerators are in the order of the schema's words.
template <Name path, class Enum>
Enum choice_at(std::span<const double> params) {
    return static_cast<Enum>(static_cast<int>(at<path>(params)));
}

// One number stands for all three axes or joints.
template <Name path>
Vec3<double> each_axis(std::span<const double> params) {
    const Vec3<double> given = vector_at<path>(params);
    return std::isnan(given[1]) ? Vec3<double>(given[0], given[0], given[0]) : given;
}

inline Controls controls_of(std::span<const double> params) { return choice_at<"controller.type", Controls>(params); }

// Whether the law divides by what vanishes in a singular pose.
bool inverts_jacobian(const Controller<double>& controller);

// All but the model and the setpoint.
void set_controller(std::span<const double> params, Controller<double>& controller);

}  // namespace arm3r
