#pragma once
// How well a controller did, in numbers, lane by lane; docs/model.md (8.10). A passage is a piece of a step in which nothing
// jumps. It is looked at where a rule of quadrature asks for it, and anywhere else where a peak or a limit lies between.

#include <array>
#include <limits>

#include "base/lane_access.hpp"
#include "record/row.hpp"
#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// What is looked at, at one instant.
template <class T>
struct Sight {
    T force{0.0}, force_wanted{0.0};        // N, normal
    T path_error_2{0.0};                    // m^2: of the tip; where force is controlled, along the wall only
    T saturated{0.0};                       // 1 where a torque is at its limit
    Vec3<T> power{T(0.0), T(0.0), T(0.0)};  // W, of each torque
};

// What is worth a look: what a law wants, and limits that there are.
struct Looks {
    bool force, path, limits;

    explicit Looks(const Setup& setup)
        : force(wants_force(setup.law().type)),
          path(wants_path(setup.law().type)),
          limits(setup.plant.arm.has_torque_limit) {}
    bool motion() const { return force || path; }
};

// Quadrature over [0, 1] from values at both ends and between.
template <std::size_t n>
struct Rule {
    std::array<double, n> place, weight;
};
inline constexpr Rule<2> trapezoid{{0, 1}, {0.5, 0.5}};
inline constexpr Rule<3> simpson{{0, 0.5, 1}, {1.0 / 6, 4.0 / 6, 1.0 / 6}};
inline constexpr Rule<5> boole{{0, 0.25, 0.5, 0.75, 1}, {7.0 / 90, 32.0 / 90, 12.0 / 90, 32.0 / 90, 7.0 / 90}};
inline constexpr Rule<7> lobatto{
    {0, 0.08488805186071657, 0.2655756032646429, 0.5, 0.7344243967353571, 0.9151119481392834, 1},
    {1.0 / 42, 0.13841302368078295, 0.21587269060493133, 128.0 / 525, 0.21587269060493133, 0.13841302368078295,
     1.0 / 42}};
inline constexpr std::size_t most_sights = 7;

template <class T>
struct Passage {
    using Mask = typename Lanes<T>::Mask;

    T start{0.0}, duration{0.0};  // s
    Mask touching = false;        // contact lasts
    std::array<Sight<T>, most_sights> sights;
    Vec3<T> work{T(0.0), T(0.0), T(0.0)};  // J, of each torque
};

// Just before t: the end of a passage, where a formula of time may jump, is seen from within.
template <class T>
ARM3R_INLINE T short_of(const T& t) {
    return t - std::numeric_limits<double>::epsilon() * abs(t);
}

// ---- what there is to see

// Square of the tip's distance from its reference; of angles, where they put the tip of the true arm.
template <class P, class L, class T>
ARM3R_INLINE T path_error_2(const Arm<P>& arm, const Controller<L>& controller, const T& t, const Vec3<T>& tip,
                            const Vec3<T>& n, const T& force_phase) {
    const Wanted<T> wanted = wanted_at(controller.setpoint, t);
    const Vec3<T> goal = controller.setpoint.in_joints ? tip_position(arm, pose(wanted.position)) : wanted.position;
    const Vec3<T> off = minus(tip, goal);
    const T across = wants_force(controller.type) ? T(force_phase * dot(n, off)) : T(0.0);
    return max(T(0.0), T(dot(off, off) - across * across));
}

// Force and path; `pressed`: where the law of the contact holds.
template <class P, class L, class T, class M>
ARM3R_INLINE void see_motion(const Looks& looks, const Plant<P>& plant, const Contact<P>& contact,
                             const Controller<L>& law, const T& t, const Pose<T>& p, const WallState<T>& wall,
                             const Indentation<T>& in, const M& pressed, const T& force_phase, Sight<T>& sight) {
    const T o(0.0);
    if (looks.force) {
        sight.force = select(pressed, max(o, push(contact, in).total), o);
        sight.force_wanted = force_wanted_at(law.setpoint, t);
    }
    if (looks.path)
        sight.path_error_2 =
            path_error_2(plant.arm, law, t, tip_position(plant.arm, p), normal(plant.wall, wall), force_phase);
}

