#pragma once
// A control law of the user's own.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

template <class T>
struct Known;

inline constexpr double largest_torque = 1e12;  // N m, that a law may ask for

// What is.
struct Truth {
    Vec3<double> q, qd, f_on_tip;  // rad, rad/s, N
};

// Called at samples only, in increasing time. What is, what the controller senses, and what it has made of it so far; tick:
// samples before this one. Not 0: the run ends there. tau: N m. Slide convention.
struct UserLaw {
    int (*function)(void* user, double tick, const Truth& truth, const Sensed<double>& sensed,
                    const Known<double>& known, Vec3<double>& tau) = nullptr;
    void* user = nullptr;
    bool simscape = false;  // how messages write a torque
};

}  // namespace arm3r
