#pragma once
// Where the arm passes a singular pose within a step: there a factor of det J (2.8) changes its sign, sin q3 or the
// signed distance r of the tip from the axis of joint 1.

#include <optional>

#include "arm3r/model/kinematics.hpp"
#include "arm3r/ode/integrators.hpp"
#include "integrate/dense_output.hpp"

namespace arm3r {

// The first theta in [0, end] of the step at which one of them does.
std::optional<double> first_passage(const Arm<double>& arm, const DenseOutput& dense, double end);

// The first theta of the step at which the arm is 1e-9 from the singular pose (7.21) towards which it moves; nothing where it
// starts as close as that.
std::optional<double> just_before_passage(const Arm<double>& arm, const DenseOutput& dense);

template <class T>
struct ValueAndRate {
    T value, rate;
};

// Whether the cubic with these ends of a step of h has one sign, as far as the corners of its Bezier polygon tell.
template <class T>
ARM3R_INLINE auto has_one_sign(const ValueAndRate<T>& start, const ValueAndRate<T>& end, const T& h) {
    const T third = (1.0 / 3) * h, after = start.value + third * start.rate, before = end.value - third * end.rate;
    const T least = min(min(start.value, end.value), min(after, before)),
            most = max(max(start.value, end.value), max(after, before));
    return least > T(0.0) || most < T(0.0);
}

// Whether the arm may pass a singular pose in a step of h, s, from y0, where its pose is p0, to y1.
template <class P, class T, std::size_t N>
ARM3R_INLINE auto may_pass_singular_pose(const Arm<P>& arm, const Pose<T>& p0, const State<T, N>& y0,
                                         const State<T, N>& y1, const T& h) {
    const auto bend = [&](const Pose<T>& p, const State<T, N>& y) ARM3R_INLINE_LAMBDA {
        return ValueAndRate<T>{sine_of_bend(arm, p), cosine_of_bend(arm, p) * y[5]};
    };
    const auto distance = [&](const Pose<T>& p, const State<T, N>& y) ARM3R_INLINE_LAMBDA {
        return ValueAndRate<T>{radius(arm, p), radius_rate(arm, p, Vec3<T>(y[3], y[4], y[5]))};
    };
    const Pose<T> p1 = pose(Vec3<T>(y1[0], y1[1], y1[2]));
    return !(has_one_sign(bend(p0, y0), bend(p1, y1), h) && has_one_sign(distance(p0, y0), distance(p1, y1), h));
}

}  // namespace arm3r
