#pragma once
// Metrics of a controller's performance, lane by lane; docs/model.md (8.10). A segment is a part of a step without
// jumps. It is sampled at the nodes of a quadrature rule, and elsewhere too if a maximum or a limit may lie between
// them.

#include <algorithm>
#include <array>
#include <limits>

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/numbers/widths.hpp"
#include "record/row.hpp"
#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// The sampled quantities at one instant.
template <class T>
struct PerformanceSample {
    T force{0.0}, desired_force{0.0};  // N, normal
    T path_error_2{0.0};               // m^2: of the tip; where force is controlled, along the wall only
    T saturated{0.0};                  // 1 where a torque is at its limit
};

template <class T, class M>
ARM3R_INLINE PerformanceSample<T> select_sample(const M& here, const PerformanceSample<T>& a,
                                                const PerformanceSample<T>& b) {
    return {select(here, a.force, b.force), select(here, a.desired_force, b.desired_force),
            select(here, a.path_error_2, b.path_error_2), select(here, a.saturated, b.saturated)};
}

// The quantities that metrics need.
struct TrackedQuantities {
    bool force = false, path = false, limits = false;
    // Of the force: the shortfall, the overshoot above a force that changes (above a constant one the largest force tells
    // it), and when it settles. Of the path: the largest distance.
    bool shortfall = false, overshoot = false, settling = false, path_maximum = false;

    bool motion() const { return force || path; }
    bool anything() const { return motion() || limits; }
};

// Those of the wanted metrics that the law tracks, and torque limits if there are any.
inline TrackedQuantities tracked_quantities(const Setup& setup) {
    using enum MetricGroup;
    const Controller<double>& controller = setup.controller();
    const auto wants = [&](MetricGroup group) { return setup.metrics.wants(group); };
    const bool has_force = tracks_force(controller.type), has_path = tracks_path(controller.type);
    TrackedQuantities tracked;
    tracked.shortfall = has_force && wants(force_extremes);
    tracked.overshoot = tracked.shortfall && controller.reference.force_profile != ForceProfile::constant;
    tracked.settling = has_force && wants(settling);
    tracked.force = tracked.shortfall || tracked.settling || (has_force && wants(force_error));
    tracked.path_maximum = has_path && wants(path_maximum);
    tracked.path = tracked.path_maximum || (has_path && wants(path_error));
    tracked.limits = setup.plant.arm.has_torque_limit && wants(saturation);
    return tracked;
}

// A quadrature rule on [0, 1] with nodes at both ends and between.
template <std::size_t n>
struct Rule {
    std::array<double, n> node, weight;
};
inline constexpr Rule<2> trapezoid{{0, 1}, {0.5, 0.5}};
inline constexpr Rule<3> simpson{{0, 0.5, 1}, {1.0 / 6, 4.0 / 6, 1.0 / 6}};
inline constexpr Rule<5> boole{{0, 0.25, 0.5, 0.75, 1}, {7.0 / 90, 32.0 / 90, 12.0 / 90, 32.0 / 90, 7.0 / 90}};
inline constexpr Rule<7> lobatto{
    {0, 0.08488805186071657, 0.2655756032646429, 0.5, 0.7344243967353571, 0.9151119481392834, 1},
    {1.0 / 42, 0.13841302368078295, 0.21587269060493133, 128.0 / 525, 0.21587269060493133, 0.13841302368078295,
     1.0 / 42}};
inline constexpr std::size_t max_segment_samples = 7;

template <class T>
struct Segment {
    using Mask = typename Lanes<T>::Mask;

    T start{0.0}, duration{0.0};  // s
    Mask touching = false;        // in contact during the segment
    std::array<PerformanceSample<T>, max_segment_samples> samples;
};

// An instant just before t: the end of a segment, where a formula of time may jump, is evaluated before the jump.
template <class T>
ARM3R_INLINE T slightly_before(const T& t) {
    using Limits = std::numeric_limits<double>;
    return t - (Limits::epsilon() * abs(t) + Limits::denorm_min());  // before 0, too
}

// ---- samples

