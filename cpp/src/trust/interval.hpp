#pragma once
// A closed interval as a number: a formula on intervals gives one that contains all values of the formula on numbers
// from the given ones. Rounding is not counted.

#include <algorithm>
#include <cmath>
#include <limits>

#include "arm3r/numbers/eigen_traits.hpp"

namespace arm3r {

struct Interval {
    double low = 0, high = 0;

    Interval() = default;
    Interval(double x) : low(x), high(x) {}
    Interval(double low, double high) : low(low), high(high) {}

    friend Interval operator+(const Interval& a, const Interval& b) { return {a.low + b.low, a.high + b.high}; }
    friend Interval operator-(const Interval& a, const Interval& b) { return {a.low - b.high, a.high - b.low}; }
    friend Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
    friend Interval operator*(const Interval& a, const Interval& b) {
        const auto [least, most] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
        return {least, most};
    }
    friend Interval operator/(const Interval& a, const Interval& b) {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        if (b.low <= 0 && b.high >= 0) return {-infinite, infinite};
        return a * Interval(1 / b.high, 1 / b.low);
    }

    friend Interval tanh(const Interval& x) { return {arm3r::tanh(x.low), arm3r::tanh(x.high)}; }
    friend SinCos<Interval> sincos(const Interval& x) {
        constexpr double quarter = 1.5707963267948966;
        const auto [sin_low, cos_low] = arm3r::sincos(x.low);
        const auto [sin_high, cos_high] = arm3r::sincos(x.high);
        return {x.with_tops(sin_low, sin_high, quarter), x.with_tops(cos_low, cos_high, 0)};
    }

    double largest() const { return std::max(std::abs(low), std::abs(high)); }
    bool contains(const Interval& other) const { return low <= other.low && other.high <= high; }

private:
    // The range of a sine whose values at the ends are given, with a maximum at `top`.
    Interval with_tops(double at_low, double at_high, double top) const {
        constexpr double turn = 6.283185307179586;
        const auto has = [&](double place) { return place + turn * std::ceil((low - place) / turn) <= high; };
        return {has(top + turn / 2) ? -1 : std::min(at_low, at_high), has(top) ? 1 : std::max(at_low, at_high)};
    }
};

inline Interval hull(const Interval& a, const Interval& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

// Wider by a share of its width on each side.
inline Interval widened(const Interval& x, double share) {
    const double more = share * (x.high - x.low);
    return {x.low - more, x.high + more};
}

}  // namespace arm3r

template <>
struct Eigen::NumTraits<arm3r::Interval> : arm3r::EigenTraits<arm3r::Interval> {};
