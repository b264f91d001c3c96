#include "arm3r/model/restitution.hpp"
#include "check.hpp"
#include "contact/contact_search.hpp"
#include "fixtures.hpp"
#include "linear_algebra.hpp"

namespace arm3r {

// Runs against walls of every law and motion: the instants at which the force ends, and the energy balance.
TEST_SUITE(contact_machine)

// ---- a mass in one dimension: the straight arm turns about the vertical, without gravity, into a wall across its way;
// for small depths the circle is a line, to their square

struct Impact {
    static constexpr double speed = 1e-3;

    // From the touch to the last bit of contact, and a while.
    static Params params(std::string_view law, double stiffness) {
        Params params;
        params.choose("arm.convention", "slide").set("arm.gravity", {0, 0, 0}).set("arm.link1.inertia_axial", 0.3);
        params.set("arm.link2.length", 0.8).set("arm.link3.length", 0.6).set("initial.q", {0, 0, 0});
        params.set("initial.qd", {speed / radius, 0, 0}).set("wall", 1).set("wall.acts_on_arm", 1);
        params.set("wall.point", {1, 0, 0}).set("wall.normal", {0, -1, 0}).set("wall.size", {HUGE_VAL, HUGE_VAL});
        params.choose("wall.motion.type", "fixed").choose("wall.contact.law", law);
        params.set("wall.contact.stiffness", stiffness).set("solver.rtol", 1e-12).set("solver.atol", 1e-20);
        return params.set("time.stop", 8 / std::sqrt(stiffness / mass())).set("time.log_every", 1e9);
    }
    static constexpr double radius = 1.4;
    static double mass() {
        Params arm;
        arm.choose("arm.convention", "slide").set("arm.link1.inertia_axial", 0.3);
        arm.set("arm.link2.length", 0.8).set("arm.link3.length", 0.6);
        return mass_matrix(arm.arm(), pose(Vec3<double>(0, 0, 0)))(0, 0) / (radius * radius);
    }
    static double restitution(const Run& run) { return -run.qd[0] * radius / speed; }
    static double energy() { return 0.5 * mass() * speed * speed; }
};

static double kelvin_voigt_angle(double zeta) {
    if (zeta == 1) return 1;
    return zeta < 1 ? std::acos(zeta) / std::sqrt(1 - zeta * zeta) : std::acosh(zeta) / std::sqrt(zeta * zeta - 1);
}

static Params kelvin_voigt_impact(double zeta) {
    constexpr double k = 1e8;
    return Impact::params("kelvin_voigt", k).set("wall.contact.damping", 2 * zeta * std::sqrt(k * Impact::mass()));
}

static void check_balance(const Run& run, double e) {
    CHECK(std::abs(run.dissipated / Impact::energy() - (1 - e * e)) <= 1e-8);
    CHECK(run.ledger_residual <= 1e-9 * Impact::energy());
    CHECK(std::abs(run.impulse / (Impact::mass() * Impact::speed) - (1 + e)) <= 1e-8);
}

TEST_CASE(kelvin_voigt_returns_the_speed_of_its_closed_form) {
    for (const double zeta : {0.05, 0.1, 0.3, 0.8, 1.0, 2.0}) {
        const double e = std::exp(-2 * zeta * kelvin_voigt_angle(zeta));
        const Run run = kelvin_voigt_impact(zeta).run();
        CHECK(run.outcome == ARM3R_RUN_OK, run.message);
        CHECK(std::abs(Impact::restitution(run) - e) <= 1e-8, zeta << ": " << Impact::restitution(run));
        check_balance(run, e);
    }
    CHECK(std::abs(Impact::restitution(kelvin_voigt_impact(0.1).run()) - 0.744079398) <= 1e-8);
    CHECK(std::abs(Impact::restitution(kelvin_voigt_impact(1.0).run()) - 0.135335283) <= 1e-8);
}

// The force ends while the depth is still positive, the tip moves out freely, and contact ends at depth zero.
TEST_CASE(contact_lasts_longer_than_the_force_by_the_return_of_the_surface) {
    for (const double zeta : {0.1, 0.3, 0.8}) {
        const Params params = kelvin_voigt_impact(zeta);
        const double omega = std::sqrt(1e8 / Impact::mass()), damped = omega * std::sqrt(1 - zeta * zeta);
        const double until = 2 * std::acos(zeta) / damped, e = std::exp(-zeta * omega * until);
        const double deformation = Impact::speed / damped * e * std::sin(damped * until);
        const Run run = Params(params).set("time.log_every", 8e-3 / omega).run();
        REQUIRE(run.events.size() == 2u);
        CHECK(std::abs(run.contact_time / (until + deformation / (e * Impact::speed)) - 1) <= 1e-8);
        const auto t = column(run, "t"), force = column(run, "f_on_tip_y"), depth = column(run, "depth"),
                   flag = column(run, "contact"), stored = column(run, "energy_contact"),
                   residual = column(run, "energy_residual");
        int still_deformed = 0;
        for (std::size_t i = 0; i < run.rows; ++i) {
            const double since = t[i] - run.events[0].t;
            CHECK((force[i] < 0) == (flag[i] == 1 && since < until));
            CHECK(force[i] <= 0);
            CHECK((flag[i] == 1) == (depth[i] > 0));
            CHECK(std::abs(stored[i] - flag[i] * 0.5e8 * depth[i] * depth[i]) <= 1e-12 * Impact::energy());
            CHECK(std::abs(residual[i]) <= 1e-9 * Impact::energy());
            still_deformed += flag[i] == 1 && force[i] == 0;
        }
        CHECK(still_deformed > 5);
    }
}

// The largest of c x' + k x over the closed form; a strong damper pushes most at the first touch.
TEST_CASE(the_peak_is_that_of_the_force_not_of_the_depth) {
    for (const double zeta : {0.05, 0.3, 0.45, 0.8}) {
        const double omega = std::sqrt(1e8 / Impact::mass()), root = std::sqrt(1 - zeta * zeta);
        double peak = 0;
        for (double x = 0; x < M_PI; x += 1e-5) {  // x: damped angle; the force is the mass times the deceleration
            const double decay = Impact::speed * omega * std::exp(-zeta / root * x);
            peak = std::max(peak, decay * (2 * zeta * std::cos(x) + (1 - 2 * zeta * zeta) / root * std::sin(x)));
        }
        const Run run = kelvin_voigt_impact(zeta).run();
        CHECK(std::abs(run.peak_force / (Impact::mass() * peak) - 1) <= 1e-9, zeta << ": " << run.peak_force);
    }
}

// e of y = beta v by halving, from y - ln(1 + y) = -e y - ln(1 - e y).
static double hunt_crossley_restitution(double y) {
    const auto f = [](double x) { return x - std::log1p(x); };
    double low = 0, high = std::min(1.0, (1 - 1e-16) / y);
    for (int i = 0; i < 100; ++i) (f(-0.5 * (low + high) * y) < f(y) ? low : high) = 0.5 * (low + high);
    return low;
}

TEST_CASE(hunt_crossley_returns_the_speed_of_its_implicit_form_and_sinks_as_deep) {
    const double stated[][2] = {{0.05, 0.967738579}, {0.3, 0.832869792}, {1, 0.593624260}, {3, 0.306896798}};
    for (const auto& [y, e] : stated) {
        CHECK(std::abs(hunt_crossley_restitution(y) - e) <= 1e-9);
        for (const double p : {1.0, 1.5, 2.0, 3.0}) {
            const double beta = y / Impact::speed, k = p == 1 ? 1e8 : p == 1.5 ? 3e11 : p == 2 ? 1e13 : 1e15;
            const double undamped = std::pow((p + 1) * Impact::energy() / k, 1 / (p + 1));
            Params params = Impact::params("hunt_crossley", k).set("wall.contact.exponent", p);
            params.set("wall.contact.dissipation", beta).set("time.stop", 30 * undamped / Impact::speed);
            const Run run = params.set("time.log_every", 1e-3 * undamped / Impact::speed).run();
            CHECK(run.outcome == ARM3R_RUN_OK, run.message);
            CHECK(std::abs(Impact::restitution(run) - e) <= 1e-8, y << ", " << p << ": " << Impact::restitution(run));
            check_balance(run, e);
            double deepest = 0;
            for (const double depth : column(run, "depth")) deepest = std::max(deepest, depth);
            const double energy = Impact::mass() * (y - std::log1p(y)) / (beta * beta);
            CHECK(std::abs(deepest / std::pow((p + 1) * energy / k, 1 / (p + 1)) - 1) <= 1e-5);
        }
    }
}

TEST_CASE(an_undamped_law_returns_all) {
    const Run run =
        Impact::params("hunt_crossley", 3e11).set("wall.contact.dissipation", 0).set("time.stop", 1e-3).run();
    CHECK(run.events.size() == 2u);
    CHECK(std::abs(Impact::restitution(run) - 1) <= 1e-8);
}

// ---- restitution asked for

TEST_CASE(the_damping_that_a_restitution_asks_for_gives_it) {
    for (const double e : {1e-3, 0.1, 0.135335283236613, 0.1354, 0.45, 0.9, 0.999, 1.0}) {
        const double zeta = damping_ratio_for(e), y = hunt_crossley_number_for(e);
        CHECK(std::abs(std::exp(-2 * zeta * kelvin_voigt_angle(zeta)) - e) <= 1e-13, e << ": " << zeta);
        if (e < 1 && y < 1e3) CHECK(std::abs(hunt_crossley_restitution(y) - e) <= 1e-9, e << ": " << y);
    }
    CHECK(std::abs(damping_ratio_for(0.744079398) - 0.1) <= 1e-9);
    CHECK(std::abs(damping_ratio_for(0.450975453) - 0.3) <= 1e-9);
    CHECK(std::abs(hunt_crossley_number_for(0.832869792) - 0.3) <= 1e-9);
    CHECK(std::abs(hunt_crossley_number_for(0.306896798) - 3) <= 1e-7);
    CHECK(damping_ratio_for(1) == 0);
    CHECK(hunt_crossley_number_for(1) == 0);
    CHECK(std::abs(hunt_crossley_number_for(1 - 1e-6) / 1.5e-6 - 1) <= 1e-5);
}

TEST_CASE(a_scenario_may_ask_for_a_restitution) {
    const Run soft = Impact::params("kelvin_voigt", 1e8).set("wall.contact.restitution", 0.45).run();
    CHECK(std::abs(Impact::restitution(soft) - 0.45) <= 1e-8);
    Params params = Impact::params("hunt_crossley", 3e11).set("wall.contact.restitution", 0.45).set("time.stop", 1e-3);
    const Run hard = params.set("wall.contact.impact_speed", Impact::speed).run();
    CHECK(std::abs(Impact::restitution(hard) - 0.45) <= 1e-8);
}

// ---- the lecture's arm and wall, both ways

static Params lecture_wall() {
    Params params = Params().choose("arm.convention", "slide").set("initial.q", {0, M_PI / 6, -M_PI / 3});
    params.choose("controller.type", "gravity_compensation").set("wall", 1).set("wall.acts_on_arm", 1);
    return params.set("wall.size", {HUGE_VAL, HUGE_VAL}).set("time.log_every", 1e9);
}

TEST_CASE(a_hunt_crossley_bounce_of_the_lectures_arm) {
    Params params = lecture_wall().choose("wall.contact.law", "hunt_crossley").set("wall.contact.stiffness", 1e7);
    const Run run = params.set("wall.contact.dissipation", 6).set("time.stop", 5.37).run();
    REQUIRE(run.events.size() == 2u);
    const Event& left = run.events[1];
    const Vec3<double> q(left.q.data()), qd(left.qd.data());
    const double leaving = -tip_velocity(params.arm(), pose(q), qd)[0] - 0.05;
    CHECK(std::abs(leaving / 0.05 - 0.833439) <= 1e-6);
    CHECK(run.ledger_residual <= 1e-10);
}

TEST_CASE(a_stiff_spring_bounces_as_simulated_elsewhere) {
    const double stated[][6] = {{1e4, 0.0233581243, 3.71968183, -0.100099048, -0.079803695, 0},
                                {1e6, 0.00233720168, 37.1998482, -0.100009940, -0.079926513, 2.76752413e-3}};
    for (const auto& [k, duration, peak, vx, vz, work] : stated) {
        Params params = lecture_wall().set("wall.contact.stiffness", k);
        const Run run = params.set("time.stop", 5.4).run();
        REQUIRE(run.events.size() == 2u);
        const Event& left = run.events[1];
        const Vec3<double> q(left.q.data()), qd(left.qd.data()), v = tip_velocity(params.arm(), pose(q), qd);
        CHECK(std::abs(run.contact_time / duration - 1) <= 1e-6);
        CHECK(std::abs(run.peak_force / peak - 1) <= 1e-6);
        CHECK(std::abs(v[0] / vx - 1) <= 1e-6);
        CHECK(std::abs(v[2] / vz - 1) <= 1e-6);
        if (work > 0) CHECK(std::abs(run.work_of_wall / work - 1) <= 1e-6);
    }
}

// ---- everything at once

// An arm that rests before a wall on which it is thrown again and again, with all that takes energy.
static Params restless(std::string_view law, double stiffness) {
    Params params =
        unequal_params().choose("controller.type", "gravity_compensation").set("arm.armature", {0.02, 0.02, 0.01});
    params.set("arm.damping", {0.2, 0.3, 0.1})
        .set("arm.friction", {0.05, 0.1, 0.02})
        .set("arm.friction_velocity", 0.05);
    params.set("controller.gravity", {0.5, -1, -9}).set("wall", 1).set("wall.acts_on_arm", 1);
    const Setup setup = make_setup(params);
    const Vec3<double> n = Vec3<double>(-0.8, -0.5, 0.3).normalized();
    params.set("wall.normal", n);
    params.set("wall.point",
               Vec3<double>(tip_position(setup.plant.arm, pose(setup.q)) - 0.01 * n + Vec3<double>(0.02, 0, 0.03)));
    params.choose("wall.motion.type", "sinusoid").set("wall.motion.amplitude", 0.12).set("wall.motion.frequency", 1.5);
    params.choose("wall.contact.law", law).set("wall.contact.stiffness", stiffness);
    return params.set("wall.contact.friction.coefficient", 0.3).set("time.stop", 2);
}

static std::vector<Params> restless_ones() {
    std::vector<Params> all = {restless("spring", 3000), restless("kelvin_voigt", 3000).set("wall.contact.damping", 25),
                               restless("hunt_crossley", 2e5).set("wall.contact.dissipation", 2),
                               restless("diagonal", 3000).set("wall.contact.stiffness", {3000, 150, 90})};
    for (Params params : {all[1], all[2]}) {
        params.choose("wall.rotation.type", "sinusoid").set("wall.rotation.axis", {0.3, 1, -0.4});
        params.set("wall.rotation.amplitude", 0.25).set("wall.rotation.frequency", 0.7);
        all.push_back(params);
    }
    Params turned = all[1];
    turned.choose("wall.rotation.type", "constant").set("wall.rotation.axis", {-0.8, -0.5, 0.31});
    all.push_back(turned.set("wall.rotation.rate", 3));
    Params table = all[1];
    table.choose("wall.motion.type", "table").set("wall.motion.t", {0, 0.3, 0.7, 1.2, 1.9});
    table.set("wall.motion.s", {0, 0.1, -0.05, 0.15, 0.1}).set("wall.motion.v", {0.3, 0, 0.5, 0, -0.4});
    all.push_back(table.set("wall.motion.a", {0, 1, 0, -2, 0}));
    Params ramp = all[2];
    ramp.choose("wall.motion.type", "ramp").set("wall.motion.distance", 0.25).set("wall.motion.start", 0.1);
    all.push_back(ramp.set("wall.motion.duration", 0.8));
    return all;
}

TEST_CASE(the_energy_balance_closes_whatever_the_wall_is_and_does) {
    for (const Params& params : restless_ones()) {
        const Run run = params.run();
        CHECK(run.outcome == ARM3R_RUN_OK, run.message);
        CHECK(run.events.size() >= 2u);
        CHECK(run.energy_residual_max <= 2e-8);
        CHECK(std::abs(run.work_of_wall) > 0.05);
        const auto lost = column(run, "energy_dissipated");
        for (std::size_t i = 1; i < run.rows; ++i) CHECK(lost[i] >= lost[i - 1] - 1e-13);
    }
}

TEST_CASE(no_law_but_the_one_that_ties_sideways_ever_pulls) {
    for (const Params& params : restless_ones()) {
        const Run run = Params(params).set("time.log_every", 1e-3).run();
        const Setup setup = make_setup(params);
        const auto t = column(run, "t"), depth = column(run, "depth"), flag = column(run, "contact"),
                   fx = column(run, "f_on_tip_x"), fy = column(run, "f_on_tip_y"), fz = column(run, "f_on_tip_z");
        double peak = 0;
        for (std::size_t i = 0; i < run.rows; ++i) {
            const double pressing =
                normal(setup.plant.wall, wall_at(setup.plant.wall, t[i])).dot(Vec3<double>(fx[i], fy[i], fz[i]));
            CHECK(pressing >= -1e-12);
            CHECK((flag[i] == 1) == (depth[i] > 0));
            if (flag[i] == 0) CHECK(pressing == 0);
            peak = std::max(peak, pressing);
        }
        CHECK(peak <= run.peak_force * (1 + 1e-12));
        CHECK(peak >= run.peak_force * 0.9);
    }
}

TEST_CASE(fixed_steps_come_near_the_adaptive_ones) {
    for (const Params& params : restless_ones()) {
        const Run adaptive = params.run();
        double before = 0;
        for (const double step : {4e-4, 5e-5}) {
            const Run fixed = Params(params).choose("solver.method", "rk4").set("solver.step", step).run();
            REQUIRE(fixed.events.size() == adaptive.events.size());
            double apart = 0;
            for (int i = 0; i < 3; ++i) apart = std::max(apart, std::abs(fixed.q[i] - adaptive.q[i]));
            CHECK(std::abs(fixed.peak_force / adaptive.peak_force - 1) <= 40 * step);
            CHECK(std::abs(fixed.impulse / adaptive.impulse - 1) <= 40 * step);
            CHECK(std::abs(fixed.contact_time / adaptive.contact_time - 1) <= 40 * step);
            CHECK(apart <= 20 * step);
            CHECK(fixed.ledger_residual <= 50 * step);
            if (before > 0) CHECK(apart <= 0.5 * before);
            before = apart;
        }
    }
}

// ---- what only shows one-way, on an arm that is held

static Vec3<double> start_of(const Params& params) {
    const Setup setup = make_setup(params);
    return tip_position(setup.plant.arm, pose(setup.q));
}

static Params held(double depth, const Vec3<double>& normal) {
    Params params =
        unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1).set("wall.normal", normal);
    return params.set("wall.point", Vec3<double>(start_of(params) + depth * normal.normalized()));
}

