#pragma once
// Limits of gains and periods for the stability of the linearised control loops; docs/controllers.md. SI units
// throughout.

#include "arm3r/model/dynamics.hpp"

namespace arm3r {

// Whether m s^3 + b s^2 + c s + d is stable; d = 0 stands for a loop without integral.
bool is_stable(double m, double b, double c, double d);

// The largest stable wall stiffness for an admittance M, B, K over a position loop of bandwidth w and damping ratio z.
double admittance_limit(double M, double B, double K, double w, double z);

// The largest stable gain k_r with which an impedance M, B, K on a wall k_e integrates the force error into its
// reference.
double reference_gain_limit(double M, double B, double K, double k_e);

// The longest stable sampling period of an acceleration -Kp e - Kd e'.
double max_period(double Kp, double Kd);

// rad: by how much an oscillation may turn within a period and the delay for a sampled law to foresee its energy (8.8).
inline constexpr double max_foreseen_turn = 0.5;

// The smallest real part of an eigenvalue of M^-1 P, P = J^-1 (I - n n^T) J, on the motion that P does not remove: if
// it is negative, a position loop through J^-1 S_p is unstable.
double projected_mobility(const Arm<double>& arm, const Pose<double>& p, const Vec3<double>& n);

}  // namespace arm3r
