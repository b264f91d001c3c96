#include "trust/linear_impact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

// The time from the end of the push, at a speed of leaving u, until the depth is 0.
double release_time(const LinearImpact& of, double g_over_u) {
    const double at_once = of.c / of.k;
    return 2 * at_once / (1 + std::sqrt(1 - 2 * g_over_u * at_once));  // NaN: the tip falls back
}

// The first extremum of the force after t = 0 may lie before it.
double extremum(const LinearImpact& of) {
    const Swing f = force_swing(of);
    return atan2(force_rate(of), f.b * f.first + f.a * f.second) / f.b;
}

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
    const ImpactNumbers numbers{impact.force(impact.time_of_peak()), end + release_time(impact, impact.g / leaving),
                                impact.m * (impact.v + leaving + impact.g * end)};
    if (!(leaving > 0) || !std::isfinite(numbers.duration)) return {};
    return numbers;
}

std::optional<ImpactNumbers> departures(const LinearImpact& impact, const Disturbance& disturbance) {  // (9.3)
    const double time = disturbance.time, peak = impact.force(impact.time_of_peak());
    const double gain = time * (std::sqrt(impact.k * impact.m) + impact.c);  // kg: N by m/s^2
    const double share = disturbance.mobility * gain;
    if (!(share < 1)) return {};
    const double r = (disturbance.acceleration + disturbance.mobility * peak) / (1 - share);
    const double force = gain * r;
    if (!(impact.force(impact.time_of_least_force()) < -force)) return {};
    const double end = impact.time_of_fall(0), leaving = -impact.speed(end);
    const double early = force < peak ? impact.time_of_fall(force) : 0, late = impact.time_of_fall(-force);
    const double shift = std::max(end - early, late - end);
    const double slowest = leaving - r * time - shift * (std::abs(impact.g) + force / impact.m);
    const double g = std::abs(impact.g), release = release_time(impact, impact.g / leaving);
    if (!(slowest > 0)) return {};
    const double longest = release_time(impact, (g + disturbance.acceleration) / slowest);
    const double shortest = release_time(impact, -(g + disturbance.acceleration) / slowest);
    if (!(late + longest <= time)) return {};
    return ImpactNumbers{force, shift + std::max(longest - release, release - shortest), force * late};
}

}  // namespace arm3r