TEST_CASE(a_plate_that_slides_under_the_tip_drags_it_along) {
    const double mu = 0.4, eps = 0.02, k = 1e4, depth = 0.002;
    for (const char* method : {"dopri5", "rk4", "taylor"}) {
        Params params = held(depth, {-1, 0, 0}).set("wall.contact.stiffness", k).choose("solver.method", method);
        params.set("wall.contact.friction.coefficient", mu).set("wall.contact.friction.slip_velocity", eps);
        params.choose("wall.motion.type", "sinusoid").set("wall.motion.direction", {0, 3, 4});
        params.set("wall.motion.amplitude", 0.05).set("wall.motion.frequency", 0.5).set("time.stop", 2);
        const Run run = params.run();
        const auto t = column(run, "t"), fx = column(run, "f_on_tip_x"), fy = column(run, "f_on_tip_y"),
                   fz = column(run, "f_on_tip_z");
        for (std::size_t i = 0; i < run.rows; ++i) {
            const double v = 0.05 * M_PI * std::cos(M_PI * t[i]), drag = mu * k * depth * v / std::hypot(v, eps);
            CHECK(std::abs(fx[i] + k * depth) <= 1e-9);
            CHECK(std::abs(fy[i] - 0.6 * drag) <= 1e-8);
            CHECK(std::abs(fz[i] - 0.8 * drag) <= 1e-8);
        }
        CHECK(std::abs(run.impulse - k * depth * 2) <= 1e-9);
    }
}

