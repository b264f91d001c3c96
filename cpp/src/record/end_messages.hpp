#pragma once
// Why a run ended before its time, in words that every method shares.

#include <array>
#include <string>

namespace arm3r {

std::string at_time(double t);  // " at t = 1.5 s"
std::string step_budget_message(double t);
std::string event_storm_message(double t);
std::string step_collapse_message(double h, double t);
std::string ill_conditioned_message(double t);
// q: rad; qd: rad/s.
std::string divergence_message(const std::array<double, 3>& q, const std::array<double, 3>& qd, double t);

}  // namespace arm3r
