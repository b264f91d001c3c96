#pragma once
// The part of make_setup() (setup.hpp) that concerns what the controller wants.

#include "setup/setup.hpp"

namespace arm3r {

// What the controller of `setup` wants; its model, the wall and the start must be there.
void set_setpoint(std::span<const double> params, const Setup& setup, Setpoint<double>& wanted);

// The joint angles that bring the tip of `arm` to a point (m, base axes): those of the branch that the pose `near` is of, in
// the turn next to it. Meaningless where |cos_q3| > 1.
Reach<double> joints_at(const Arm<double>& arm, const Vec3<double>& tip, const Vec3<double>& near);

}  // namespace arm3r