// The squared distance of the tip from its reference; joint angles are converted by the true arm.
template <class P, class L, class T>
ARM3R_INLINE T path_error_2(const Arm<P>& arm, const Controller<L>& controller, const T& t, const Vec3<T>& tip,
                            const Vec3<T>& n, const T& force_phase) {
    const DesiredMotion<T> desired = desired_motion_at(controller.reference, t);
    const Vec3<T> goal = controller.reference.in_joints ? tip_position(arm, pose(desired.position)) : desired.position;
    Vec3<T> off = minus(tip, goal);
    if (tracks_force(controller.type)) off = minus(off, scaled(T(force_phase * dot(n, off)), n));
    return dot(off, off);
}

// Force and path error. `pressed`: where the contact law acts.
template <class P, class L, class T, class M>
ARM3R_INLINE void sample_motion(const TrackedQuantities& tracked, const Plant<P>& plant, const Contact<P>& contact,
                                const Controller<L>& controller, const T& t, const Pose<T>& p, const WallState<T>& wall,
                                const Indentation<T>& in, const M& pressed, const T& force_phase,
                                PerformanceSample<T>& sample) {
    const T o(0.0);
    if (tracked.force) {
        sample.force = select(pressed, max(o, normal_force_law(contact, in).total), o);
        sample.desired_force = desired_force_at(controller.reference, t);
    }
    if (tracked.path)
        sample.path_error_2 =
            path_error_2(plant.arm, controller, t, tip_position(plant.arm, p), normal(plant.wall, wall), force_phase);
}

template <class P, class T>
ARM3R_INLINE void sample_saturation(const Arm<P>& arm, const Vec3<T>& tau, PerformanceSample<T>& sample) {
    if (!arm.has_torque_limit) return;
    sample.saturated = T(0.0);
    for (int i = 0; i < 3; ++i) sample.saturated = select(abs(tau[i]) >= arm.torque_limit[i], T(1.0), sample.saturated);
}

// ---- sums over the run

template <class T>
struct PerformanceSums {
    T touching_time{0.0}, force_error_2{0.0};
    T reached{0.0};                        // 1 once the force has reached the desired one
    T max_shortfall{0.0}, overshoot{0.0};  // N, below the desired force since then, and above it
    T unsettled_until{-infinite};          // s
    T path_2{0.0}, max_path_2{0.0}, saturated_time{0.0};
    Vec3<T> work{T(0.0), T(0.0), T(0.0)};  // J, of each torque
};

template <class F, class... Sums>
ARM3R_INLINE void each_sum(F f, Sums&... t) {
    f(t.touching_time...), f(t.force_error_2...), f(t.reached...), f(t.max_shortfall...), f(t.overshoot...);
    f(t.unsettled_until...), f(t.path_2...), f(t.max_path_2...), f(t.saturated_time...);
    f(t.work[0]...), f(t.work[1]...), f(t.work[2]...);
}

inline constexpr double settling_band = 0.05;

template <class T>
ARM3R_INLINE T force_error_of(const PerformanceSample<T>& sample) {
    return sample.desired_force - sample.force;
}
// Positive where the force is outside its band.
template <class T>
ARM3R_INLINE T band_excess_of(const PerformanceSample<T>& sample) {
    return abs(force_error_of(sample)) - settling_band * abs(sample.desired_force);
}

// A bound for a quantity around node j of a rule: the maximum of the parabola through the node and its two neighbours,
// plus its height above the highest of them. Minus infinity if the parabola has no maximum between them.
template <std::size_t n, class T, class F>
ARM3R_INLINE T peak_bound_around(const Rule<n>& rule, const Segment<T>& segment, F quantity, std::size_t j) {
    const double before = rule.node[j] - rule.node[j - 1], after = rule.node[j + 1] - rule.node[j];
    const T a = quantity(segment.samples[j - 1]), b = quantity(segment.samples[j]),
            c = quantity(segment.samples[j + 1]);
    const T rise = (b - a) * (1 / before), fall = (c - b) * (1 / after);
    const T bend = (fall - rise) * (1 / (before + after));
    const T slope = rise - bend * before;  // at the first of the three nodes
    const auto turns = slope > T(0.0) && fall + bend * after < T(0.0);
    if (!in_any_lane(turns)) return T(-infinite);  // without the division
    const T top = a - slope * slope / (4.0 * select(turns, bend, T(-1.0)));
    return select(turns, T(2.0 * top - max(a, max(b, c))), T(-infinite));
}

