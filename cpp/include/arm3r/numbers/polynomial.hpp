// Polynomials on [0, 1], the step: where one falls below zero, how large it gets. Values, integrals and Bernstein
// coefficients for any number type, one degree for all lanes.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "arm3r/numbers/real.hpp"

namespace arm3r {

inline constexpr int most_degree = 20;

template <class T>
using Coefficients = std::array<T, most_degree + 1>;  // those beyond the degree mean nothing

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
    std::array<double, most_degree + 2> table{};
    for (int i = 1; i < most_degree + 2; ++i) table[i] = 1.0 / i;
    return table;
}();

// From a to b. The difference of the powers has b - a as a factor; the rest is a sum without cancellation.
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

// Through y0 and y1 at the ends, with the derivatives d0 and d1 there.
template <class T>
ARM3R_INLINE Polynomial<T> hermite_cubic(const T& y0, const T& d0, const T& y1, const T& d1) {
    const T difference = y1 - y0;
    return {3, {y0, d0, 3.0 * difference - 2.0 * d0 - d1, (d0 + d1) - 2.0 * difference}};
}

// Through five values at equal distances, from one end to the other; and its mean.
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
    std::array<Coefficients<double>, most_degree + 1> table{};
    for (int n = 0; n <= most_degree; ++n) {
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

namespace falls {

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

// A bound on the rounding of value() and bernstein(). Not finite where the polynomial is not: then nothing is below.
inline double rounding(const Polynomial<double>& p) {
    double sum = 0;
    for (int i = 0; i <= p.degree; ++i) sum += abs(p.c[i]);
    return (p.degree * std::numeric_limits<double>::epsilon()) * sum;
}

struct Bracket {
    double low, high, guess;
};

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

    // The leftmost interval with one fall; b belongs to [low, high], where the start is not below.
    std::optional<Bracket> isolate(const Bernstein& b, double low, double high) const {
        const int j = first_below(b);
        if (j > degree) return std::nullopt;
        if (stays_below(b, j)) return Bracket{low, high, low + (high - low) * crossing_of_polygon(b, j)};
        if (high - low <= resolution) return std::nullopt;
        const Halves halves = split(b, degree, 0.5);
        const double middle = 0.5 * (low + high);
        if (const auto bracket = isolate(halves.left, low, middle)) return bracket;
        return isolate(halves.right, middle, high);
    }

    double crossing_of_polygon(const Bernstein& b, int below) const {
        if (below == 0) return 0;
        return ((below - 1) + b[below - 1] / (b[below - 1] - b[below])) / degree;
    }
};

// Newton, each step a little too far, so that the bracket closes from both sides; halving where a step leaves the
// bracket or does not shrink. The end of the bracket where p has fallen.
inline double close(const Polynomial<double>& p, const Bracket& bracket, double resolution) {
    auto [low, high, next] = bracket;
    double here = low, stride = 2 * (high - low);
    while (high - low > resolution) {
        if (!(low < next && next < high && abs(next - here) <= 0.5 * stride)) next = 0.5 * (low + high);
        stride = abs(next - here);
        here = next;
        const double at = value(p, here);
        const double step = -at / slope(p, here);
        if (at < 0) {
            high = here;
            next = here + step - 0.4 * resolution;
        } else {
            low = here;
            next = here + step + 0.4 * resolution;
        }
    }
    return high;
}

// Where p falls first in (from, to], for a p that is not below zero at `from`, or by no more than rounding.
inline std::optional<double> first(const Polynomial<double>& p, double from, double to, double resolution) {
    if (!(from < to)) return std::nullopt;
    const Search search{p.degree, rounding(p), max(std::numeric_limits<double>::epsilon(), resolution)};
    Bernstein b = bernstein(p);
    if (search.first_below(b) > p.degree) return std::nullopt;
    if (from > 0) b = split(b, p.degree, from).right;
    if (to < 1) b = split(b, p.degree, (to - from) / (1 - from)).left;
    const auto bracket = search.isolate(b, from, to);
    if (!bracket) return std::nullopt;
    return close(p, *bracket, search.resolution);
}

inline Polynomial<double> lowered(Polynomial<double> p, double by) {
    p.c[0] -= by;
    return p;
}

}  // namespace falls

// Where g first falls below zero in (from, 1]: within `resolution` (of [0, 1]) after the root, and fallen there. Found
// is what is wider than that and deeper than the rounding of g. Where g starts below zero, by more than rounding, it has
// fallen at `from`, unless it comes up without sinking first; then the next fall counts. Nothing where g is not finite.
inline std::optional<double> first_fall(const Polynomial<double>& g, double from, double resolution) {
    const double start = value(g, from);
    if (!(start < -falls::rounding(g) && from < 1)) return falls::first(g, from, 1.0, resolution);
    const std::optional<double> up = falls::first(negative(g), from, 1.0, resolution);
    if (!up || falls::first(falls::lowered(g, start), from, *up, resolution)) return from;
    return falls::first(g, *up, 1.0, resolution);
}

struct Maximum {
    double place, value;

    void include(const Polynomial<double>& p, double at) {
        const double here = arm3r::value(p, at);
        if (here > value) *this = {at, here};
    }
};

// The maximum of p on [a, b], part of [0, 1]: at an end or where p turns, exact to rounding.
inline Maximum maximum(const Polynomial<double>& p, double a, double b) {
    constexpr double resolution = 0x1p-32;  // p is flat where it turns
    Maximum most{a, value(p, a)};
    most.include(p, b);
    Polynomial<double> signed_slope = derivative(p);
    if (value(signed_slope, a) < 0) signed_slope = negative(signed_slope);
    while (const auto turn = falls::first(signed_slope, a, b, resolution)) {
        most.include(p, *turn);
        signed_slope = negative(signed_slope);
        a = *turn;
    }
    return most;
}

inline double largest(const Polynomial<double>& p, double a, double b) { return maximum(p, a, b).value; }

}  // namespace arm3r
