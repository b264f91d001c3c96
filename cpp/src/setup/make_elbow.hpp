#pragma once
// The part of make_arm() (setup.hpp) that concerns an elbow arm, and the convention of joint angles.

#include <span>

#include "arm3r/model/arm.hpp"

namespace arm3r {

JointConvention convention_of(std::span<const double> params);

// Sets what is an elbow arm's own: base, links, tip and rotors, and the lengths and masses that any arm has.
void set_elbow(std::span<const double> params, Arm<double>& arm);

}  // namespace arm3r