template <std::size_t n, class T, class F>
ARM3R_INLINE T peak_bound(const Rule<n>& rule, const Segment<T>& segment, F quantity) {
    T highest(-infinite);
    for (std::size_t j = 1; j + 1 < n; ++j) highest = max(highest, peak_bound_around(rule, segment, quantity, j));
    return highest;
}

template <std::size_t n, class T, class F>
ARM3R_INLINE T mean_of(const Rule<n>& rule, const Segment<T>& segment, F quantity) {
    T sum(0.0);
    for (std::size_t j = 0; j < n; ++j) sum = sum + rule.weight[j] * quantity(segment.samples[j]);
    return sum;
}

template <std::size_t n, class T, class F>
ARM3R_INLINE T max_of(const Segment<T>& segment, F quantity) {
    T most = quantity(segment.samples[0]);
    for (std::size_t j = 1; j < n; ++j) most = max(most, T(quantity(segment.samples[j])));
    return most;
}

// The overshoot, and the shortfall since the force has reached the desired one.
template <std::size_t n, class T, class M>
ARM3R_INLINE M add_force_extremes(const TrackedQuantities& tracked, const Rule<n>& rule, const M& in_touch,
                                  const Segment<T>& segment, PerformanceSums<T>& sums) {
    const T o(0.0);
    const auto shortfall = [](const PerformanceSample<T>& s) ARM3R_INLINE_LAMBDA { return force_error_of(s); };
    const auto excess = [](const PerformanceSample<T>& s) ARM3R_INLINE_LAMBDA { return T(-force_error_of(s)); };
    const auto after = in_touch && sums.reached > o, before = in_touch && !(sums.reached > o);
    M unresolved = false;
    sums.max_shortfall = max_where(after, sums.max_shortfall, max_of<n>(segment, shortfall));
    if (tracked.overshoot || in_any_lane(before)) {
        const T most = max_of<n>(segment, excess), top = peak_bound(rule, segment, excess);
        if (tracked.overshoot) {
            sums.overshoot = max_where(in_touch, sums.overshoot, most);
            unresolved = in_touch && top > sums.overshoot;
        }
        unresolved = unresolved || (before && max(most, top) >= o);
    }
    if (in_any_lane(after))
        unresolved = unresolved || (after && peak_bound(rule, segment, shortfall) > sums.max_shortfall);
    return unresolved;
}

// The instant until which the force is outside its band.
template <std::size_t n, class T, class M>
ARM3R_INLINE M add_settling(const Rule<n>& rule, const M& moved, const Segment<T>& segment, PerformanceSums<T>& sums) {
    const auto band_excess = [](const PerformanceSample<T>& s) ARM3R_INLINE_LAMBDA { return band_excess_of(s); };
    const auto ends_unsettled = moved && band_excess_of(segment.samples[n - 1]) > T(0.0);
    sums.unsettled_until = select(ends_unsettled, T(segment.start + segment.duration), sums.unsettled_until);
    const auto ends_settled = moved && !ends_unsettled;
    if (!in_any_lane(ends_settled)) return false;
    return ends_settled && max(max_of<n>(segment, band_excess), peak_bound(rule, segment, band_excess)) > T(0.0);
}

// The force error in a segment: its mean square, and its extremes and its band where they are tracked. Returns the lanes
// in which one of these may lie between the samples.
template <std::size_t n, class T, class M>
ARM3R_INLINE M add_force(const TrackedQuantities& tracked, const Rule<n>& rule, const M& moved,
                         const Segment<T>& segment, PerformanceSums<T>& sums) {
    const T o(0.0), dt = select(moved, segment.duration, o);
    const auto square = [](const PerformanceSample<T>& s)
                            ARM3R_INLINE_LAMBDA { return T(force_error_of(s) * force_error_of(s)); };
    const auto in_touch = moved && segment.touching;
    sums.touching_time = sums.touching_time + select(in_touch, dt, o);
    sums.force_error_2 = sums.force_error_2 + select(in_touch, T(dt * mean_of(rule, segment, square)), o);
    M extremes = false, band = false;  // all are added, whatever another one says: so no || with a call
    if (tracked.shortfall) extremes = add_force_extremes(tracked, rule, M(in_touch), segment, sums);
    if (tracked.settling) band = add_settling(rule, moved, segment, sums);
    return extremes || band;
}

