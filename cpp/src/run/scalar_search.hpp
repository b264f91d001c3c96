#pragma once
// The maximum and the zero of a function of one number between two places in [0, 1], without its derivative.

#include <algorithm>
#include <cmath>

#include "arm3r/numbers/polynomial.hpp"

namespace arm3r {
namespace scalar_search {

inline constexpr double maximum_resolution = 1e-8;  // of the place: there the function is flat
inline constexpr double zero_resolution = 1e-15;

struct Point {
    double at, value;
};

// The step from the best point to the top of the parabola through three points; not finite if they lie on a line.
inline double step_to_top(const Point& best, const Point& second, const Point& third) {
    const double r = (best.at - second.at) * (best.value - third.value);
    const double q = (best.at - third.at) * (best.value - second.value);
    return ((best.at - second.at) * r - (best.at - third.at) * q) / (2 * (q - r));
}

// The place of the next sample, as a fraction of the way from the newest point to the other end of the bracket: the zero
// of the inverse parabola through three points where that is safe, else a half.
inline double share_to_zero(const Point& newest, const Point& other, const Point& dropped) {
    const double xi = (newest.at - other.at) / (dropped.at - other.at);
    const double phi = (newest.value - other.value) / (dropped.value - other.value);
    if (!(phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi)) return 0.5;
    return newest.value / (other.value - newest.value) * dropped.value / (other.value - dropped.value) +
           (dropped.at - newest.at) / (other.at - newest.at) * newest.value / (dropped.value - newest.value) *
               other.value / (dropped.value - other.value);
}

}  // namespace scalar_search

// The maximum of f between a and b, by parabolas through the three best points, or by a golden section where they do not
// converge (Brent 1973, chapter 5); f rises from a and falls to b.
template <class F>
Maximum find_maximum(F f, double a, double b) {
    using namespace scalar_search;
    constexpr double golden_section = 0.3819660112501051, least = maximum_resolution;
    constexpr int most_steps = 60;
    const auto sample = [&](double at) { return Point{at, f(at)}; };
    Point best = sample(a + golden_section * (b - a)), second = best, third = best;
    double step = 0, before = 0;  // the last step and the one before it
    for (int n = 0; n < most_steps; ++n) {
        const double to_far_end = best.at < 0.5 * (a + b) ? b - best.at : a - best.at;
        if (std::abs(to_far_end) <= 2 * least) break;
        const double to_top = step_to_top(best, second, third), top = best.at + to_top;
        const bool converges = std::abs(to_top) < 0.5 * std::abs(before) && a < top && top < b;
        before = converges ? step : to_far_end;
        step = converges ? to_top : golden_section * to_far_end;
        if (converges && std::min(top - a, b - top) < 2 * least) step = std::copysign(least, to_far_end);
        const Point here = sample(best.at + std::copysign(std::max(std::abs(step), least), step));
        if (here.value >= best.value) {
            (here.at < best.at ? b : a) = best.at;
            third = second, second = best, best = here;
        } else {
            (here.at < best.at ? a : b) = here.at;
            if (here.value >= second.value || second.at == best.at) third = second, second = here;
            else if (here.value >= third.value || third.at == best.at || third.at == second.at) third = here;
        }
    }
    return {best.at, best.value};
}

// The zero of f between a and b, by inverse quadratic interpolation or by halves (Chandrupatla 1997); f is positive at a
// and not at b. Returns the end of the last bracket at which f is not positive.
template <class F>
double find_zero(F f, double a, double b) {
    using namespace scalar_search;
    constexpr int most_steps = 120;
    const auto sample = [&](double at) { return Point{at, f(at)}; };
    const auto is_positive = [](const Point& p) { return p.value > 0; };
    Point newest = sample(b), other = sample(a), dropped = other;  // the zero lies between newest and other
    double share = 0.5;
    for (int n = 0; n < most_steps && std::abs(other.at - newest.at) > zero_resolution; ++n) {
        const Point here = sample(newest.at + share * (other.at - newest.at));
        if (is_positive(here) == is_positive(newest)) dropped = newest;
        else dropped = other, other = newest;
        newest = here;
        const double least = 0.5 * zero_resolution / std::abs(other.at - newest.at);
        share = least < 0.5 ? std::clamp(share_to_zero(newest, other, dropped), least, 1 - least) : 0.5;
    }
    return is_positive(newest) ? other.at : newest.at;
}

}  // namespace arm3r