TEST_CASE(a_plate_that_slid_away_and_comes_back_pushes_no_more) {
    for (const char* method : {"dopri5", "rk4"}) {
        Params params = held(0.002, {-1, 0, 0}).set("wall.size", {1, 1}).set("wall.contact.stiffness", 1e4);
        params.choose("wall.motion.type", "table").set("wall.motion.direction", {0, 1, 0});
        params.set("wall.motion.t", {0, 6, 12})
            .set("wall.motion.s", {0, 0.6, 0})
            .set("wall.motion.v", {0.1, 0.1, -0.1});
        params.set("wall.motion.a", {0, 0, 0}).choose("solver.method", method).set("time.stop", 13);
        const Run run = params.run();
        REQUIRE(run.events.size() == 2u);
        CHECK(std::abs(run.events[1].t - 5) <= 1e-9);
        const auto t = column(run, "t"), f = column(run, "f_on_wall_x");
        for (std::size_t i = 0; i < run.rows; ++i)
            if (std::abs(t[i] - 5) > 1e-9) CHECK(std::abs(f[i] - (t[i] < 5 ? 20.0 : 0.0)) <= 1e-9);
    }
}

TEST_CASE(what_a_plate_holds_where_it_slides_away_counts_as_lost) {
    Params params = lecture_wall().set("wall.size", {1, 1}).set("wall.contact.stiffness", 1e4).set("time.stop", 0.01);
    params.set("wall.point", Vec3<double>(start_of(params) + Vec3<double>(-0.002, 0.499, 0)));
    params.set("wall.motion.velocity", {0, 0.5, 0}).choose("wall.motion.type", "constant");
    params.set("arm.armature", {1e9, 1e9, 1e9});  // held
    const Run run = params.run();
    REQUIRE(run.events.size() == 2u);
    CHECK(std::abs(run.events[1].t - 0.002) <= 1e-9);
    CHECK(std::abs(run.dissipated - 0.02) <= 1e-9);
    CHECK(run.energy_residual_max <= 1e-9);
}

