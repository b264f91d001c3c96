#pragma once
// The model functions on many states, eight side by side; each state gets the bits of its formula in double.

#include <array>
#include <cstddef>

#include "arm3r/model/arm.hpp"

namespace arm3r {

struct Model {
    Arm<double> arm;
    JointConvention convention;  // of the joint vectors in the rows
};

// Arrays with one row per state: input rows of 3, where null means zeros, and output rows of `width`.
struct StateRows {
    struct Out {
        double* data;
        std::size_t width;
    };
    std::array<const double*, 4> in;
    std::array<Out, 2> out;
};

// The minimum length of a direction for effective_mass: below it the mass is 0.
inline constexpr double min_length = 1e-100;

// One function of the model on whole groups of eight states; in and out as in arm3r.h.
using GroupFunction = void(const Model& model, std::size_t groups, const StateRows& rows);

namespace in_groups {
GroupFunction tip_position, elbow_position, arm_points, centres_of_mass, jacobian, geometric_jacobian, jacobian_dot,
    mass_matrix, coriolis_matrix, velocity_product, gravity_torque, operational_space_inertia, effective_mass,
    manipulability, energy, forward_dynamics, inverse_dynamics, tip_sensor;

// |sin q3|, and the tip's distance from the joint-1 axis: the pose is singular where either vanishes.
GroupFunction singularity;
}  // namespace in_groups

// Any number of states.
void evaluate(GroupFunction& function, const Model& model, std::size_t n, const StateRows& rows);

// Whether every number is finite and within the limit.
bool all_within(const double* data, std::size_t count, double limit);

}  // namespace arm3r
