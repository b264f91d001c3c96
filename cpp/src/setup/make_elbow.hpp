#pragma once
// The part of make_arm() (setup.hpp) that concerns an elbow arm, and the convention of joint angles.

#include <span>

#include "arm3r/model/arm.hpp"

namespace arm3r {

JointConvention convention_of(std::span<const double> params);

// Sets what is an elbow arm's own: base, links, tip and rotors, and the lengths and masses that any arm has.
void set_elbow(std::span<const double> params, Arm<double>& arm);

// The least value of something over all poses, and the link angles where it occurs.
struct WorstPose {
    double value;
    double q2, q3;  // rad, slide
};

inline constexpr double min_inertia = 1e-9;  // kg m^2, of joint 1

// Of an elbow arm, on a grid of poses: the least determinant of joints 2 and 3 over the product of their diagonal, the
// least inertia of joint 1 while the others are free, kg m^2, and that over its diagonal.
struct LeastPivots {
    WorstPose lower, first;
    double first_over_diagonal;
};
LeastPivots least_pivots(const Arm<double>& arm);

// Whether the mass matrix of an elbow arm is, by those, far from singular in every pose.
bool is_far_from_singular(const LeastPivots& least);

}  // namespace arm3r