template <class P, class T>
ARM3R_INLINE void see_torque(const Arm<P>& arm, const Vec3<T>& tau, const Vec3<T>& qd, Sight<T>& sight) {
    for (int i = 0; i < 3; ++i) sight.power[i] = tau[i] * qd[i];
    if (!arm.has_torque_limit) return;
    sight.saturated = T(0.0);
    for (int i = 0; i < 3; ++i) sight.saturated = select(abs(tau[i]) >= arm.torque_limit[i], T(1.0), sight.saturated);
}

// ---- what becomes of it

template <class T>
struct Tally {
    T touching_time{0.0}, miss_2{0.0}, reached{0.0}, largest_miss{0.0}, overshoot{0.0};
    T unsettled_until{-std::numeric_limits<double>::infinity()};  // s
    T path_2{0.0}, largest_path_2{0.0}, saturated_time{0.0};
    Vec3<T> work{T(0.0), T(0.0), T(0.0)};
};

template <class F, class... Tallies>
ARM3R_INLINE void each_tally_number(F f, Tallies&... t) {
    f(t.touching_time...), f(t.miss_2...), f(t.reached...), f(t.largest_miss...), f(t.overshoot...);
    f(t.unsettled_until...), f(t.path_2...), f(t.largest_path_2...), f(t.saturated_time...);
    f(t.work[0]...), f(t.work[1]...), f(t.work[2]...);
}

inline constexpr double settled_share = 0.05;

template <class T>
ARM3R_INLINE T miss_of(const Sight<T>& sight) {
    return sight.force_wanted - sight.force;
}
// Above zero where the force is not within its band.
template <class T>
ARM3R_INLINE T unrest_of(const Sight<T>& sight) {
    return abs(miss_of(sight)) - settled_share * abs(sight.force_wanted);
}

// How high a quantity may rise around place j of a rule: to the top of the parabola through it and its two neighbours, and
// as far again above the highest of them. Minus infinity where the parabola has no top between them.
template <std::size_t n, class T, class F>
ARM3R_INLINE T top_around(const Rule<n>& rule, const Passage<T>& passage, F quantity, std::size_t j) {
    const double before = rule.place[j] - rule.place[j - 1], after = rule.place[j + 1] - rule.place[j];
    const T a = quantity(passage.sights[j - 1]), b = quantity(passage.sights[j]), c = quantity(passage.sights[j + 1]);
    const T rise = (b - a) * (1 / before), fall = (c - b) * (1 / after);
    const T bend = (fall - rise) * (1 / (before + after));
    const T slope = rise - bend * before;  // at the first of the three
    const auto turns = slope > T(0.0) && fall + bend * after < T(0.0);
    const T top = a - slope * slope / (4.0 * select(turns, bend, T(-1.0)));
    return select(turns, T(2.0 * top - max(a, max(b, c))), T(-std::numeric_limits<double>::infinity()));
}

template <std::size_t n, class T, class F>
ARM3R_INLINE T top_between(const Rule<n>& rule, const Passage<T>& passage, F quantity) {
    T highest(-std::numeric_limits<double>::infinity());
    for (std::size_t j = 1; j + 1 < n; ++j) highest = max(highest, top_around(rule, passage, quantity, j));
    return highest;
}

template <std::size_t n, class T, class F>
ARM3R_INLINE T mean_of(const Rule<n>& rule, const Passage<T>& passage, F quantity) {
    T sum(0.0);
    for (std::size_t j = 0; j < n; ++j) sum = sum + rule.weight[j] * quantity(passage.sights[j]);
    return sum;
}

template <std::size_t n, class T, class F>
ARM3R_INLINE T highest_of(const Passage<T>& passage, F quantity) {
    T most = quantity(passage.sights[0]);
    for (std::size_t j = 1; j < n; ++j) most = max(most, T(quantity(passage.sights[j])));
    return most;
}

