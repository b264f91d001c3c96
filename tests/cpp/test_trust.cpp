#include <cmath>
#include <numbers>

#include "check.hpp"
#include "fixtures.hpp"
#include "trust/enclosure.hpp"
#include "trust/linear_impact.hpp"

namespace arm3r {

TEST_SUITE(trust)

// ---- intervals

static double within(Random& random, const Interval& x) { return x.low + (x.high - x.low) * random.in(0, 1); }

static bool holds(const Interval& x, double value) {
    const double rounding = 1e-14 * (1 + std::abs(value));
    return x.low - rounding <= value && value <= x.high + rounding;
}

TEST_CASE(an_interval_holds_every_value_of_a_formula) {
    Random random(41);
    for (int i = 0; i < 10'000; ++i) {
        const double place = random.in(-8, 8), width = random.in(0, 7), at = random.in(0.1, 3);
        const Interval x(place, place + width), y(at, at + random.in(0, 2));
        const double a = within(random, x), b = within(random, y);
        CHECK(holds(x + y, a + b));
        CHECK(holds(x - y, a - b));
        CHECK(holds(x * y, a * b));
        CHECK(holds(x / y, a / b));
        CHECK(holds(tanh(x), std::tanh(a)));
        CHECK(holds(sincos(x).sin, std::sin(a)));
        CHECK(holds(sincos(x).cos, std::cos(a)));
    }
}

TEST_CASE(a_sine_reaches_its_tops_and_no_further) {
    const SinCos<Interval> half = sincos(Interval(-0.1, 2.0));
    CHECK(half.sin.high == 1);
    CHECK(std::abs(half.sin.low + std::sin(0.1)) < 1e-15);
    CHECK(half.cos.high == 1);
    CHECK(std::abs(half.cos.low - std::cos(2.0)) < 1e-15);
}

// ---- the impact of a mass

struct Flight {
    double depth = 0, speed, time = 0, peak = 0, impulse = 0;
};

// The motion in small steps, with the disturbed equation, until the depth is 0 again.
template <class Disturb>
static Flight flown(const LinearImpact& impact, const Disturb& disturb) {
    Flight at{.speed = impact.v};
    const double h = 1e-5 * std::sqrt(impact.m / impact.k);
    const auto force = [&](double depth, double speed) { return std::max(0.0, impact.k * depth + impact.c * speed); };
    const auto acceleration = [&](double t, double depth, double speed) {
        const auto [r, w] = disturb(t);
        return impact.g + r - w * force(depth, speed);
    };
    do {  // the midpoint rule
        const double slope = acceleration(at.time, at.depth, at.speed);
        const double depth = at.depth + 0.5 * h * at.speed, speed = at.speed + 0.5 * h * slope;
        at.peak = std::max(at.peak, force(at.depth, at.speed));
        at.impulse += h * force(depth, speed);
        at.speed += h * acceleration(at.time + 0.5 * h, depth, speed);
        at.depth += h * speed;
        at.time += h;
    } while (at.depth > 0);
    return at;
}

static LinearImpact random_impact(Random& random) {
    const double m = random.in(0.2, 5), k = std::exp(random.in(std::log(1e3), std::log(1e6)));
    const double v = random.in(0.05, 1), typical = v * std::sqrt(k / m);
    return {m, k, 2 * std::sqrt(k * m) * std::max(0.0, random.in(-0.3, 0.7)), v, 0.1 * typical * random.in(-1, 1)};
}

TEST_CASE(the_closed_forms_are_those_of_the_motion_in_small_steps) {
    Random random(42);
    for (int i = 0; i < 8; ++i) {
        const LinearImpact impact = random_impact(random);
        const Flight due = flown(impact, [&](double) { return std::pair(0.0, 1 / impact.m); });
        const ImpactNumbers found = numbers_of(impact).value();
        CHECK(std::abs(found.peak_force / due.peak - 1) < 1e-8);
        CHECK(std::abs(found.duration / due.time - 1) < 1e-4);
        CHECK(std::abs(found.impulse / due.impulse - 1) < 1e-4);
    }
}

TEST_CASE(a_spring_alone_has_the_textbooks_numbers) {
    const ImpactNumbers found = numbers_of({0.55, 1000, 0, 0.05, 0}).value();
    CHECK(std::abs(found.peak_force - 0.05 * std::sqrt(550)) < 1e-12);
    CHECK(std::abs(found.duration - std::numbers::pi * std::sqrt(0.55e-3)) < 1e-12);
    CHECK(std::abs(found.impulse - 2 * 0.55 * 0.05) < 1e-12);
}

TEST_CASE(a_mass_that_is_pressed_on_through_a_damper_does_not_come_back) {
    CHECK(!numbers_of({1, 1000, 40, 0.01, 10}).has_value());
}

TEST_CASE(no_disturbed_motion_departs_further_than_derived) {
    Random random(43);
    int bounded = 0;
    double largest_share = 0;
    for (int i = 0; i < 40; ++i) {
        const LinearImpact impact = random_impact(random);
        const ImpactNumbers form = numbers_of(impact).value();
        const double omega = std::sqrt(impact.k / impact.m);
        const Disturbance within{0.03 * impact.v * omega * random.in(0, 1), 0.03 * omega / impact.m * random.in(0, 1),
                                 1.5 * form.duration};
        const auto bounds = departures(impact, within);
        if (!bounds || bounds->end > within.time) continue;
        ++bounded;
        const double turns = random.in(0, 3) * omega, phase = random.in(0, 6), drift = random.in(-1, 1) > 0 ? 1 : -1;
        const Flight flight = flown(impact, [&](double t) {
            return std::pair(within.acceleration * (turns > omega ? std::sin(turns * t + phase) : drift),
                             1 / impact.m + drift * within.mobility_rate * t);
        });
        const auto share = [](double own, double due, double most) {
            return std::abs(own - due) / (most + 1e-4 * due);
        };
        largest_share = std::max({largest_share, share(flight.peak, form.peak_force, bounds->most.peak_force),
                                  share(flight.time, form.duration, bounds->most.duration),
                                  share(flight.impulse, form.impulse, bounds->most.impulse)});
    }
    CHECK(bounded > 20);
    CHECK(largest_share <= 1);
    CHECK(largest_share > 0.3);  // the bounds are not far beyond what happens
}

// ---- the motion of the arm

TEST_CASE(an_enclosure_holds_the_motion_and_what_the_tip_shows) {
    const Setup setup = make_setup(unequal_params().set("initial.q", {0.3, 0.4, -0.9}));
    const Vec3<double> n(0.6, 0, 0.8), qd(0.2, -0.1, 0.3);
    const Enclosure start = at_instant(setup.plant, n, setup.q, qd);
    const Enclosure box = enclose(setup.plant, n, setup.q, qd, {0.01, 0.02}).value();
    for (int i = 0; i < 3; ++i) {
        CHECK(box.q[i].contains(start.q[i]));
        CHECK(box.qd[i].contains(start.qd[i]));
        CHECK(box.q[i].contains(Interval(setup.q[i] + 0.01 * qd[i])));
    }
    CHECK(box.acceleration.contains(start.acceleration));
    const double mass = effective_mass(setup.plant.arm, pose(setup.q), n), h = 1e-6;
    const Vec3<double> later(setup.q[0] + h * qd[0], setup.q[1] + h * qd[1], setup.q[2] + h * qd[2]);
    const double rate = (1 / effective_mass(setup.plant.arm, pose(later), n) - 1 / mass) / h;
    CHECK(std::abs(start.mobility_rate.low - rate) < 1e-4 * std::abs(rate));
    CHECK(start.mobility_rate.low == start.mobility_rate.high);
    CHECK(!enclose(setup.plant, n, setup.q, qd, {10, 1}).has_value());
}

TEST_CASE(a_compensated_arm_at_rest_stays_for_ever) {
    const Setup setup = make_setup(
        unequal_params().choose("controller.type", "gravity_compensation").set("controller.gravity", {0, 0, -9.80665}));
    const Enclosure box = enclose(setup.plant, {1, 0, 0}, setup.q, {0, 0, 0}, {1e6, 0}).value();
    for (int i = 0; i < 3; ++i) CHECK(box.q[i].low == box.q[i].high);
}

TEST_SUITE_END()

}  // namespace arm3r
