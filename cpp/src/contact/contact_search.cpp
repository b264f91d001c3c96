#include "contact/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arm3r/numbers/dual.hpp"
#include "contact/contact_watch.hpp"

namespace arm3r {
namespace {

enum Signal { depth_signal, first_edge, last_edge = 4, release_signal, force_signal };

// Whether the clock can hardly distinguish the two instants of a bracket.
bool is_narrow(const DenseOutput& dense, double a, double b) {
    const double t = std::abs(dense.t0 + dense.h * b);
    return (b - a) * dense.h <= std::max(event_time_tolerance, 4 * std::numeric_limits<double>::epsilon() * t) ||
           0.5 * (a + b) == a || 0.5 * (a + b) == b;
}

// m: the rounding errors of a depth in a step: those of the angles, of the tip's position and of the wall's.
double rounding_of_depth(const Plant<double>& plant, const DenseOutput& dense) {
    const auto size = [](const Vec3<double>& v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); };
    const Vec3<double> origin = wall_at(plant.wall, dense.t0 + dense.h).position;
    const double of_tip = reach(plant.arm) * (1 + size(angles(dense.motion(0)))) + size(base_position(plant.arm));
    const double of_wall = size(origin) + size(plant.wall.point) + std::abs(plant.wall.face_offset);
    return 4 * std::numeric_limits<double>::epsilon() * (of_tip + of_wall);
}

}  // namespace

ContactSearch::SignalSample ContactSearch::sample(const DenseOutput& dense, double theta) const {
    const Indentation<double> in = indentation_at(plant_, dense, theta);
    const double half1 = plant_.wall.half1, half2 = plant_.wall.half2, stiffness = plant_.contact.stiffness[0];
    SignalSample sample{{in.depth, half1 - in.across1, half1 + in.across1, half2 - in.across2, half2 + in.across2},
                        {in.rate, -in.slip1, in.slip1, -in.slip2, in.slip2}};
    if (!is_damped(plant_.contact.law)) {
        sample.value[force_signal] = stiffness * in.depth;
        sample.rate[force_signal] = stiffness * in.rate;
        return sample;
    }
    const NormalForce<Dual<1>> along = normal_force_law(
        plant_.contact, indentation_at(plant_, dense, Dual<1>::variable(theta, 0)));  // derivatives by theta
    sample.value[release_signal] = along.release.number;
    sample.rate[release_signal] = along.release.slope[0];
    sample.value[force_signal] = along.total.number;
    sample.rate[force_signal] = along.total.slope[0];
    return sample;
}

// Depth 0 counts as released: a tip at the surface has no force.
bool ContactSearch::has_crossed(const ZeroCrossing& event, const SignalSample& here) {
    const double value = event.sign * here.value[event.signal];
    const bool is_release = event.signal == depth_signal && event.sign > 0;
    return is_release ? value <= 0 : value < 0;
}

bool ContactSearch::within_outline(const SignalSample& here) {
    return std::all_of(here.value.begin() + first_edge, here.value.begin() + last_edge + 1,
                       [](double distance) { return distance >= 0; });
}

double ContactSearch::root(const DenseOutput& dense, const ZeroCrossing& event, double a, double b) const {
    while (!is_narrow(dense, a, b)) {
        const double middle = 0.5 * (a + b);
        (has_crossed(event, sample(dense, middle)) ? b : a) = middle;
    }
    return b;
}

double ContactSearch::turning_point(const DenseOutput& dense, const ZeroCrossing& event, double a, double b) const {
    while (!is_narrow(dense, a, b)) {
        const double middle = 0.5 * (a + b);
        (event.sign * sample(dense, middle).rate[event.signal] < 0 ? a : b) = middle;
    }
    return b;
}

double ContactSearch::turning_value(const DenseOutput& dense, int signal, double a, const SignalSample& at_a, double b,
                                    const SignalSample& at_b) const {
    const bool is_by_theta = is_damped(plant_.contact.law) && (signal == release_signal || signal == force_signal);
    return tangents_meet(at_a.value[signal], at_a.rate[signal], at_b.value[signal], at_b.rate[signal],
                         (b - a) * (is_by_theta ? 1 : dense.h));
}

std::optional<double> ContactSearch::first_crossing(const DenseOutput& dense, const ZeroCrossing& event, double a,
                                                    const SignalSample& at_a, double b,
                                                    const SignalSample& at_b) const {
    const int i = event.signal;
    if (has_crossed(event, at_b)) return root(dense, event, a, b);
    if (event.sign * at_a.rate[i] < 0 && event.sign * at_b.rate[i] > 0) {  // it may have been negative in between
        if (event.sign * turning_value(dense, i, a, at_a, b, at_b) > 0) return std::nullopt;
        const double lowest = turning_point(dense, event, a, b);
        if (has_crossed(event, sample(dense, lowest))) return root(dense, event, a, lowest);
    }
    return std::nullopt;
}