// Adds a passage, where `moved`; returns where it has to be looked at more closely (look_closer).
template <std::size_t n, class T, class M>
ARM3R_INLINE M add_passage(const Looks& looks, const Rule<n>& rule, const M& moved, const Passage<T>& passage,
                           Tally<T>& tally) {
    const T o(0.0), dt = select(moved, passage.duration, o);
    for (int i = 0; i < 3; ++i) tally.work[i] = tally.work[i] + select(moved, passage.work[i], o);
    M closer = false;
    if (looks.force) {
        const auto miss = [](const Sight<T>& s) ARM3R_INLINE_LAMBDA { return miss_of(s); };
        const auto excess = [](const Sight<T>& s) ARM3R_INLINE_LAMBDA { return T(-miss_of(s)); };
        const auto unrest = [](const Sight<T>& s) ARM3R_INLINE_LAMBDA { return unrest_of(s); };
        const auto square = [](const Sight<T>& s) ARM3R_INLINE_LAMBDA { return T(miss_of(s) * miss_of(s)); };
        const auto in_touch = moved && passage.touching, after = in_touch && tally.reached > o;
        const T most = highest_of<n>(passage, excess), least = highest_of<n>(passage, miss);
        tally.touching_time = tally.touching_time + select(in_touch, dt, o);
        tally.miss_2 = tally.miss_2 + select(in_touch, T(dt * mean_of(rule, passage, square)), o);
        tally.overshoot = max_where(in_touch, tally.overshoot, most);
        tally.largest_miss = max_where(after, tally.largest_miss, max(most, least));
        const auto ends_unsettled = moved && unrest_of(passage.sights[n - 1]) > o;
        tally.unsettled_until = select(ends_unsettled, T(passage.start + passage.duration), tally.unsettled_until);
        const T top = top_between(rule, passage, excess);
        closer = closer || (in_touch && (top > tally.overshoot || (!(tally.reached > o) && max(most, top) >= o)));
        closer = closer || (after && max(top, top_between(rule, passage, miss)) > tally.largest_miss);
        const T unrest_within = max(highest_of<n>(passage, unrest), top_between(rule, passage, unrest));
        closer = closer || (moved && !ends_unsettled && unrest_within > o);
    }
    if (looks.path) {
        const auto square = [](const Sight<T>& s) ARM3R_INLINE_LAMBDA { return s.path_error_2; };
        tally.path_2 = tally.path_2 + dt * mean_of(rule, passage, square);
        tally.largest_path_2 = max_where(moved, tally.largest_path_2, highest_of<n>(passage, square));
        closer = closer || (moved && top_between(rule, passage, square) > tally.largest_path_2);
    }
    if (looks.limits) {
        const auto saturated = [](const Sight<T>& s) ARM3R_INLINE_LAMBDA { return s.saturated; };
        const T share = mean_of(rule, passage, saturated);
        const auto changes = moved && share > T(0.0) && share < T(1 - 1e-9);
        tally.saturated_time = tally.saturated_time + select(changes, o, T(dt * passage.sights[0].saturated));
        closer = closer || changes;
    }
    return closer;
}

// ---- one lane, in doubles

// What there is to see within a step in one mode of contact, at any share theta of the step.
struct StepView {
    const Setup& setup;
    const Inside& inside;
    bool pressed = false;                                     // the law of the contact holds
    double contact = 0;                                       // as a continuous controller takes it
    double force_phase = 0;                                   // of whatever controller there is
    const Vec3<double>* held = nullptr;                       // N m, the torque of a digital one
    double latest = std::numeric_limits<double>::infinity();  // s: formulas of time alone hold until then

    Sight<double> operator()(double theta) const;
};

// What lies between the places of a rule; the passage goes from place a to place b of the step.
template <std::size_t n>
void look_closer(const Rule<n>& rule, const Passage<double>& passage, const StepView& view, double a, double b,
                 Tally<double>& tally);

// The passage from place a to place b of the step, all of it.
template <std::size_t n>
void add_alone(const Rule<n>& rule, bool touching, const StepView& view, double a, double b, Tally<double>& tally);

// Into the metrics.
void tell_score(const Tally<double>& tally, const Setup& setup, Metrics& metrics);

}  // namespace arm3r