// A wall that stands in the plane z = 0 of the tip and nods towards it like a door, about an axis through its origin.
TEST_CASE(a_nodding_plate_meets_the_tip_when_its_angle_says) {
    for (const char* method : {"dopri5", "rk4"}) {
        const double away = 0.4, gap = 0.1, amplitude = 0.5, frequency = 0.3;
        Params params = unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1);
        params.set("wall.point", Vec3<double>(start_of(params) + Vec3<double>(gap, -away, 0)));
        params.choose("wall.motion.type", "fixed")
            .choose("wall.rotation.type", "sinusoid")
            .set("wall.rotation.axis", {0, 0, 2});
        params.set("wall.rotation.amplitude", amplitude).set("wall.rotation.frequency", frequency);
        const Run run = params.choose("solver.method", method).set("time.stop", 3).run();
        // The tip at (-gap, away) from the origin: depth = n . (origin - tip), n = (-cos a, -sin a).
        const double angle = std::atan2(gap, away), turn = std::asin(angle / amplitude) / (2 * M_PI * frequency);
        REQUIRE(run.events.size() == 2u);
        CHECK(std::abs(run.events[0].t - turn) <= 1e-9, run.events[0].t << " is not " << turn);
        CHECK(std::abs(run.events[1].t - (0.5 / frequency - turn)) <= 1e-9);
        const double peak = 1000 * (away * std::sin(amplitude) - gap * std::cos(amplitude));
        CHECK(std::abs(run.peak_force / peak - 1) <= 1e-6);
    }
}