void ContactSearch::update_peak(const DenseOutput& dense, double a, const SignalSample& at_a, double b,
                                const SignalSample& at_b, Peak& peak) const {
    const auto include = [&](double theta, const SignalSample& there) {
        peak.include(there.value[force_signal], dense.t0 + theta * dense.h);
    };
    include(a, at_a);
    include(b, at_b);
    if (!(at_a.rate[force_signal] > 0 && at_b.rate[force_signal] < 0)) return;
    if (turning_value(dense, force_signal, a, at_a, b, at_b) < peak.force) return;
    const double top = turning_point(dense, {force_signal, -1, ContactMode::contact}, a, b);
    include(top, sample(dense, top));
}

void ContactSearch::include_peak(const DenseOutput& dense, double end, Peak& peak) const {
    double a = 0;
    SignalSample at_a = sample(dense, a);
    for (int n = 1; n < samples_per_step; ++n) {
        const double b = end * n / (samples_per_step - 1);
        const SignalSample at_b = sample(dense, b);
        update_peak(dense, a, at_a, b, at_b, peak);
        a = b;
        at_a = at_b;
    }
}

double ContactSearch::impulse(const DenseOutput& dense, double a, double b) const {
    if (is_linear(plant_.contact.law)) return impulse_by_gauss(plant_, plant_.contact, dense, a, b);
    constexpr double negligible = 1e-4;  // a depth, as a share of the largest: less than 1e-8 of the impulse lies below
    const double depth_a = depth(dense, a), depth_b = depth(dense, b);
    const double largest = std::max({depth_a, depth(dense, 0.5 * (a + b)), depth_b});
    // Rounding errors of a depth near zero grow by any factor, however short the part.
    const double least = std::max(negligible * largest, rounding_of_depth(plant_, dense));
    constexpr int halvings = 20;  // from any depth to a negligible one it takes less
    return impulse_in_parts(dense, a, depth_a, b, depth_b, least, halvings);
}

double ContactSearch::impulse_in_parts(const DenseOutput& dense, double a, double depth_a, double b, double depth_b,
                                       double least, int halvings) const {
    constexpr double most_growth = 1.5;  // of the depth in a part
    const double middle = 0.5 * (a + b), depth_middle = depth(dense, middle);
    const double low = std::min(depth_a, depth_b), high = std::max({depth_a, depth_middle, depth_b});
    if (halvings == 0 || !(high > most_growth * low && high > least))
        return impulse_by_gauss(plant_, plant_.contact, dense, a, b);
    return impulse_in_parts(dense, a, depth_a, middle, depth_middle, least, halvings - 1) +
           impulse_in_parts(dense, middle, depth_middle, b, depth_b, least, halvings - 1);
}

double ContactSearch::depth(const DenseOutput& dense, double theta) const {
    return indentation_at(plant_, dense, theta).depth;
}

std::optional<Crossing> ContactSearch::next(const DenseOutput& dense, double from, ContactMode mode, Peak& peak) const {
    if (!plant_.has_wall) return std::nullopt;
    double a = from;
    SignalSample at_a = sample(dense, a);
    for (int n = 1; n < samples_per_step; ++n) {
        const double b = from + (1.0 - from) * n / (samples_per_step - 1);
        const SignalSample at_b = sample(dense, b);
        std::optional<Crossing> first;
        const auto consider = [&](const ZeroCrossing& event) {
            const std::optional<double> theta = first_crossing(dense, event, a, at_a, b, at_b);
            if (theta && (!first || *theta < first->theta)) first = {*theta, event.next};
        };
        if (mode == ContactMode::free) {
            consider({depth_signal, -1, ContactMode::contact});
            if (first && !within_outline(sample(dense, first->theta))) first->next = ContactMode::embedded;
        } else {
            if (is_touching(mode) && plant_.wall.has_outline)
                for (int edge = first_edge; edge <= last_edge; ++edge) consider({edge, +1, ContactMode::embedded});
            consider({depth_signal, +1, ContactMode::free});
            if (mode == ContactMode::contact && is_damped(plant_.contact.law))
                consider({release_signal, +1, ContactMode::separated});
            if (mode == ContactMode::separated) consider({release_signal, -1, ContactMode::contact});
        }
        if (mode == ContactMode::contact)
            first ? update_peak(dense, a, at_a, first->theta, sample(dense, first->theta), peak)
                  : update_peak(dense, a, at_a, b, at_b, peak);
        if (first) return first;
        a = b;
        at_a = at_b;
    }
    return std::nullopt;
}

}  // namespace arm3r
