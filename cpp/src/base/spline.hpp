#pragma once
// The smoothest curve through points: the one from rest to rest with the smallest integral of squared jerk.

#include <span>

#include "arm3r/model/scalar_motion.hpp"

namespace arm3r {

// Its velocities v and accelerations a at the points s, given at instants t that increase, two or more of each. Between the
// points it is a quintic; its first four derivatives are continuous; through two points it is the minimum-jerk motion.
void minimum_jerk_through(std::span<const double> t, std::span<const double> s, std::span<double> v,
                          std::span<double> a);

// Sets v and a of a table that has t and s.
void move_with_minimum_jerk(QuinticTable<double>& table);

}  // namespace arm3r