// A turning plate passes like the blade of a fan: no turn is overslept, though nothing moves the arm.
TEST_CASE(no_turn_of_a_plate_is_overslept) {
    Params params = unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1);
    params.set("wall.point", Vec3<double>(start_of(params) + Vec3<double>(0.02, -0.3, 0))).set("wall.size", {1, 0.5});
    params.choose("wall.motion.type", "fixed")
        .choose("wall.rotation.type", "constant")
        .set("wall.rotation.axis", {0, 0, 1});
    const Run run = params.set("wall.rotation.rate", 20).set("time.stop", 10).set("time.log_every", 1).run();
    CHECK(run.contacts == std::floor(10 * 20 / (2 * M_PI) + 1 - std::atan2(0.02, 0.3) / (2 * M_PI)));
}

TEST_CASE(a_ramp_of_a_moment_is_not_overslept) {
    for (const double duration : {1e-3, 1e-6}) {
        Params params =
            held(-0.05, {-0.8, -0.5, 0.3}).choose("wall.motion.type", "ramp").set("wall.motion.distance", 0.1);
        params.set("wall.motion.start", 3.21).set("wall.motion.duration", duration).set("time.stop", 10);
        const Run run = params.run();
        REQUIRE(run.events.size() == 1u);
        CHECK(std::abs(run.events[0].t - (3.21 + 0.5 * duration)) <= 1e-9);
        CHECK(std::abs(run.final_force - 50) <= 1e-9);
    }
    Params params = held(-0.05, {-0.8, -0.5, 0.3}).choose("wall.motion.type", "table");  // there and back in a moment
    params.set("wall.motion.t", {4, 4.001, 4.002}).set("wall.motion.s", {0, 0.1, 0});
    params.set("wall.motion.v", {0, 0, 0}).set("wall.motion.a", {0, 0, 0}).set("time.stop", 10);
    const Run run = params.run();
    REQUIRE(run.events.size() == 2u);
    CHECK(std::abs(run.events[1].t - 4.0015) <= 1e-9);
    CHECK(std::abs(run.peak_force - 50) <= 1e-9);
}

