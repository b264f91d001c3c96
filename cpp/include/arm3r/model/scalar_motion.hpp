#pragma once
// The position along a line, or the angle about an axis, as a function of time: sinusoids, ramps, tables.

#include <cstddef>
#include <type_traits>

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/numbers/real.hpp"

namespace arm3r {

// A sin(2 pi f t + phase) - A sin(phase): m, or rad.
template <class P>
struct Sinusoid {
    P amplitude, frequency, phase;  // frequency: Hz; phase: rad
};

// A minimum-jerk motion from rest to rest.
template <class P>
struct Ramp {
    P distance, start, duration;  // m, s, s
};

// A quintic through points with velocity and acceleration given there; at rest before the first and after the last
// point.
template <class P>
struct QuinticTable {
    AlignedVector<P> t, s, v, a;  // as many of each, two or more: s, m, m/s, m/s^2

    int knots() const { return static_cast<int>(t.size()); }
    void set_knots(std::size_t count) { t.resize(count), s.resize(count), v.resize(count), a.resize(count); }
};

// A position and its first two time derivatives.
template <class T>
struct ScalarMotion {
    T s, v, a;
};

inline constexpr double two_pi = 6.283185307179586;

template <class P, class T>
ARM3R_INLINE ScalarMotion<T> scalar_motion(const Sinusoid<P>& sinusoid, const T& t) {
    const T cycles = sinusoid.frequency * t;
    const SinCos<T> now = sincos(T((cycles - nearest_integer(cycles)) * two_pi + sinusoid.phase));
    const P omega = two_pi * sinusoid.frequency;
    return {sinusoid.amplitude * now.sin - sinusoid.amplitude * sincos(sinusoid.phase).sin,
            sinusoid.amplitude * omega * now.cos, -(sinusoid.amplitude * omega * omega) * now.sin};
}

template <class P, class T>
ARM3R_INLINE ScalarMotion<T> scalar_motion(const Ramp<P>& ramp, const T& t) {
    const T x = min(max(T((t - ramp.start) / ramp.duration), T(0.0)), T(1.0)), rest = 1.0 - x;
    const P speed = ramp.distance / ramp.duration;
    return {ramp.distance * (x * x * x * (10.0 + x * (6.0 * x - 15.0))), speed * (30.0 * (x * x) * (rest * rest)),
            speed / ramp.duration * (60.0 * x * rest * (rest - x))};
}

template <class T>
struct Knot {
    T t, s, v, a;
};

template <class T>
struct KnotPair {
    Knot<T> from, to;
};

// The interval of a lane's table that contains t, or the first or the last one.
template <class P>
[[gnu::noinline]] int interval_at(const AlignedVector<P>& instants, int lane, double t) {
    int first = 0, last = static_cast<int>(instants.size()) - 2;
    while (first < last) {
        const int middle = (first + last + 1) / 2;
        if (Lanes<P>::get(instants[std::size_t(middle)], lane) <= t) first = middle;
        else last = middle - 1;
    }
    return first;
}

// The ends of the interval that contains t, or of the first or the last one.
template <class P, class T>
ARM3R_INLINE KnotPair<T> knots_around(const QuinticTable<P>& table, const T& t) {
    const P *instants = table.t.data(), *s = table.s.data(), *v = table.v.data(), *a = table.a.data();
    const auto knot = [&](int i) ARM3R_INLINE_LAMBDA { return Knot<T>{T(instants[i]), T(s[i]), T(v[i]), T(a[i])}; };
    KnotPair<T> found{knot(0), knot(1)};
    if constexpr (std::is_same_v<T, double>) {
        const int i = interval_at(table.t, 0, t);
        found = {knot(i), knot(i + 1)};
    } else if constexpr (Lanes<T>::count > 1) {
        for (int lane = 0; lane < Lanes<T>::count; ++lane) {
            const int i = interval_at(table.t, lane, Lanes<T>::get(t, lane));
            const auto take = [&](Knot<T>& to, int k) ARM3R_INLINE_LAMBDA {
                Lanes<T>::set(to.t, lane, Lanes<P>::get(instants[k], lane));
                Lanes<T>::set(to.s, lane, Lanes<P>::get(s[k], lane));
                Lanes<T>::set(to.v, lane, Lanes<P>::get(v[k], lane));
                Lanes<T>::set(to.a, lane, Lanes<P>::get(a[k], lane));
            };
            take(found.from, i), take(found.to, i + 1);
        }
    } else {  // a number that is not searched for: with derivatives, or of a recorded formula
        const auto either = [](const auto& which, const Knot<T>& x, const Knot<T>& y) ARM3R_INLINE_LAMBDA {
            return Knot<T>{select(which, x.t, y.t), select(which, x.s, y.s), select(which, x.v, y.v),
                           select(which, x.a, y.a)};
        };
        for (int i = 1; i + 1 < table.knots(); ++i) {
            const auto is_later = t >= T(instants[i]);
            found = {either(is_later, knot(i), found.from), either(is_later, knot(i + 1), found.to)};
        }
    }
    return found;
}

// The quintic of the interval that contains t; at rest before the first knot and from the last one on.
template <class P, class T>
ARM3R_INLINE ScalarMotion<T> scalar_motion(const QuinticTable<P>& table, const T& t) {
    const auto [from, to] = knots_around(table, t);
    const T h = to.t - from.t, x = min(max(T((t - from.t) / h), T(0.0)), T(1.0));
    const T v0 = h * from.v, a0 = 0.5 * (h * h) * from.a, v1 = h * to.v, a1 = 0.5 * (h * h) * to.a;
    const T ds = to.s - from.s - v0 - a0, dv = v1 - v0 - 2.0 * a0, da = a1 - a0;
    const T c3 = 10.0 * ds - 4.0 * dv + da, c4 = 7.0 * dv - 15.0 * ds - 2.0 * da, c5 = 6.0 * ds - 3.0 * dv + da;
    const auto moves = t >= T(table.t[0]) && t < T(table.t[table.t.size() - 1]);
    const T o(0.0);
    return {from.s + x * (v0 + x * (a0 + x * (c3 + x * (c4 + x * c5)))),
            select(moves, T((v0 + x * (2.0 * a0 + x * (3.0 * c3 + x * (4.0 * c4 + x * (5.0 * c5))))) / h), o),
            select(moves, T((2.0 * a0 + x * (6.0 * c3 + x * (12.0 * c4 + x * (20.0 * c5)))) / (h * h)), o)};
}

}  // namespace arm3r
