#pragma once
// The maximum and the zero of a function of one number between places in [0, 1] where it is known, without its
// derivative.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "arm3r/numbers/polynomial.hpp"

namespace arm3r {

// The value of a function at a place.
struct SearchPoint {
    double at, value;
};

namespace scalar_search {

// Of the place. A maximum is flat: it is missed by the square of this share of what the function varies by. Closer,
// rounding errors of the function lead the search.
inline constexpr double maximum_resolution = 1e-6, zero_resolution = 1e-12;

// The top of the parabola through three points, seen from the best of them: the step to it, and how much higher it lies.
// Not finite where they lie on a line.
struct Top {
    double step, rise;
};
inline Top top_of(const SearchPoint& best, const SearchPoint& second, const SearchPoint& third) {
    const double to_second = second.at - best.at, to_third = third.at - best.at;
    const double slope2 = (second.value - best.value) / to_second, slope3 = (third.value - best.value) / to_third;
    const double bend = (slope3 - slope2) / (to_third - to_second), slope = slope2 - bend * to_second;
    const double step = -0.5 * slope / bend;
    return {step, 0.5 * slope * step};
}

// The three best points so far, between a and b.
struct MaximumBracket {
    double a, b;
    SearchPoint best, second, third;

    MaximumBracket(const SearchPoint& first, const SearchPoint& middle, const SearchPoint& last)
        : a(first.at), b(last.at), best(middle), second(first), third(last) {
        if (third.value > second.value) std::swap(second, third);
        if (second.value > best.value) std::swap(best, second);
        if (third.value > second.value) std::swap(second, third);
    }
    double to_far_end() const { return best.at < 0.5 * (a + b) ? b - best.at : a - best.at; }
    void include(const SearchPoint& here) {
        if (here.value >= best.value) {
            (here.at < best.at ? b : a) = best.at;
            third = second, second = best, best = here;
        } else {
            (here.at < best.at ? a : b) = here.at;
            if (here.value >= second.value || second.at == best.at) third = second, second = here;
            else if (here.value >= third.value || third.at == best.at || third.at == second.at) third = here;
        }
    }
};

// The place of the next sample, as a fraction of the way from the newest point to the other end of the bracket: the zero
// of the inverse parabola through three points where that is safe, else a half.
inline double share_to_zero(const SearchPoint& newest, const SearchPoint& other, const SearchPoint& dropped) {
    const double xi = (newest.at - other.at) / (dropped.at - other.at);
    const double phi = (newest.value - other.value) / (dropped.value - other.value);
    if (!(phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi)) return 0.5;
    return newest.value / (other.value - newest.value) * dropped.value / (other.value - dropped.value) +
           (dropped.at - newest.at) / (other.at - newest.at) * newest.value / (dropped.value - newest.value) *
               other.value / (dropped.value - other.value);
}

}  // namespace scalar_search

// The maximum of f between the outer ones of three places, by parabolas through the three best points, or by a golden
// section where they do not converge (Brent 1973, chapter 5), until two of them in turn have foretold the next value well
// and promise nothing but rounding errors; f rises from the first place and falls to the last. `noise`: the rounding
// errors of f that its own size does not show.
template <class F>
Maximum find_maximum(F f, const SearchPoint& first, const SearchPoint& middle, const SearchPoint& last,
                     double noise = 0) {
    using namespace scalar_search;
    constexpr double golden_section = 0.3819660112501051, least = maximum_resolution;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    constexpr int most_steps = 60;
    MaximumBracket bracket(first, middle, last);
    const auto& [a, b, best, second, third] = bracket;
    const double height = best.value - third.value;
    double step = b - a, before = b - a;                        // the last step and the one before it
    double surprise = std::numeric_limits<double>::infinity();  // by which the last value is not as foretold
    bool is_flat = false;
    for (int n = 0; n < most_steps; ++n) {
        const double to_far_end = bracket.to_far_end();
        if (std::abs(to_far_end) <= 2 * least) break;
        const Top parabola = top_of(best, second, third);
        const double top = best.at + parabola.step;
        const bool converges = std::abs(parabola.step) < 0.5 * std::abs(before) && a < top && top < b;
        // A parabola that missed the last value by so much misses the maximum by its square over the height.
        const double rounding = epsilon * (std::abs(best.value) + height) + noise;
        const bool was_flat = is_flat;
        is_flat = converges && std::abs(parabola.rise) <= rounding && surprise * surprise <= rounding * height;
        if (is_flat && was_flat) break;
        before = converges ? step : to_far_end;
        step = converges ? parabola.step : golden_section * to_far_end;
        if (converges && std::min(top - a, b - top) < 2 * least) step = std::copysign(least, to_far_end);
        const double at = best.at + std::copysign(std::max(std::abs(step), least), step);
        const SearchPoint here{at, f(at)};
        surprise = std::abs(here.value - (best.value + parabola.rise));
        bracket.include(here);
    }
    return {best.at, best.value};
}

// The zero of f between two places, by inverse quadratic interpolation or by halves (Chandrupatla 1997); f is positive at
// the first and not at the last. Returns the end of the last bracket at which f is not positive.
template <class F>
double find_zero(F f, const SearchPoint& first, const SearchPoint& last) {
    using namespace scalar_search;
    constexpr int most_steps = 120;
    const auto is_positive = [](const SearchPoint& p) { return p.value > 0; };
    SearchPoint newest = last, other = first, dropped = other;  // the zero lies between newest and other
    double share = 0.5;
    for (int n = 0; n < most_steps && std::abs(other.at - newest.at) > zero_resolution; ++n) {
        const double at = newest.at + share * (other.at - newest.at);
        const SearchPoint here{at, f(at)};
        if (is_positive(here) == is_positive(newest)) dropped = newest;
        else dropped = other, other = newest;
        newest = here;
        const double least = 0.5 * zero_resolution / std::abs(other.at - newest.at);
        share = least < 0.5 ? std::clamp(share_to_zero(newest, other, dropped), least, 1 - least) : 0.5;
    }
    return is_positive(newest) ? other.at : newest.at;
}

}  // namespace arm3r