// Both directions, with a damper that depends on a jump of the wall's velocity: a step ends at the jump, and the next
// step uses the new velocity.
TEST_CASE(a_wall_that_starts_and_stops_with_a_jerk_is_followed) {
    Params params = lecture_wall().set("wall.point", {std::sqrt(3) - 1e-3, 0, 0}).set("time.stop", 0.5);
    params.choose("wall.contact.law", "kelvin_voigt")
        .set("wall.contact.stiffness", 2000)
        .set("wall.contact.damping", 30);
    params.choose("controller.type", "gravity_compensation").set("arm.damping", {20, 20, 20});
    params.choose("wall.motion.type", "table").set("wall.motion.t", {0.2, 0.3}).set("wall.motion.s", {0, 0.02});
    params.set("wall.motion.v", {0.2, 0.2}).set("wall.motion.a", {0, 0}).set("time.log_every", 0.01);
    const Run run = params.run();
    CHECK(run.outcome == ARM3R_RUN_OK, run.message);
    CHECK(run.energy_residual_max <= 1e-10);
    CHECK(run.steps.rejected <= 10);
    const auto force = column(run, "f_on_wall_x");
    CHECK(force[20] - force[19] > 5.5);  // the damper: 30 N s/m times 0.2 m/s
    CHECK(force[29] - force[30] > 5.5);
    // The same motion in three runs, each with a smooth wall.
    Params first = Params(params).choose("wall.motion.type", "fixed").set("time.stop", 0.2);
    const Run before = first.run();
    const auto advance = [&](const Run& from, double speed, double start, double stop) {
        Params next = Params(params).choose("wall.motion.type", "constant").set("wall.motion.velocity", speed);
        next.set("initial.q", Vec3<double>(from.q.data())).set("initial.qd", Vec3<double>(from.qd.data()));
        next.set("wall.point", {std::sqrt(3) - 1e-3 - start, 0, 0}).set("time.stop", stop);
        return next.run();
    };
    const Run last = advance(advance(before, 0.2, 0, 0.1), 0, 0.02, 0.2);
    for (int i = 0; i < 3; ++i) {
        CHECK(std::abs(run.q[i] - last.q[i]) <= 1e-10);
        CHECK(std::abs(run.qd[i] - last.qd[i]) <= 1e-9);
    }
}

