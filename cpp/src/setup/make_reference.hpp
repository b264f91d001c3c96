#pragma once
// The part of make_setup() (setup.hpp) that concerns what the controller wants.

#include "setup/setup.hpp"

namespace arm3r {

// Sets the reference of the controller of `setup`; its model, the wall and the initial state must be set before.
void set_reference(std::span<const double> params, const Setup& setup, Reference<double>& reference);

// The joint angles that bring the tip of `arm` to a point (m, base axes): on the branch of the pose `near`, and within
// half a turn of it. Undefined where |cos_q3| > 1.
IkResult<double> joints_at(const Arm<double>& arm, const Vec3<double>& tip, const Vec3<double>& near);

}  // namespace arm3r
