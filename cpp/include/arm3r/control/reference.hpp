#pragma once
// What a controller wants: where the arm should be, and how hard it should press; docs/model.md, section 7.1. Functions of
// time alone, which have the value after a jump at its very instant. Positions are those of the tip, in base axes, or joint angles, in the slide convention.

#include <memory>

#include "arm3r/model/scalar_motion.hpp"
#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

enum class Path { hold, point, line, minimum_jerk, circle, sinusoid, table };
constexpr bool is_moving(Path path) { return path != Path::hold && path != Path::point; }
enum class Pressing { constant, step, ramp, sinusoid };

struct SetpointChoices {
    Path path = Path::hold;
    bool in_joints = false;  // whether positions are joint angles
    int knots = 0;           // of a table
    Pressing pressing = Pressing::constant;

    bool operator==(const SetpointChoices&) const = default;
};

template <class P>
struct Setpoint : SetpointChoices {
    Vec3<P> from, to;          // m or rad, at the start and at the end
    P start, duration, end;    // s
    Vec3<P> across1, across2;  // m, a circle's: from its centre to its start, and a quarter turn on
    P turns;                   // of the circle
    Vec3<P> amplitude;         // m or rad, of a sinusoid about `from`
    P frequency;               // Hz
    std::shared_ptr<std::array<Table<P>, 3>> table;  // m, of the tip; it stands apart as a wall's does
    P force, force_before;                           // N, along the pressing direction
    P force_start, force_duration;                   // s
    P force_amplitude, force_frequency;              // N, Hz
};

template <class T>
struct Wanted {
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
ARM3R_INLINE Vec3<T> none() {
    return {T(0.0), T(0.0), T(0.0)};
}

// sin and cos of 2 pi cycles.
template <class T>
ARM3R_INLINE SinCos<T> turned(const T& cycles) {
    return sincos(T((cycles - nearest_integer(cycles)) * two_pi));
}

// Rare and long: not in every law that follows a path.
template <class P, class T>
[[gnu::noinline]] void follow_table(const Setpoint<P>& setpoint, const T& t, Wanted<T>& wanted) {
    for (int i = 0; i < 3; ++i) {
        const Course<T> along = course((*setpoint.table)[i], t);
        wanted.position[i] = along.s, wanted.velocity[i] = along.v, wanted.acceleration[i] = along.a;
    }
}

template <class P, class T>
ARM3R_INLINE Wanted<T> wanted_at(const Setpoint<P>& setpoint, const T& t) {  // (7.1)
    Wanted<T> wanted{lifted<T>(setpoint.from), none<T>(), none<T>()};
    if (setpoint.path == Path::hold) return wanted;
    if (setpoint.path == Path::point) return {lifted<T>(setpoint.to), none<T>(), none<T>()};
    if (setpoint.path == Path::table) {
        follow_table(setpoint, t, wanted);
        return wanted;
    }
    const T since = t - setpoint.start;
    if (setpoint.path == Path::sinusoid) {
        const T angular = T(two_pi * setpoint.frequency);
        const SinCos<T> now = turned(T(setpoint.frequency * max(since, T(0.0))));
        const T running = select(t >= setpoint.start, T(1.0), T(0.0));
        for (int i = 0; i < 3; ++i) {
            wanted.position[i] = setpoint.from[i] + setpoint.amplitude[i] * now.sin;
            wanted.velocity[i] = running * (setpoint.amplitude[i] * angular * now.cos);
            wanted.acceleration[i] = -(setpoint.amplitude[i] * angular * angular) * now.sin;
        }
        return wanted;
    }
    const T share = since / setpoint.duration;
    if (setpoint.path == Path::line) {
        const T x = max(T(0.0), min(T(1.0), share));
        const T rate = select(t >= setpoint.start && t < setpoint.end, T(1.0 / setpoint.duration), T(0.0));
        for (int i = 0; i < 3; ++i) {
            const P way = setpoint.to[i] - setpoint.from[i];
            wanted.position[i] = setpoint.from[i] + x * way;
            wanted.velocity[i] = rate * way;
        }
        return wanted;
    }
    const MinimumJerk<T> law = minimum_jerk(share);
    const T speed = law.ds / setpoint.duration, change = law.dds / (setpoint.duration * setpoint.duration);
    if (setpoint.path == Path::minimum_jerk) {
        for (int i = 0; i < 3; ++i) {
            const P way = setpoint.to[i] - setpoint.from[i];
            wanted.position[i] = setpoint.from[i] + law.s * way;
            wanted.velocity[i] = speed * way;
            wanted.acceleration[i] = change * way;
        }
        return wanted;
    }
    const T angular = T(two_pi * setpoint.turns);
    const SinCos<T> now = turned(T(setpoint.turns * law.s));
    for (int i = 0; i < 3; ++i) {
        const T out = now.cos * setpoint.across1[i] + now.sin * setpoint.across2[i];
        const T along = now.cos * setpoint.across2[i] - now.sin * setpoint.across1[i];
        wanted.position[i] = (setpoint.from[i] - setpoint.across1[i]) + out;
        wanted.velocity[i] = (angular * speed) * along;
        wanted.acceleration[i] = (angular * change) * along - (angular * speed) * (angular * speed) * out;
    }
    return wanted;
}

// The pressing force that is wanted, N.
template <class P, class T>
ARM3R_INLINE T force_wanted_at(const Setpoint<P>& setpoint, const T& t) {  // (7.2)
    if (setpoint.pressing == Pressing::constant) return T(setpoint.force);
    if (setpoint.pressing == Pressing::sinusoid)
        return setpoint.force + setpoint.force_amplitude * turned(T(setpoint.force_frequency * t)).sin;
    const T o(0.0), l(1.0), since = t - setpoint.force_start;
    T reached = l;
    if (setpoint.pressing == Pressing::ramp)
        reached =
            select(t < setpoint.force_start + setpoint.force_duration, min(l, T(since / setpoint.force_duration)), l);
    const T share = select(t >= setpoint.force_start, reached, o);
    return setpoint.force_before + share * (setpoint.force - setpoint.force_before);
}

}  // namespace arm3r
