#include "events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arm3r {
namespace {

constexpr int depth_signal = 0, edges = 4;  // the distances inside the outline are signals 1 to 4

// A bracket of two instants that the clock can hardly tell apart.
bool is_narrow(const Inside& inside, double a, double b) {
    const double t = std::abs(inside.t0 + inside.h * b);
    return (b - a) * inside.h <= std::max(finest_event, 4 * std::numeric_limits<double>::epsilon() * t) ||
           0.5 * (a + b) == a || 0.5 * (a + b) == b;
}

}  // namespace

Mode ContactWatch::mode_at_start(const FullState& y) const {
    if (!plant_.has_wall) return Mode::free;
    const Pose<double> p = pose(angles(y));
    const Indentation<double> in = tip_indentation(plant_, wall_at(plant_.wall, 0.0), p, rates(y));
    if (!(in.depth > 0)) return Mode::free;
    return inside_outline(plant_.wall, in) >= 0 ? Mode::contact : Mode::embedded;
}

ContactWatch::Look ContactWatch::look(const Inside& inside, double theta) const {
    const FullState y = inside(theta);
    const Pose<double> p = pose(angles(y));
    const WallState<double> wall = wall_at(plant_.wall, inside.t0 + theta * inside.h);
    const Indentation<double> in = tip_indentation(plant_, wall, p, rates(y));
    const double half1 = plant_.wall.half1, half2 = plant_.wall.half2;
    return {{in.depth, half1 - in.across1, half1 + in.across1, half2 - in.across2, half2 + in.across2},
            {in.rate, -in.slip1, in.slip1, -in.slip2, in.slip2}};
}

// Letting go includes depth 0: a tip that only touches feels nothing.
bool ContactWatch::has_fallen(const Falling& falling, const Look& here) {
    const double value = falling.sign * here.value[falling.signal];
    const bool letting_go = falling.signal == depth_signal && falling.sign > 0;
    return letting_go ? value <= 0 : value < 0;
}

bool ContactWatch::within_outline(const Look& here) {
    return std::all_of(here.value.begin() + 1, here.value.end(), [](double distance) { return distance >= 0; });
}

double ContactWatch::root(const Inside& inside, const Falling& falling, double a, double b) const {
    while (!is_narrow(inside, a, b)) {
        const double middle = 0.5 * (a + b);
        (has_fallen(falling, look(inside, middle)) ? b : a) = middle;
    }
    return b;
}

double ContactWatch::turning_point(const Inside& inside, const Falling& falling, double a, double b) const {
    while (!is_narrow(inside, a, b)) {
        const double middle = 0.5 * (a + b);
        (falling.sign * look(inside, middle).rate[falling.signal] < 0 ? a : b) = middle;
    }
    return b;
}

std::optional<double> ContactWatch::first_fall(const Inside& inside, const Falling& falling, double a, const Look& at_a,
                                               double b, const Look& at_b) const {
    const int i = falling.signal;
    if (has_fallen(falling, at_b)) return root(inside, falling, a, b);
    if (falling.sign * at_a.rate[i] < 0 &&
        falling.sign * at_b.rate[i] > 0) {  // it may have dipped below zero in between
        const double lowest = turning_point(inside, falling, a, b);
        if (has_fallen(falling, look(inside, lowest))) return root(inside, falling, a, lowest);
    }
    return std::nullopt;
}

double ContactWatch::deepest_of(const Inside& inside, double a, const Look& at_a, double b, const Look& at_b) const {
    const double at_end = at_b.value[depth_signal];
    if (!(at_a.rate[depth_signal] > 0 && at_b.rate[depth_signal] < 0)) return at_end;
    const Falling rising{depth_signal, -1, Mode::contact};
    return std::max(at_end, look(inside, turning_point(inside, rising, a, b)).value[depth_signal]);
}

double ContactWatch::depth_integral(const Inside& inside, double a, double b) const {
    constexpr double place[] = {0, 0.53846931010568309, 0.90617984593866399};  // Gauss and Legendre, five points
    constexpr double weight[] = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
    const auto depth = [&](double x) { return look(inside, 0.5 * ((a + b) + (b - a) * x)).value[depth_signal]; };
    double sum = weight[0] * depth(0);
    for (int i = 1; i < 3; ++i) sum += weight[i] * (depth(-place[i]) + depth(place[i]));
    return 0.5 * (b - a) * inside.h * sum;
}

std::optional<Crossing> ContactWatch::next(const Inside& inside, double from, Mode mode, double& deepest) const {
    if (!plant_.has_wall) return std::nullopt;
    double a = from;
    Look at_a = look(inside, a);
    for (int n = 1; n < looks_; ++n) {
        const double b = from + (1.0 - from) * n / (looks_ - 1);
        const Look at_b = look(inside, b);
        std::optional<Crossing> first;
        const auto consider = [&](const Falling& falling) {
            const std::optional<double> theta = first_fall(inside, falling, a, at_a, b, at_b);
            if (theta && (!first || *theta < first->theta)) first = {*theta, falling.next};
        };
        if (mode == Mode::free) {
            consider({depth_signal, -1, Mode::contact});
            if (first && !within_outline(look(inside, first->theta))) first->next = Mode::embedded;
        } else {
            consider({depth_signal, +1, Mode::free});
            if (mode == Mode::contact) {
                for (int edge = 1; edge <= edges; ++edge) consider({edge, +1, Mode::embedded});
                deepest =
                    std::max(deepest, first ? deepest_of(inside, a, at_a, first->theta, look(inside, first->theta))
                                            : deepest_of(inside, a, at_a, b, at_b));
            }
        }
        if (first) return first;
        a = b;
        at_a = at_b;
    }
    return std::nullopt;
}

}  // namespace arm3r
