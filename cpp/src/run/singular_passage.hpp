#pragma once
// Where the arm passes a singular pose within a step: there a factor of det J (2.8) changes its sign, sin q3 or the
// signed distance r of the tip from the axis of joint 1.

#include <optional>

#include "integrate/dense_output.hpp"

namespace arm3r {

// The first theta in [0, end] of the step at which one of them does.
std::optional<double> first_passage(const Arm<double>& arm, const DenseOutput& dense, double end);

}  // namespace arm3r
