// Polynomials on [0, 1], the step: their first zero crossing and their maximum. Values, integrals and Bernstein
// coefficients for any number type, with one degree for all lanes.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/numbers/real.hpp"

namespace arm3r {

inline constexpr int max_degree = 20;

template <class T>
using Coefficients = std::array<T, max_degree + 1>;  // coefficients above the degree are undefined

template <class T>
struct Polynomial {
    int degree;
    Coefficients<T> c;  // sum of c[i] theta^i
};

template <class T, class S>
ARM3R_INLINE auto value(const Polynomial<T>& p, const S& theta) -> decltype(p.c[0] * theta) {
    decltype(p.c[0] * theta) sum(p.c[p.degree]);
    for (int i = p.degree - 1; i >= 0; --i) sum = sum * theta + p.c[i];
    return sum;
}

template <class T, class S>
ARM3R_INLINE auto slope(const Polynomial<T>& p, const S& theta) -> decltype(p.c[0] * theta) {
    decltype(p.c[0] * theta) sum(0.0);
    for (int i = p.degree; i >= 1; --i) sum = sum * theta + double(i) * p.c[i];
    return sum;
}

template <class T>
ARM3R_INLINE Polynomial<T> derivative(const Polynomial<T>& p) {
    Polynomial<T> d;
    d.degree = p.degree > 0 ? p.degree - 1 : 0;
    d.c[0] = T(0.0);
    for (int i = 1; i <= p.degree; ++i) d.c[i - 1] = double(i) * p.c[i];
    return d;
}

inline constexpr auto reciprocals = [] {
    std::array<double, max_degree + 2> table{};
    for (int i = 1; i < max_degree + 2; ++i) table[i] = 1.0 / i;
    return table;
}();

// The integral from a to b. The difference of the powers has b - a as a factor; the rest is a sum without cancellation.
template <class T, class S>
ARM3R_INLINE auto integral(const Polynomial<T>& p, const S& a, const S& b) -> decltype(p.c[0] * a) {
    S power(1.0), rest(1.0);  // a^i and (b^(i+1) - a^(i+1))/(b - a)
    decltype(p.c[0] * a) sum(p.c[0]);
    for (int i = 1; i <= p.degree; ++i) {
        power = power * a;
        rest = rest * b + power;
        sum = sum + (reciprocals[i + 1] * p.c[i]) * rest;
    }
    return (b - a) * sum;
}

// The cubic through y0 and y1 at the ends, with the derivatives d0 and d1 there.
template <class T>
ARM3R_INLINE Polynomial<T> hermite_cubic(const T& y0, const T& d0, const T& y1, const T& d1) {
    const T difference = y1 - y0;
    return {3, {y0, d0, 3.0 * difference - 2.0 * d0 - d1, (d0 + d1) - 2.0 * difference}};
}

// The quartic through five equidistant values, from one end to the other; and its mean.
template <class T>
ARM3R_INLINE Polynomial<T> through_five(const std::array<T, 5>& y) {
    const T d1 = y[1] - y[0], d2 = (y[2] - 2.0 * y[1]) + y[0];
    const T d3 = (y[3] - y[0]) - 3.0 * (y[2] - y[1]), d4 = ((y[0] + y[4]) - 4.0 * (y[1] + y[3])) + 6.0 * y[2];
    return {4,
            {y[0], 4.0 * d1 - 2.0 * d2 + (4.0 / 3) * d3 - d4, 8.0 * d2 - 8.0 * d3 + (22.0 / 3) * d4,
             (32.0 / 3) * d3 - 16.0 * d4, (32.0 / 3) * d4}};
}

template <class T>
ARM3R_INLINE T mean_of_five(const std::array<T, 5>& y) {  // Boole
    return (7.0 * (y[0] + y[4]) + 32.0 * (y[1] + y[3]) + 12.0 * y[2]) / 90.0;
}

inline constexpr auto inverse_binomials = [] {  // [n][i]: 1/C(n, i)
    std::array<Coefficients<double>, max_degree + 1> table{};
    for (int n = 0; n <= max_degree; ++n) {
        long binomial = 1;
        for (int i = 0; i <= n; ++i) {
            table[n][i] = 1.0 / double(binomial);
            binomial = binomial * (n - i) / (i + 1);
        }
    }
    return table;
}();

// The polynomial lies within the range of these on [0, 1], and has no more roots there than they change sign. The
// sums of C(j, i) c[i]/C(n, i) over i, all j side by side as in Pascal's triangle.
template <class T>
ARM3R_INLINE Coefficients<T> bernstein(const Polynomial<T>& p) {
    Coefficients<T> b;
    for (int i = 0; i <= p.degree; ++i) b[i] = inverse_binomials[p.degree][i] * p.c[i];
    for (int k = 1; k <= p.degree; ++k) {
        T left = b[k - 1];
        for (int j = k; j <= p.degree; ++j) {
            const T here = b[j];
            b[j] = left + here;
            left = here;
        }
    }
    return b;
}

inline Polynomial<double> negative(Polynomial<double> p) {
    for (int i = 0; i <= p.degree; ++i) p.c[i] = -p.c[i];
    return p;
}

namespace zero_crossing {

using Bernstein = Coefficients<double>;

struct Halves {
    Bernstein left, right;
};

// De Casteljau: the same polynomial on [0, at] and on [at, 1], each scaled to [0, 1].
inline Halves split(const Bernstein& b, int degree, double at) {
    Halves halves{b, {}};
    halves.right[degree] = b[degree];
    for (int k = 1; k <= degree; ++k) {
        double left = halves.left[k - 1];
        for (int j = k; j <= degree; ++j) {
            const double here = halves.left[j];
            halves.left[j] = (1.0 - at) * left + at * here;
            left = here;
        }
        halves.right[degree - k] = halves.left[degree];
    }
    return halves;
}

// A bound on the rounding error of value() and bernstein(). If the polynomial is not finite, it is not finite either,
// and no crossing is found.
template <class T>
ARM3R_INLINE T rounding(const Polynomial<T>& p) {
    T sum(0.0);
    for (int i = 0; i <= p.degree; ++i) sum = sum + abs(p.c[i]);
    return (p.degree * std::numeric_limits<double>::epsilon()) * sum;
}

template <class T>
struct Bracket {
    T low, high, guess;
};

// Where the polygon through two neighbouring Bernstein coefficients, the second of which is number `below`, crosses zero.
template <class T>
ARM3R_INLINE T crossing_of_polygon(const T& before, const T& after, const T& below, int degree) {
    return ((below - 1.0) + before / (before - after)) / double(degree);
}

struct Search {
    int degree;
    double noise, resolution;

