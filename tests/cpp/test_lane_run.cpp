#include <numbers>

#include "check.hpp"
#include "fixtures.hpp"
#include "run/performance.hpp"

namespace arm3r {

// Three methods, one motion: series and fixed steps against Dormand and Prince, which looks for contact another way.
TEST_SUITE(marching)

static Params tight(Params params, std::string_view method) {
    params.choose("solver.method", method);
    params.set("solver.rtol", 1e-12).set("solver.atol", 1e-14).set("solver.tol", 1e-12);
    return params;
}

// Any arm before any wall.
static Params any_contact(Random& random) {
    Params params = random_params(random);
    if (random.in(0, 1) < 0.5) params.set("arm.friction", {0, 0, 0}).set("arm.gravity", {0, 0, -9.80665});
    params.set("initial.q", random.vector(-1.5, 1.5)).set("initial.qd", random.vector(-1, 1));
    params.set("wall", 1).set("wall.point", random.vector(-1.5, 1.5)).set("wall.normal", random.vector(-1, 1));
    if (random.in(0, 1) < 0.5) params.set("wall.size", {HUGE_VAL, HUGE_VAL});
    if (random.in(0, 1) < 0.5) params.set("wall.motion.velocity", random.in(-0.3, 0.3));
    else
        params.choose("wall.motion.type", "sinusoid")
            .set("wall.motion.amplitude", random.in(0, 0.3))
            .set("wall.motion.frequency", random.in(0.2, 3))
            .set("wall.motion.phase", random.in(-3, 3));
    params.set("wall.contact.stiffness", std::exp(random.in(2, 10))).set("wall.acts_on_arm", random.in(0, 1) < 0.7);
    if (random.in(0, 1) < 0.5) params.choose("controller.type", "gravity_compensation");
    return params.set("time.stop", 0.8).set("time.log_every", 0.05);
}

static bool is_valid(const Params& params) { return problems_of(params).empty(); }

TEST_CASE(series_find_the_contacts_forces_and_rows_that_dopri5_finds) {
    Random random(41);
    std::size_t events = 0;
    for (int n = 0; n < 400; ++n) {
        const Params params = any_contact(random);
        if (!is_valid(params)) continue;
        const Run truth = tight(params, "dopri5").run(), series = tight(params, "taylor").run();
        REQUIRE(series.outcome == truth.outcome, n << ": " << series.message << " against " << truth.message);
        REQUIRE(series.events.size() == truth.events.size());
        events += truth.events.size();
        for (std::size_t i = 0; i < truth.events.size(); ++i) {
            CHECK(series.events[i].type == truth.events[i].type);
            CHECK(std::abs(series.events[i].t - truth.events[i].t) < 1e-8);
        }
        CHECK(std::abs(series.impulse - truth.impulse) <= 1e-7 * (1 + truth.impulse));
        CHECK(std::abs(series.peak_force - truth.peak_force) <= 1e-7 * (1 + truth.peak_force));
        CHECK(std::abs(series.contact_time - truth.contact_time) <= 1e-8);
        CHECK(std::abs(series.final_force - truth.final_force) <= 1e-6 * (1 + truth.peak_force));
        for (const char* name : {"q1", "q2", "q3", "tip_dvx", "energy_dissipated", "work_wall"})
            for (std::size_t row = 0; row < truth.rows; ++row)
                CHECK(std::abs(column(series, name)[row] - column(truth, name)[row]) <= 1e-5, name);
    }
    CHECK(events > 20);
}

// Far from rest the torque of dry friction looks constant: its turning over, where a joint stops, must not be jumped.
TEST_CASE(series_see_a_joint_stop_in_dry_friction) {
    Params params;
    params.choose("controller.type", "gravity_compensation").set("arm.friction", {0.1, 0.1, 0.1}).set("wall", 1);
    params.set("wall.point", {1.78, 0, 0}).set("wall.acts_on_arm", 1).set("time.stop", 2.5);
    const Run truth = tight(params, "dopri5").set("solver.rtol", 1e-11).run(), exact = tight(params, "taylor").run(),
              usual = tight(params, "taylor").set("solver.tol", 1e-9).run();
    REQUIRE(truth.events.size() == 11);
    for (const Run* run : {&exact, &usual}) {
        REQUIRE(run->events.size() == 11);
        for (int i = 0; i < 3; ++i) CHECK(std::abs(run->q[i] - truth.q[i]) < 1e-7);
        CHECK(std::abs(run->peak_force - truth.peak_force) < 1e-7);
    }
}

// A wall that swings up to the tip of an arm at rest and past it by a hair.
static Params swinging_wall(double past) {
    Params params = unequal_params();
    params.choose("controller.type", "gravity_compensation").set("wall", 1).choose("wall.motion.type", "sinusoid");
    const Vec3<double> q(0.4, 0.7, -0.9), tip = tip_position(params.arm(), pose(q));
    params.set("wall.point", {tip[0] + 0.1 - past, 0, 0}).set("wall.motion.amplitude", 0.1);
    return params.set("wall.motion.frequency", 0.5).set("time.stop", 1.9);
}

TEST_CASE(grazing_contact_is_found_where_it_is_deeper_than_rounding_and_not_made_up) {
    for (const char* method : {"dopri5", "taylor"}) {
        for (const double past : {-1e-3, -1e-9, -1e-12})
            CHECK(swinging_wall(past).choose("solver.method", method).run().events.empty());
        for (const double past : {1e-3, 1e-6, 1e-9, 1e-12}) {
            const Run run = swinging_wall(past).choose("solver.method", method).run();
            REQUIRE(run.events.size() == 2);
            const double half = std::acos(1 - past / 0.1) / (2 * std::numbers::pi * 0.5);  // around the crest at 0.5 s
            const double close = (1e-3 + 1e-13 / past) * half + 1e-9;
            CHECK(std::abs(run.first_contact - (0.5 - half)) < close);
            CHECK(std::abs(run.contact_time - 2 * half) < close);
            CHECK(std::abs(run.peak_force - 1000 * past) < 1e-12);
            CHECK(run.final_force == 0);
        }
    }
}

// An arm at rest, a wall that comes steadily: all metrics are known.
TEST_CASE(metrics_of_a_steady_press_are_those_of_the_closed_form_by_every_method) {
    Params params = swinging_wall(0).choose("wall.motion.type", "constant").set("wall.motion.velocity", 0.2);
    params.set("time.stop", 1.3).set("solver.step", 0.01);
    const double t = 1.3 - 0.1 / 0.2, depth = 0.2 * t;
    for (const char* method : {"dopri5", "rk4", "taylor"}) {
        const Run run = params.choose("solver.method", method).run();
        CHECK(run.contacts == 1);
        CHECK(std::isnan(run.first_release));
        CHECK(std::abs(run.first_contact - 0.5) < 1e-9);
        CHECK(std::abs(run.contact_time - t) < 1e-9);
        CHECK(std::abs(run.final_force - 1000 * depth) < 1e-6);
        CHECK(std::abs(run.peak_force - 1000 * depth) < 1e-6);
        CHECK(std::abs(run.impulse - 500 * depth * t) < 1e-6);
    }
}

TEST_CASE(a_million_steps_are_not_needed_series_take_few) {
    Params params = unequal_params().choose("solver.method", "taylor").set("time.stop", 2);
    const Run fall = params.run();
    CHECK(fall.steps.accepted < 150);
    CHECK(fall.ledger_residual < 1e-7);
    params.choose("controller.type", "gravity_compensation").set("time.stop", 1000).set("time.log_every", 100);
    CHECK(params.run().steps.accepted < 100);  // at rest, to rounding
}

TEST_CASE(the_log_changes_nothing_but_the_rows) {
    Random random(43);
    for (const char* method : {"rk4", "taylor"}) {
        Params params = swinging_wall(0.02).choose("solver.method", method).set("wall.acts_on_arm", 1);
        const Run often = params.set("time.log_every", 1e-3).run(), seldom = params.set("time.log_every", 5).run();
        for (int i = 0; i < 3; ++i) CHECK(same_bits(often.q[i], seldom.q[i]));
        CHECK(same_bits(often.impulse, seldom.impulse));
        CHECK(often.events.size() == seldom.events.size());
        CHECK(last(often, "q2") == last(seldom, "q2"));
    }
}

// While other lanes move, a lane whose step is refused may have samples that are no numbers.
TEST_CASE(a_step_that_is_refused_leaves_nothing_in_the_sums) {
    TrackedQuantities all;
    all.force = all.path = all.limits = all.shortfall = all.overshoot = all.settling = all.path_maximum = true;
    const double nan = std::nan("");
    Segment<double> segment{0, 1, true, {}};
    segment.samples.fill({nan, nan, nan, 1});  // the last is a choice, and always a number
    PerformanceSums<double> sums;
    add_segment(all, boole, false, segment, sums);
    double largest = 0;
    each_sum(
        [&](double& sum) { largest = sum > -infinite ? std::max(largest, std::abs(sum))
                                     : sum == sum    ? largest
                                                     : nan; },
        sums);
    CHECK(largest <= 0);
}

TEST_SUITE_END()

}  // namespace arm3r
