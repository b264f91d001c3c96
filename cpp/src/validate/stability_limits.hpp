#pragma once
// Gains and periods beyond which a control loop, taken as the linear one that the law makes of it, is no longer stable;
// docs/controllers.md. SI units throughout.

#include "arm3r/model/dynamics.hpp"

namespace arm3r {

// Whether m s^3 + b s^2 + c s + d is stable; d = 0 stands for a loop without integral.
bool is_stable(double m, double b, double c, double d);

// The wall stiffness that an admittance M, B, K bears over a position loop of bandwidth w and damping ratio z.
double admittance_limit(double M, double B, double K, double w, double z);

// The gain k_r with which an impedance M, B, K on a wall k_e may integrate the force error into its reference.
double reference_gain_limit(double M, double B, double K, double k_e);

// How long an acceleration -Kp e - Kd e' may be held.
double longest_period(double Kp, double Kd);

// rad: by how much an oscillation may turn within a period and the delay for a sampled law to foresee its energy (8.8).
inline constexpr double largest_foreseen_turn = 0.5;

// The smallest real part of an eigenvalue of M^-1 P, P = J^-1 (I - n n^T) J, on the motion that P lets through: where it is
// negative, a position loop through J^-1 S_p runs away.
double projected_mobility(const Arm<double>& arm, const Pose<double>& p, const Vec3<double>& n);

}  // namespace arm3r