    bool is_below(double x) const { return x < -noise; }

    int first_below(const Bernstein& b) const {
        int j = 0;
        while (j <= degree && !is_below(b[j])) ++j;
        return j;
    }

    bool stays_below(const Bernstein& b, int j) const {
        while (j <= degree && is_below(b[j])) ++j;
        return j > degree;
    }

    // The first interval with exactly one downward crossing; b belongs to [low, high], and the polynomial is not
    // negative at the start.
    std::optional<Bracket<double>> isolate(const Bernstein& b, double low, double high) const {
        const int j = first_below(b);
        if (j > degree) return std::nullopt;
        if (stays_below(b, j)) {
            const double at = j == 0 ? 0 : crossing_of_polygon<double>(b[j - 1], b[j], j, degree);
            return Bracket<double>{low, high, low + (high - low) * at};
        }
        if (high - low <= resolution) return std::nullopt;
        const Halves halves = split(b, degree, 0.5);
        const double middle = 0.5 * (low + high);
        if (const auto bracket = isolate(halves.left, low, middle)) return bracket;
        return isolate(halves.right, middle, high);
    }
};

// The resolution of a search: no finer than numbers near 1.
template <class T>
ARM3R_INLINE T attainable(const T& resolution) {
    return max(T(std::numeric_limits<double>::epsilon()), resolution);
}

// Newton's method with steps that are slightly too long, so that the bracket closes from both sides; bisection where a
// step leaves the bracket or does not shrink. Returns the end of the bracket at which p is negative, where `wanted`.
template <class T>
ARM3R_INLINE T refine_root(const Polynomial<T>& p, const Bracket<T>& bracket, const T& resolution,
                           const typename Lanes<T>::Mask& wanted) {
    T low = bracket.low, high = bracket.high, next = bracket.guess;
    T here = low, stride = 2.0 * (high - low);
    for (auto open = wanted && high - low > resolution; any(open); open = open && high - low > resolution) {
        const auto shrinks = low < next && next < high && abs(next - here) <= 0.5 * stride;
        next = select(shrinks, next, T(0.5 * (low + high)));
        stride = abs(next - here);
        here = next;
        const T at = value(p, here), step = -at / slope(p, here), beyond = 0.4 * resolution;
        const auto below = at < T(0.0);
        high = select(open && below, here, high);
        low = select(open && !below, here, low);
        next = select(below, T(here + step - beyond), T(here + step + beyond));
    }
    return high;
}

// The downward zero crossings of polynomials with the Bernstein coefficients b, one in each lane.
template <class T>
struct Falls {
    typename Lanes<T>::Mask none;  // no coefficient is negative, except by rounding
    typename Lanes<T>::Mask one;   // the coefficients become negative once, and not at the start: there is one crossing
    T guess;                       // in [0, 1], where `one`
};

template <class T>
ARM3R_INLINE Falls<T> falls_of(const Coefficients<T>& b, int degree, const T& noise) {
    typename Lanes<T>::Mask has_fallen = b[0] < -noise, rises = has_fallen;
    T before(1.0), after(0.0), below(1.0);
    for (int j = 1; j <= degree; ++j) {
        const auto is_below = b[j] < -noise, falls = is_below && !has_fallen;
        rises = rises || (has_fallen && !is_below);
        has_fallen = has_fallen || is_below;
        before = select(falls, b[j - 1], before);
        after = select(falls, b[j], after);
        below = select(falls, T(double(j)), below);
    }
    return {!has_fallen, has_fallen && !rises, crossing_of_polygon(before, after, below, degree)};
}

struct Root {
    double at;
    bool is_last;  // certainly no other one follows: p stays negative
};

// The first downward zero crossing of p in (from, to]; p is not negative at `from`, except by rounding.
inline std::optional<Root> first_root(const Polynomial<double>& p, double from, double to, double resolution) {
    if (!(from < to)) return std::nullopt;
    const Search search{p.degree, rounding(p), attainable(resolution)};
    Bernstein b = bernstein(p);
    if (search.first_below(b) > p.degree) return std::nullopt;
    if (from > 0) b = split(b, p.degree, from).right;
    if (to < 1) b = split(b, p.degree, (to - from) / (1 - from)).left;
    const auto bracket = search.isolate(b, from, to);
    if (!bracket) return std::nullopt;
    return Root{refine_root(p, *bracket, search.resolution, true), bracket->high == to};
}

inline std::optional<double> first(const Polynomial<double>& p, double from, double to, double resolution) {
    const std::optional<Root> root = first_root(p, from, to, resolution);
    return root ? std::optional(root->at) : std::nullopt;
}

inline Polynomial<double> minus_constant(Polynomial<double> p, double by) {
    p.c[0] -= by;
    return p;
}

}  // namespace zero_crossing

// The first downward zero crossing of g in (from, 1]: at most `resolution` (of [0, 1]) after the root, where g is
// negative. Crossings that are shorter than that or smaller than the rounding of g may be missed. If g is negative at
// the start by more than rounding, the crossing is at `from`, unless g rises above zero without falling first; then the
// next crossing counts. Empty if g is not finite.
inline std::optional<double> first_crossing(const Polynomial<double>& g, double from, double resolution) {
    const double start = value(g, from);
    if (!(start < -zero_crossing::rounding(g) && from < 1)) return zero_crossing::first(g, from, 1.0, resolution);
    const std::optional<double> up = zero_crossing::first(negative(g), from, 1.0, resolution);
    if (!up || zero_crossing::first(zero_crossing::minus_constant(g, start), from, *up, resolution)) return from;
    return zero_crossing::first(g, *up, 1.0, resolution);
}

inline constexpr double turning_resolution = 0x1p-32;  // a polynomial is flat at its maximum

struct Maximum {
    double position, value;

    void include(const Polynomial<double>& p, double at) {
        const double here = arm3r::value(p, at);
        if (here > value) *this = {at, here};
    }
};

// The maximum of p on [a, b], part of [0, 1]: at an end or where the derivative is zero, exact to rounding.
inline Maximum maximum(const Polynomial<double>& p, double a, double b) {
    Maximum most{a, value(p, a)};
    most.include(p, b);
    Polynomial<double> signed_slope = derivative(p);
    if (value(signed_slope, a) < 0) signed_slope = negative(signed_slope);
    while (const auto turn = zero_crossing::first_root(signed_slope, a, b, turning_resolution)) {
        most.include(p, turn->at);
        if (turn->is_last) break;
        signed_slope = negative(signed_slope);
        a = turn->at;
    }
    return most;
}

inline double max_value(const Polynomial<double>& p, double a, double b) { return maximum(p, a, b).value; }

}  // namespace arm3r