// The squared distance of the tip from its reference in a segment.
template <std::size_t n, class T, class M>
ARM3R_INLINE M add_path(const TrackedQuantities& tracked, const Rule<n>& rule, const M& moved,
                        const Segment<T>& segment, PerformanceSums<T>& sums) {
    const auto square = [](const PerformanceSample<T>& s) ARM3R_INLINE_LAMBDA { return s.path_error_2; };
    sums.path_2 = sums.path_2 + select(moved, T(segment.duration * mean_of(rule, segment, square)), T(0.0));
    if (!tracked.path_maximum) return false;
    sums.max_path_2 = max_where(moved, sums.max_path_2, max_of<n>(segment, square));
    return moved && peak_bound(rule, segment, square) > sums.max_path_2;
}

// The time in a segment in which a torque is at its limit, where that holds in all of the segment or in none.
template <std::size_t n, class T, class M>
ARM3R_INLINE M add_saturation(const Rule<n>& rule, const M& moved, const Segment<T>& segment,
                              PerformanceSums<T>& sums) {
    const T o(0.0), dt = select(moved, segment.duration, o);
    const auto saturated = [](const PerformanceSample<T>& s) ARM3R_INLINE_LAMBDA { return s.saturated; };
    const T share = mean_of(rule, segment, saturated);
    const auto changes = moved && share > o && share < T(1 - 1e-9);
    sums.saturated_time = sums.saturated_time + select(changes, o, T(dt * segment.samples[0].saturated));
    return changes;
}

// Adds a segment, without the works of the torques, where `moved`. Returns the lanes in which it must be refined
// (refine_segment).
template <std::size_t n, class T, class M>
ARM3R_INLINE M add_segment(const TrackedQuantities& tracked, const Rule<n>& rule, const M& moved,
                           const Segment<T>& segment, PerformanceSums<T>& sums) {
    M force = false, path = false, limits = false;
    if (tracked.force) force = add_force(tracked, rule, moved, segment, sums);
    if (tracked.path) path = add_path(tracked, rule, moved, segment, sums);
    if (tracked.limits) limits = add_saturation(rule, moved, segment, sums);
    return force || path || limits;
}

// ---- one lane, in doubles

// Performance samples at any theta of a step, in one contact mode.
struct StepView {
    const Setup& setup;
    const DenseOutput& dense;
    bool pressed = false;                // the contact law acts
    double contact = 0;                  // as a continuous controller knows it
    double force_phase = 0;              // of either kind of controller
    const Vec3<double>* held = nullptr;  // N m, the torque of a sampled controller
    // s: formulas of time are evaluated between these instants
    double latest = infinite, earliest = -infinite;

    PerformanceSample<double> operator()(double theta) const;
    // The same, and the power of each torque in W.
    PerformanceSample<double> with_power(double theta, Vec3<double>& power) const;
    // Force and path error alone, those that are wanted.
    PerformanceSample<double> motion(double theta, const TrackedQuantities& wanted) const;

private:
    double time(double theta) const { return std::max(earliest, std::min(dense.t0 + theta * dense.h, latest)); }
};

// Refines a segment between the nodes of its rule; it goes from theta = a to b of the step.
template <std::size_t n>
void refine_segment(const Rule<n>& rule, const Segment<double>& segment, const StepView& view, double a, double b,
                    PerformanceSums<double>& sums);

// Adds the whole segment from theta = a to b of the step. Returns the work of each torque in it, in J, which it does not
// add.
template <std::size_t n>
Vec3<double> add_whole_segment(const Rule<n>& rule, bool touching, const StepView& view, double a, double b,
                               PerformanceSums<double>& sums);

// Writes the sums into the metrics.
void write_performance(const PerformanceSums<double>& sums, const Setup& setup, Metrics& metrics);

}  // namespace arm3r
