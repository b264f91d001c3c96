#pragma once
// The reference of a controller: the desired motion of the arm and the desired force; docs/model.md, section 7.1. These
// are functions of time alone; at a jump they have the value after it. Positions are those of the tip, in base axes, or
// joint angles, in the slide convention.

#include <memory>

#include "arm3r/model/scalar_motion.hpp"
#include "arm3r/numbers/vectors.hpp"
#include "arm3r/numbers/widths.hpp"

namespace arm3r {

enum class Path { hold, point, line, minimum_jerk, circle, sinusoid, table };
constexpr bool is_moving(Path path) { return path != Path::hold && path != Path::point; }
enum class ForceProfile { constant, step, ramp, sinusoid };

struct ReferenceChoices {
    Path path = Path::hold;
    bool in_joints = false;  // whether positions are joint angles
    int knots = 0;           // of a table
    ForceProfile force_profile = ForceProfile::constant;

    bool operator==(const ReferenceChoices&) const = default;
};

template <class P>
struct Reference : ReferenceChoices {
    Vec3<P> from, to;          // m or rad, at the start and at the end
    P start, duration, end;    // s
    Vec3<P> across1, across2;  // m, a circle's: from its centre to its start, and a quarter turn on
    P turns;                   // of the circle
    Vec3<P> amplitude;         // m or rad, of a sinusoid about `from`
    P frequency;               // Hz
    std::shared_ptr<std::array<QuinticTable<P>, 3>> table;  // m, of the tip; allocated separately, as that of a wall
    P force, force_before;                                  // N, along the pressing direction
    P force_start, force_duration;                          // s
    P force_amplitude, force_frequency;                     // N, Hz
};

template <class T>
struct DesiredMotion {
    Vec3<T> position, velocity, acceleration;  // m, m/s, m/s^2, or rad ...
};

// s and its derivatives by x in [0, 1]: 10 x^3 - 15 x^4 + 6 x^5, at rest at both ends (7.1).
template <class T>
struct MinimumJerk {
    T s, ds, dds;
};

template <class T>
ARM3R_INLINE MinimumJerk<T> minimum_jerk(const T& share) {
    const T x = max(T(0.0), min(T(1.0), share)), rest = 1.0 - x;
    return {x * x * x * (10.0 + x * (6.0 * x - 15.0)), 30.0 * (x * x) * (rest * rest),
            60.0 * x * rest * (1.0 - 2.0 * x)};
}

template <class T>
ARM3R_INLINE Vec3<T> zero_vector() {
    return {T(0.0), T(0.0), T(0.0)};
}

// sin and cos of 2 pi cycles.
template <class T>
ARM3R_INLINE SinCos<T> turned(const T& cycles) {
    return sincos(T((cycles - nearest_integer(cycles)) * two_pi));
}

// Not inlined: tables are rare and the code is long.
template <class P, class T>
[[gnu::noinline]] void follow_table(const Reference<P>& reference, const T& t, DesiredMotion<T>& desired) {
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
        for (int i = 0; i < 3; ++i) {
            const ScalarMotion<T> along = scalar_motion((*reference.table)[i], t);
            desired.position[i] = along.s, desired.velocity[i] = along.v, desired.acceleration[i] = along.a;
        }
    });
}

template <class P, class T>
ARM3R_INLINE DesiredMotion<T> desired_motion_at(const Reference<P>& reference, const T& t) {  // (7.1)
    DesiredMotion<T> desired{broadcast<T>(reference.from), zero_vector<T>(), zero_vector<T>()};
    if (reference.path == Path::hold) return desired;
    if (reference.path == Path::point) return {broadcast<T>(reference.to), zero_vector<T>(), zero_vector<T>()};
    if (reference.path == Path::table) {
        follow_table(reference, t, desired);
        return desired;
    }
    const T since = t - reference.start;
    if (reference.path == Path::sinusoid) {
        const T angular = T(two_pi * reference.frequency);
        const SinCos<T> now = turned(T(reference.frequency * max(since, T(0.0))));
        const T running = select(t >= reference.start, T(1.0), T(0.0));
        for (int i = 0; i < 3; ++i) {
            desired.position[i] = reference.from[i] + reference.amplitude[i] * now.sin;
            desired.velocity[i] = running * (reference.amplitude[i] * angular * now.cos);
            desired.acceleration[i] = -(reference.amplitude[i] * angular * angular) * now.sin;
        }
        return desired;
    }
    const T share = since / reference.duration;
    if (reference.path == Path::line) {
        const T x = max(T(0.0), min(T(1.0), share));
        const T rate = select(t >= reference.start && t < reference.end, T(1.0 / reference.duration), T(0.0));
        for (int i = 0; i < 3; ++i) {
            const P way = reference.to[i] - reference.from[i];
            desired.position[i] = reference.from[i] + x * way;
            desired.velocity[i] = rate * way;
        }
        return desired;
    }
    const MinimumJerk<T> law = minimum_jerk(share);
    const T speed = law.ds / reference.duration, change = law.dds / (reference.duration * reference.duration);
    if (reference.path == Path::minimum_jerk) {
        for (int i = 0; i < 3; ++i) {
            const P way = reference.to[i] - reference.from[i];
            desired.position[i] = reference.from[i] + law.s * way;
            desired.velocity[i] = speed * way;
            desired.acceleration[i] = change * way;
        }
        return desired;
    }
    const T angular = T(two_pi * reference.turns);
    const SinCos<T> now = turned(T(reference.turns * law.s));
    for (int i = 0; i < 3; ++i) {
        const T out = now.cos * reference.across1[i] + now.sin * reference.across2[i];
        const T along = now.cos * reference.across2[i] - now.sin * reference.across1[i];
        desired.position[i] = (reference.from[i] - reference.across1[i]) + out;
        desired.velocity[i] = (angular * speed) * along;
        desired.acceleration[i] = (angular * change) * along - (angular * speed) * (angular * speed) * out;
    }
    return desired;
}

// The desired pressing force, N.
template <class P, class T>
ARM3R_INLINE T desired_force_at(const Reference<P>& reference, const T& t) {  // (7.2)
    if (reference.force_profile == ForceProfile::constant) return T(reference.force);
    if (reference.force_profile == ForceProfile::sinusoid)
        return reference.force + reference.force_amplitude * turned(T(reference.force_frequency * t)).sin;
    const T o(0.0), l(1.0), since = t - reference.force_start;
    T reached = l;
    if (reference.force_profile == ForceProfile::ramp)
        reached = select(t < reference.force_start + reference.force_duration,
                         min(l, T(since / reference.force_duration)), l);
    const T share = select(t >= reference.force_start, reached, o);
    return reference.force_before + share * (reference.force - reference.force_before);
}

}  // namespace arm3r