TEST_CASE(a_start_in_a_wall_that_recedes_faster_than_the_law_follows_has_no_force) {
    Params params = held(0.002, {-1, 0, 0}).choose("wall.contact.law", "kelvin_voigt").set("wall.contact.damping", 30);
    for (const double speed : {-0.1, -0.05, 0.05}) {  // 2 N of the spring, -3 N, -1.5 N, 1.5 N of the damper
        const Run run = params.set("wall.motion.velocity", speed).set("time.stop", 0.01).run();
        REQUIRE(!run.events.empty());
        CHECK(run.events[0].t == 0);
        CHECK(column(run, "contact")[0] == 1);
        CHECK(std::abs(column(run, "f_on_wall_x")[0] - std::max(0.0, 2 + 30 * speed)) <= 1e-12);
        CHECK(std::abs(run.peak_force - std::max(0.0, 2 + 30 * speed + std::max(0.0, 10 * speed))) <= 1e-9);
    }
}

// From a depth of 1e-13 to 1e-10 m the tip moves straight to the surface, where depths are rounding errors: as likely negative
// as positive, they grow by any factor.
TEST_CASE(the_impulse_of_a_contact_that_ends_among_rounding_errors_is_that_of_its_closed_form) {
    const double k = 1e5, p = 1.5;
    Random random(11);
    for (int i = 0; i < 300; ++i) {
        Params params = unequal_params().set("wall", 1).choose("wall.contact.law", "hunt_crossley");
        params.set("wall.contact.stiffness", k).set("wall.contact.exponent", p).set("wall.contact.dissipation", 0);
        params.set("initial.q", {random.in(-3, 3), random.in(-1, 1), random.in(0.5, 2)}).set("wall.acts_on_arm", 1);
        params.set("wall.normal", random.vector(-1, 1)).set("wall.point", start_of(params));
        params.choose("wall.motion.type", "fixed");
        const Setup setup = make_setup(params);
        const double way = std::pow(10, random.in(-13, -10));
        DenseOutput dense{};
        dense.h = 0.01, dense.order = 1;
        for (int joint = 0; joint < 3; ++joint) {
            const double turned = way * random.in(-1, 1);
            dense.c[0][joint] = setup.q[joint] + turned, dense.c[1][joint] = -turned / dense.h;
        }
        const double deepest = tip_indentation(setup.plant, wall_at(setup.plant.wall, 0.0),
                                               pose(angles(dense.motion(0))), Vec3<double>(0, 0, 0))
                                   .depth;
        const double expected = deepest > 0 ? k * std::pow(deepest, p) * dense.h / (p + 1) : 0;
        const double impulse = ContactSearch(setup.plant).impulse(dense, 0, 1);
        CHECK(std::abs(impulse - expected) <= 1e-2 * expected + k * std::pow(1e-14, p) * dense.h,
              way << ": " << impulse << " for " << expected);
    }
}

