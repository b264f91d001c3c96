#pragma once
// A control law of the user.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

template <class T>
struct ControllerState;

inline constexpr double max_torque = 1e12;  // N m, the maximum torque of a law

// The true state, without sensor errors.
struct GroundTruth {
    Vec3<double> q, qd, f_on_tip;  // rad, rad/s, N
};

// Called at samples only, in order of time, with the true state, the measurements, and the state of the controller;
// tick: number of samples before this one. If it does not return 0, the run ends. tau: N m. Slide convention.
struct UserLaw {
    int (*function)(void* user, double tick, const GroundTruth& truth, const Measurement<double>& sensed,
                    const ControllerState<double>& controller_state, Vec3<double>& tau) = nullptr;
    void* user = nullptr;
    JointConvention convention = {};  // of torques in messages
};

}  // namespace arm3r
