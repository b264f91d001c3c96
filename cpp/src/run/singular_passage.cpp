#include "run/singular_passage.hpp"

#include <algorithm>

#include "run/scalar_search.hpp"

namespace arm3r {
namespace {

constexpr int parts = 8;  // of a step, in each of which a factor of det J has at most one extremum

bool is_negative(const SearchPoint& p) { return p.value < 0; }

// The first change of sign of f between two places.
template <class F>
std::optional<double> change_of_sign(F f, const SearchPoint& first, const SearchPoint& last) {
    if (is_negative(first) == is_negative(last)) return {};
    const double sign = is_negative(first) ? -1 : 1;
    const auto falling = [&](double at) { return sign * f(at); };
    return find_zero(falling, {first.at, sign * first.value}, {last.at, sign * last.value});
}

// The same between three places of one sign, where the middle one is nearest to 0.
template <class F>
std::optional<double> double_change(F f, const SearchPoint& first, const SearchPoint& middle, const SearchPoint& last) {
    const double sign = is_negative(middle) ? 1 : -1;
    const auto turned = [&](const SearchPoint& p) { return SearchPoint{p.at, sign * p.value}; };
    const SearchPoint a = turned(first), b = turned(middle), c = turned(last);
    if (!(b.value >= a.value && b.value >= c.value && b.value < 0)) return {};
    const Maximum nearest = find_maximum([&](double at) { return sign * f(at); }, a, b, c);
    return change_of_sign(f, first, {nearest.position, sign * nearest.value});
}

template <class F>
std::optional<double> first_change_of_sign(F f, double end) {
    const auto point = [&](int part) {
        const double at = end * part / parts;
        return SearchPoint{at, f(at)};
    };
    SearchPoint before = point(0), here = point(1);
    if (const auto found = change_of_sign(f, before, here)) return found;
    for (int part = 2; part <= parts; ++part) {
        const SearchPoint next = point(part);
        if (is_negative(before) == is_negative(next))
            if (const auto found = double_change(f, before, here, next)) return found;
        if (const auto found = change_of_sign(f, here, next)) return found;
        before = here, here = next;
    }
    return {};
}

}  // namespace

namespace {

// The first zero of the two factors of det J, of which the second is a share of the reach, less `margin` towards 0.
std::optional<double> first_zero(const Arm<double>& arm, const DenseOutput& dense, double end, double margin) {
    const auto pose_at = [&](double theta) { return pose(angles(dense.motion(theta))); };
    const Pose<double> at_start = pose_at(0.0);
    const auto zero_of = [&](auto factor, double most_change) -> std::optional<double> {
        const auto at = [&](double theta) { return factor(pose_at(theta)); };
        const double start = factor(at_start), sign = start < 0 ? -1 : 1;
        if (sign * start - most_change > margin) return {};
        if (margin > 0 && sign * start <= 2 * margin) return {};
        return first_change_of_sign([&](double theta) { return sign * at(theta) - margin; }, end);
    };
    const double turn2 = dense.most_change(1), turn3 = dense.most_change(2);
    const auto stretched = zero_of([&](const Pose<double>& p) { return sine_of_bend(arm, p); }, turn3);
    const auto on_axis = zero_of([&](const Pose<double>& p) { return radius(arm, p) / reach(arm); }, turn2 + turn3);
    if (stretched && on_axis) return std::min(*stretched, *on_axis);
    return stretched ? stretched : on_axis;
}

}  // namespace

std::optional<double> first_passage(const Arm<double>& arm, const DenseOutput& dense, double end) {
    return first_zero(arm, dense, end, 0);
}

std::optional<double> just_before_passage(const Arm<double>& arm, const DenseOutput& dense) {
    constexpr double close = 1e-9;
    return first_zero(arm, dense, 1, close);
}

}  // namespace arm3r