// An oscillating wall follows the tip out and in again without losing contact: the force ends and begins again inside.
TEST_CASE(a_wall_may_take_hold_again_without_having_been_left) {
    const double k = 1000, c = 200, depth = 0.01, A = 0.008, w = 2 * M_PI * 1.7;
    Params params = held(depth, {-1, 0, 0}).choose("wall.contact.law", "kelvin_voigt").set("wall.contact.stiffness", k);
    params.set("wall.contact.damping", c).choose("wall.motion.type", "sinusoid").set("wall.motion.amplitude", A);
    const Run run = params.set("wall.motion.frequency", 1.7).set("time.stop", 2).run();
    CHECK(run.events.size() == 1u);
    CHECK(run.contact_time == 2);
    const auto force = [&](double t) {
        return std::max(0.0, k * (depth + A * std::sin(w * t)) + c * A * w * std::cos(w * t));
    };
    double impulse = 0, peak = 0;
    const int n = 2000000;
    for (int i = 0; i < n; ++i) {
        impulse += force(2 * (i + 0.5) / n) * 2 / n;
        peak = std::max(peak, force(2 * (i + 0.5) / n));
    }
    CHECK(std::abs(run.impulse - impulse) <= 1e-9);
    CHECK(std::abs(run.peak_force - peak) <= 1e-9);
    CHECK(std::abs(run.final_force - force(2)) <= 1e-9);
    const auto t = column(run, "t"), f = column(run, "f_on_wall_x");
    int unfelt = 0;
    for (std::size_t i = 0; i < run.rows; ++i) {
        CHECK(std::abs(f[i] - force(t[i])) <= 1e-9);
        unfelt += f[i] == 0;
    }
    CHECK(unfelt > 20);
}

// ---- invariance

static Vec3<double> turned(const Vec3<double>& v, double angle) { return rotation(angle, Vec3<double>::UnitZ()) * v; }

TEST_CASE(arm_and_wall_turned_together_about_the_vertical_do_the_same) {
    const double angle = 37 * M_PI / 180;
    for (const Params& params : restless_ones()) {
        Params straight = Params(params).set("controller.gravity", {9.2, std::nan(""), std::nan("")});
        Params aside = straight;
        const auto vector = [&](const char* path) {
            return Vec3<double>(std::span<const double>(straight).data() + find_key(path)->offset);
        };
        for (const char* path : {"wall.point", "wall.normal", "wall.rotation.axis"})
            aside.set(path, turned(vector(path), angle));
        Vec3<double> q = vector("initial.q");
        q[0] += angle;
        const Run one = straight.run(), other = aside.set("initial.q", q).run();
        for (const char* name : {"q2", "q3", "qd1", "qd2", "qd3", "depth", "energy_contact", "energy_dissipated"})
            CHECK(std::abs(last(one, name) - last(other, name)) <= 1e-8, name);
        CHECK(std::abs(last(other, "q1") - last(one, "q1") - angle) <= 1e-8);
        CHECK(std::abs(one.peak_force / other.peak_force - 1) <= 1e-9);
        CHECK(one.events.size() == other.events.size());
    }
}

TEST_SUITE_END()

}  // namespace arm3r
