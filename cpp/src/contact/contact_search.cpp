#include "contact/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arm3r/numbers/dual.hpp"

namespace arm3r {
namespace {

enum Signal { depth_signal, first_edge, last_edge = 4, release_signal, force_signal };

// A bracket of two instants that the clock can hardly tell apart.
bool is_narrow(const Inside& inside, double a, double b) {
    const double t = std::abs(inside.t0 + inside.h * b);
    return (b - a) * inside.h <= std::max(finest_event, 4 * std::numeric_limits<double>::epsilon() * t) ||
           0.5 * (a + b) == a || 0.5 * (a + b) == b;
}

template <class T>
Indentation<T> indentation_at(const Plant<double>& plant, const Inside& inside, const T& theta) {
    const auto y = [&](std::size_t i) { return inside.component(i, theta); };
    const Pose<T> p = pose(Vec3<T>(y(0), y(1), y(2)));
    const WallState<T> wall = wall_at(plant.wall, T(inside.t0 + theta * inside.h));
    return tip_indentation(plant, wall, p, Vec3<T>(y(3), y(4), y(5)));
}

}  // namespace

Mode ContactWatch::mode_at_start(double t, const FullState& y) const {
    if (!plant_.has_wall) return Mode::free;
    const Pose<double> p = pose(angles(y));
    const Indentation<double> in = tip_indentation(plant_, wall_at(plant_.wall, t), p, rates(y));
    if (!(in.depth > 0)) return Mode::free;
    if (!(inside_outline(plant_.wall, in) >= 0)) return Mode::embedded;
    return is_damped(plant_.contact.law) && push(plant_.contact, in).release < 0 ? Mode::separated : Mode::contact;
}

ContactWatch::Look ContactWatch::look(const Inside& inside, double theta) const {
    const Indentation<double> in = indentation_at(plant_, inside, theta);
    const double half1 = plant_.wall.half1, half2 = plant_.wall.half2, stiffness = plant_.contact.stiffness[0];
    Look look{{in.depth, half1 - in.across1, half1 + in.across1, half2 - in.across2, half2 + in.across2},
              {in.rate, -in.slip1, in.slip1, -in.slip2, in.slip2}};
    if (!is_damped(plant_.contact.law)) {
        look.value[force_signal] = stiffness * in.depth;
        look.rate[force_signal] = stiffness * in.rate;
        return look;
    }
    const Push<Dual<1>> along =
        push(plant_.contact, indentation_at(plant_, inside, Dual<1>::variable(theta, 0)));  // slopes by theta
    look.value[release_signal] = along.release.number;
    look.rate[release_signal] = along.release.slope[0];
    look.value[force_signal] = along.total.number;
    look.rate[force_signal] = along.total.slope[0];
    return look;
}

// Letting go includes depth 0: a tip that only touches feels nothing.
bool ContactWatch::has_fallen(const Falling& falling, const Look& here) {
    const double value = falling.sign * here.value[falling.signal];
    const bool letting_go = falling.signal == depth_signal && falling.sign > 0;
    return letting_go ? value <= 0 : value < 0;
}

bool ContactWatch::within_outline(const Look& here) {
    return std::all_of(here.value.begin() + first_edge, here.value.begin() + last_edge + 1,
                       [](double distance) { return distance >= 0; });
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

void ContactWatch::look_for_peak(const Inside& inside, double a, const Look& at_a, double b, const Look& at_b,
                                 Peak& peak) const {
    const auto include = [&](double theta, const Look& there) {
        peak.include(there.value[force_signal], inside.t0 + theta * inside.h);
    };
    include(a, at_a);
    include(b, at_b);
    if (!(at_a.rate[force_signal] > 0 && at_b.rate[force_signal] < 0)) return;
    const double top = turning_point(inside, {force_signal, -1, Mode::contact}, a, b);
    include(top, look(inside, top));
}

double ContactWatch::impulse(const Inside& inside, double a, double b) const {
    constexpr double place[] = {0, 0.53846931010568309, 0.90617984593866399};  // Gauss and Legendre, five points
    constexpr double weight[] = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
    const auto force = [&](double x) {
        return normal_force(plant_.contact, indentation_at(plant_, inside, 0.5 * ((a + b) + (b - a) * x)));
    };
    double sum = weight[0] * force(0);
    for (int i = 1; i < 3; ++i) sum += weight[i] * (force(-place[i]) + force(place[i]));
    return 0.5 * (b - a) * inside.h * sum;
}

std::optional<Crossing> ContactWatch::next(const Inside& inside, double from, Mode mode, Peak& peak) const {
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
            if (is_touching(mode) && plant_.wall.has_outline)
                for (int edge = first_edge; edge <= last_edge; ++edge) consider({edge, +1, Mode::embedded});
            consider({depth_signal, +1, Mode::free});
            if (mode == Mode::contact && is_damped(plant_.contact.law)) consider({release_signal, +1, Mode::separated});
            if (mode == Mode::separated) consider({release_signal, -1, Mode::contact});
        }
        if (mode == Mode::contact)
            first ? look_for_peak(inside, a, at_a, first->theta, look(inside, first->theta), peak)
                  : look_for_peak(inside, a, at_a, b, at_b, peak);
        if (first) return first;
        a = b;
        at_a = at_b;
    }
    return std::nullopt;
}

}  // namespace arm3r
