#pragma once
// The part of make_setup() (setup.hpp) that concerns the controller.

#include <cmath>

#include "arm3r/plant.hpp"
#include "schema/param_access.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// One number is used for all three axes or joints.
template <Name path>
Vec3<double> each_axis(std::span<const double> params) {
    const Vec3<double> given = vector_at<path>(params);
    return std::isnan(given[1]) ? Vec3<double>(given[0], given[0], given[0]) : given;
}

inline ControllerType controller_type_of(std::span<const double> params) {
    return choice_at<"controller.type", ControllerType>(params);
}

// Whether the law inverts the Jacobian, which is singular in some poses.
bool inverts_jacobian(const Controller<double>& controller);

// Sets all but the model and the reference.
void set_controller(std::span<const double> params, Controller<double>& controller);

}  // namespace arm3r
