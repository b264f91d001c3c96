#include "trust/linear_impact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "arm3r/model/restitution.hpp"

namespace arm3r {
namespace {

// x(t) = rest + e^(-a t) (first cos b t + second sin b t), from x and its rate at t = 0.
struct Swing {
    double a, b, rest, first, second;

    Swing(const LinearImpact& of, double rest, double x, double rate)
        : a(of.c / (2 * of.m)),
          b(std::sqrt(of.k / of.m - a * a)),
          rest(rest),
          first(x - rest),
          second((rate + a * first) / b) {}

    double operator()(double t) const {
        const auto [sine, cosine] = sincos(b * t);
        return rest + exp(-a * t) * (first * cosine + second * sine);
    }
};

double force_rate(const LinearImpact& of) { return of.k * of.v + of.c * (of.g - of.c * of.v / of.m); }  // at t = 0
Swing force_swing(const LinearImpact& of) { return {of, of.m * of.g, of.c * of.v, force_rate(of)}; }

// The time from the end of the push, at a speed of leaving u, until the depth is 0; NaN: the tip falls back.
double release_time(const LinearImpact& of, double g, double u) {
    const double at_once = of.c / of.k;
    return of.c > 0 ? 2 * at_once / (1 + std::sqrt(1 - 2 * at_once * g / u)) : 0;
}

// The first extremum of the force after t = 0 may lie before it.
double extremum(const LinearImpact& of) {
    const Swing f = force_swing(of);
    return atan2(force_rate(of), f.b * f.first + f.a * f.second) / f.b;
}

// The integral of |sin b s|/b from 0 to t, and the integral of that; for b t up to 2 pi, and beyond it infinite.
struct SineIntegrals {
    double once, twice;
};

SineIntegrals sine_integrals(double b, double t) {
    using std::numbers::pi;
    const double angle = b * t, b_2 = b * b;
    const auto [sine, cosine] = sincos(angle);
    if (angle <= 1e-3) return {t * t / 2, t * t * t / 6};
    if (angle <= pi) return {(1 - cosine) / b_2, (angle - sine) / (b_2 * b)};
    if (angle <= 2 * pi) return {(3 + cosine) / b_2, (3 * angle - 2 * pi + sine) / (b_2 * b)};
    return {INFINITY, INFINITY};
}

// How far the force may depart from that of the impact by the time t (9.3).
class ForceDeparture {
public:
    const double peak;  // N, of the impact

    ForceDeparture(const LinearImpact& impact, const Disturbance& disturbance)
        : peak(impact.force(impact.time_of_peak())), impact_(impact), disturbance_(disturbance) {
        const double share = disturbance.mobility_rate * by_rate(disturbance.time);
        const double steady = disturbance.acceleration * by_acceleration(disturbance.time);
        largest_force_ = share < 1 ? (peak + steady) / (1 - share) : INFINITY;
    }

    double operator()(double t) const {
        return disturbance_.acceleration * by_acceleration(t) +
               disturbance_.mobility_rate * largest_force_ * by_rate(t);
    }

    double of_speed() const {
        const double t = disturbance_.time;
        return (disturbance_.acceleration + disturbance_.mobility_rate * largest_force_ * t / 2) * t;
    }

    // Both up to a time, from upper bounds on short intervals.
    std::pair<double, double> of_peak_and_impulse(double until) const {
        constexpr int intervals = 64;
        const double top = impact_.time_of_peak(), width = until / intervals;
        double highest = peak, impulse = 0;
        for (int i = 0; i < intervals; ++i) {
            const double from = i * width, to = from + width, here = (*this)(to);
            highest = std::max(highest, impact_.force(std::clamp(top, from, to)) + here);
            impulse += here * width;
        }
        return {std::max(highest - peak, (*this)(top)), impulse};
    }

private:
    double by_acceleration(double t) const { return impact_.k * sine_integrals(b(), t).once + impact_.c * t; }
    double by_rate(double t) const { return impact_.k * sine_integrals(b(), t).twice + impact_.c * t * t / 2; }
    double b() const { return force_swing(impact_).b; }

    LinearImpact impact_;
    Disturbance disturbance_;
    double largest_force_;  // N, of the motion
};

}  // namespace

double LinearImpact::force(double t) const { return force_swing(*this)(t); }
double LinearImpact::speed(double t) const { return Swing(*this, 0, v, g - c * v / m)(t); }
double LinearImpact::time_of_peak() const { return std::max(0.0, extremum(*this)); }
double LinearImpact::time_of_least_force() const { return extremum(*this) + std::numbers::pi / force_swing(*this).b; }

double LinearImpact::time_of_fall(double f) const {
    const Swing swing = force_swing(*this);
    return bisect([&](double t) { return swing(t) - f; }, time_of_peak(), time_of_least_force());
}

std::optional<ImpactNumbers> numbers_of(const LinearImpact& impact) {  // (9.1)
    if (!(impact.force(impact.time_of_least_force()) < 0)) return {};
    const double end = impact.time_of_fall(0), leaving = -impact.speed(end);
    const ImpactNumbers numbers{impact.force(impact.time_of_peak()), end + release_time(impact, impact.g, leaving),
                                impact.m * (impact.v + leaving + impact.g * end)};
    if (!(leaving > 0) || !std::isfinite(numbers.duration)) return {};
    return numbers;
}

std::optional<Departures> departures(const LinearImpact& impact, const Disturbance& disturbance) {  // (9.3)
    const ForceDeparture departure(impact, disturbance);
    const double most = departure(disturbance.time);
    if (!(most >= 0) || !(impact.force(impact.time_of_least_force()) < -most)) return {};
    const double end = impact.time_of_fall(0), leaving = -impact.speed(end), late = impact.time_of_fall(-most);
    const double early = most < departure.peak ? impact.time_of_fall(most) : 0;
    const double shift = std::max(end - early, late - end);
    const double slowest = leaving - departure.of_speed() - shift * (std::abs(impact.g) + most / impact.m);
    const double g = std::abs(impact.g) + disturbance.acceleration;
    const double release = release_time(impact, impact.g, leaving), longest = release_time(impact, g, slowest);
    const double released = std::max(longest - release, release - release_time(impact, -g, slowest));
    const auto [peak, impulse] = departure.of_peak_and_impulse(late);
    if (impact.c > 0 && !(slowest > 0 && std::isfinite(longest))) return {};
    return Departures{{peak, shift + released, impulse}, late + longest};
}

}  // namespace arm3r
