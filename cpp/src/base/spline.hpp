#pragma once
// The smoothest curve through points: the one from rest to rest with the smallest integral of squared jerk.

#include <span>

namespace arm3r {

// Its velocities v and accelerations a at the points s, given at instants t that increase, 2 to 16 of each. Between the
// points it is a quintic; its first four derivatives are continuous; through two points it is the minimum-jerk motion.
void minimum_jerk_through(std::span<const double> t, std::span<const double> s, std::span<double> v,
                          std::span<double> a);

}  // namespace arm3r
