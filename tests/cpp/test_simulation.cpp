#include <algorithm>

#include "arm3r/plant.hpp"
#include "base/error.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "record/diagnosis.hpp"
#include "record/energy_balance.hpp"

namespace arm3r {

TEST_SUITE(simulation)

static Params falling() {
    return unequal_params().set("initial.qd", {0.5, -0.4, 0.3}).set("arm.link1.inertia_axial", 0.3).set("time.stop", 1);
}

// An arm that a wall throws about, many times.
static Params juggled() {
    Params params =
        falling().choose("controller.type", "gravity_compensation").set("wall", 1).set("wall.acts_on_arm", 1);
    params.set("wall.normal", {-0.8, -0.5, 0.3})
        .set("wall.point", {1, 0.45, 0.4})
        .choose("wall.motion.type", "sinusoid");
    return params.set("wall.motion.amplitude", 0.3).set("wall.motion.frequency", 1.1).set("time.stop", 3);
}

static const char* const methods[] = {"dopri5", "rk4"};

// ---- rows

static std::vector<double> times(const Params& params) {
    const Run run = params.run();
    const auto t = column(run, "t");
    return {t.begin(), t.end()};
}

TEST_CASE(rows_stand_at_multiples_of_log_every_and_at_the_end) {
    for (const char* method : methods) {
        Params params = falling().choose("solver.method", method);
        const auto rows = [&](double stop, double log_every) {
            return times(params.set("time.stop", stop).set("time.log_every", log_every));
        };
        CHECK(rows(0.3, 0.1) == (std::vector<double>{0, 0.1, 0.2, 0.3}));
        CHECK(rows(0.35, 0.1) == (std::vector<double>{0, 0.1, 0.2, 3 * 0.1, 0.35}));
        CHECK(rows(3 * 0.1, 0.1) == (std::vector<double>{0, 0.1, 0.2, 3 * 0.1}));
        CHECK(rows(0.25, 1) == (std::vector<double>{0, 0.25}));
        CHECK(rows(1, 1e9) == (std::vector<double>{0, 1}));
        CHECK(rows(0, 0.1) == (std::vector<double>{0}));
        CHECK(rows(0.1 + 1e-12, 0.1) == (std::vector<double>{0, 0.1 + 1e-12}));
        CHECK(rows(0.1 + 1e-9, 0.1) == (std::vector<double>{0, 0.1, 0.1 + 1e-9}));
        CHECK(rows(1, 0.001).size() == 1001u);
    }
}

TEST_CASE(the_log_changes_neither_steps_nor_end_nor_events) {
    for (const char* method : methods) {
        const Params params = juggled().choose("solver.method", method);
        const Run usual = params.run();
        CHECK(usual.events.size() >= 2u);
        for (const double log_every : {1e-4, 0.37, 100.0}) {
            const Run other = Params(params).set("time.log_every", log_every).run();
            CHECK(other.steps.accepted == usual.steps.accepted);
            CHECK(other.steps.evaluations == usual.steps.evaluations);
            CHECK(same_bits(other.peak_force, usual.peak_force));
            for (std::size_t i = 0; i < usual.columns.size(); ++i)
                CHECK(same_bits(other.column(i).back(), usual.column(i).back()));
            REQUIRE(other.events.size() == usual.events.size());
            for (std::size_t i = 0; i < usual.events.size(); ++i)
                CHECK(same_bits(other.events[i].t, usual.events[i].t));
        }
    }
}

TEST_CASE(rows_between_steps_lie_on_the_motion) {
    const Run rows = falling().set("time.log_every", 0.01).run();
    for (const double t : {0.13, 0.57, 0.88}) {
        const Run until = falling().set("time.stop", t).set("solver.rtol", 1e-12).set("solver.atol", 1e-14).run();
        for (const char* name : {"q1", "q2", "q3", "qd1", "qd2", "qd3"})
            CHECK(std::abs(column(rows, name)[std::size_t(std::lround(t * 100))] - last(until, name)) <= 1e-7);
    }
}

// Every number of a row, recomputed from t, q and qd of that row.
TEST_CASE(a_row_is_about_one_instant) {
    const Params params = juggled();
    const Setup setup = make_setup(params);
    const Arm<double>& arm = setup.plant.arm;
    const Run run = params.run();
    const auto vector_at = [&](const char* a, const char* b, const char* c, std::size_t i) -> Vec3<double> {
        return {column(run, a)[i], column(run, b)[i], column(run, c)[i]};
    };
    bool touched = false;
    for (std::size_t i = 0; i < run.rows; ++i) {
        const Vec3<double> q = vector_at("q1", "q2", "q3", i), qd = vector_at("qd1", "qd2", "qd3", i);
        const Vec3<double> tau = vector_at("tau1", "tau2", "tau3", i),
                           f = vector_at("f_on_tip_x", "f_on_tip_y", "f_on_tip_z", i);
        const Pose<double> p = pose(q);
        const double depth = setup.plant.wall.n.dot(vector_at("wall_x", "wall_y", "wall_z", i) - tip_position(arm, p));
        const double pressed = column(run, "contact")[i] * depth;
        touched |= pressed > 0;
        CHECK(distance(vector_at("qdd1", "qdd2", "qdd3", i), forward_dynamics(arm, p, qd, tau, f)) <= 1e-9);
        CHECK(distance(tau, gravity_torque(arm, p)) <= 1e-12);
        CHECK(distance(vector_at("tau_g1", "tau_g2", "tau_g3", i), gravity_torque(arm, p)) <= 1e-12);
        CHECK(distance(vector_at("tip_x", "tip_y", "tip_z", i), tip_position(arm, p)) <= 1e-14);
        CHECK(distance(vector_at("tip_vx", "tip_vy", "tip_vz", i), tip_velocity(arm, p, qd)) <= 1e-13);
        CHECK(distance(vector_at("tip_jvx", "tip_jvy", "tip_jvz", i), tip_velocity(arm, p, qd)) <= 1e-13);
        CHECK(distance(vector_at("tip_dvx", "tip_dvy", "tip_dvz", i), tip_velocity(arm, p, qd)) <= 1e-5);
        CHECK(std::abs(column(run, "depth")[i] - depth) <= 1e-14);
        CHECK(distance(f, 1000 * pressed * setup.plant.wall.n) <= 1e-9);
        CHECK(std::abs(column(run, "energy_kinetic")[i] - kinetic_energy(arm, p, qd)) <= 1e-13);
        CHECK(std::abs(column(run, "energy_potential")[i] - potential_energy(arm, p)) <= 1e-13);
        CHECK(std::abs(column(run, "energy_contact")[i] - 500 * pressed * pressed) <= 1e-12);
    }
    CHECK(touched);
}

TEST_CASE(a_wall_that_is_only_measured_accelerates_nothing) {
    const Params params = juggled().set("wall.acts_on_arm", 0).set("arm.gravity", {1, -2, -5});
    const Arm<double> arm = params.arm();
    const Run run = params.run();
    const auto vector_at = [&](const std::string& name, std::size_t i) -> Vec3<double> {
        return {column(run, name + "1")[i], column(run, name + "2")[i], column(run, name + "3")[i]};
    };
    CHECK(run.peak_force > 1);
    for (std::size_t i = 0; i < run.rows; ++i) {
        const Vec3<double> free =
            forward_dynamics(arm, pose(vector_at("q", i)), vector_at("qd", i), vector_at("tau", i), {0, 0, 0});
        CHECK(distance(vector_at("qdd", i), free) <= 1e-12 * (1 + free.norm()));
    }
}

static void check_third_velocity_at_the_end(const Run& run, double sliver) {
    for (const std::string axis : {"x", "y", "z"}) {
        const double off = last(run, "tip_dv" + axis) - last(run, "tip_jv" + axis);
        CHECK(std::abs(off) <= 2e-15 / sliver + 1e-9, "off by " << off << " at t = " << last(run, "t"));
    }
}

// All that is left of it is the rounding of the tip's position.
TEST_CASE(the_third_velocity_bears_a_very_short_last_step) {
    Params fixed = falling().choose("solver.method", "rk4").set("solver.step", 0.01);
    Params adaptive = falling().set("wall", 1).set("wall.normal", {0, 0, 1}).set("wall.point", {0, 0, 0.2});
    adaptive.choose("wall.motion.type", "fixed");
    const std::vector<Event> events = adaptive.run().events;
    REQUIRE(!events.empty());
    for (const double sliver : {1e-6, 1e-8, 1e-9, 1e-10, 2e-11}) {
        check_third_velocity_at_the_end(fixed.set("time.stop", 0.1 + sliver).run(), sliver);
        check_third_velocity_at_the_end(adaptive.set("time.stop", events[0].t + sliver).run(), sliver);
    }
}

TEST_CASE(columns_of_the_wall_are_there_only_with_a_wall) {
    CHECK_THROWS(column(falling().run(), "depth"), std::invalid_argument);
    CHECK_THROWS(column(falling().run(), "wall_x"), std::invalid_argument);
    CHECK(last(falling().run(), "contact") == 0);
    const auto of_any_run = [](const Column& c) { return c.need == Need::nothing || c.need == Need::wall; };
    CHECK(juggled().run().columns.size() == std::size_t(std::ranges::count_if(column_table, of_any_run)));
}

TEST_CASE(the_other_convention_negates_joints_2_and_3_and_nothing_else) {
    Params other = juggled()
                       .choose("arm.convention", "simscape")
                       .set("initial.q", {0.4, -0.7, 0.9})
                       .set("initial.qd", {0.5, 0.4, -0.3});
    const Run slide = juggled().run(), simscape = other.run();
    for (const std::size_t i : slide.columns) {
        const std::string name(column_table[i].name);
        const bool of_joint = (name.starts_with("q") || name.starts_with("tau")) && !name.ends_with("1");
        for (std::size_t row = 0; row < slide.rows; ++row)
            CHECK(column(simscape, name)[row] == (of_joint ? -1 : 1) * column(slide, name)[row]);
    }
    for (std::size_t i = 0; i < slide.events.size(); ++i) {
        CHECK(simscape.events[i].q[1] == -slide.events[i].q[1]);
        CHECK(simscape.events[i].qd[2] == -slide.events[i].qd[2]);
        CHECK(simscape.events[i].tip[2] == slide.events[i].tip[2]);
    }
}

// ---- controllers and limits

TEST_CASE(compensation_by_either_algorithm_holds_the_arm) {
    for (const char* algorithm : {"closed_form", "recursion"}) {
        Params params = unequal_params()
                            .choose("controller.type", "gravity_compensation")
                            .choose("controller.algorithm", algorithm);
        const Run run = params.set("arm.gravity", {2, -3, -9}).set("controller.gravity", {2, -3, -9}).run();
        CHECK(std::abs(last(run, "q1") - 0.4) <= 1e-9);
        CHECK(std::abs(last(run, "q2") - 0.7) <= 1e-9);
        CHECK(std::abs(last(run, "q3") + 0.9) <= 1e-9);
    }
}

TEST_CASE(a_torque_limit_holds_or_lets_fall) {
    Params params = unequal_params().choose("controller.type", "gravity_compensation").set("time.stop", 2);
    const double needed = column(params.run(), "tau2")[0];
    const auto fell = [&](double limit) {
        return std::abs(last(params.set("arm.torque_limit", {HUGE_VAL, limit, HUGE_VAL}).run(), "q2") - 0.7);
    };
    CHECK(fell(needed * 1.001) <= 1e-9);
    CHECK(fell(needed * 0.99) > 0.5);
    CHECK(column(params.run(), "tau2")[0] == needed * 0.99);
}

TEST_CASE(a_constant_torque_is_applied_in_the_arms_convention) {
    Params params = falling().choose("controller.type", "constant").set("controller.torque", {1, 2, 3});
    for (const char* convention : {"slide", "simscape"}) {
        const Run run = params.choose("arm.convention", convention).run();
        for (std::size_t i = 0; i < run.rows; ++i)
            CHECK((column(run, "tau1")[i] == 1 && column(run, "tau2")[i] == 2 && column(run, "tau3")[i] == 3));
    }
}

TEST_CASE(a_limited_torque_works_by_what_is_applied_either_way) {
    for (const char* method : methods) {
        Params params = falling().choose("controller.type", "constant").choose("solver.method", method);
        const Run run = params.set("controller.torque", {-5, 5, -1}).set("arm.torque_limit", {2, 3, 2}).run();
        const auto work = column(run, "work_actuators");
        const double torque[] = {-2, 3, -1};
        std::vector<double> expected(run.rows);
        for (int joint = 0; joint < 3; ++joint) {
            const std::string number = std::to_string(joint + 1);
            const auto tau = column(run, "tau" + number), q = column(run, "q" + number);
            for (std::size_t i = 0; i < run.rows; ++i) {
                CHECK(tau[i] == torque[joint]);
                expected[i] += torque[joint] * (q[i] - q[0]);
            }
        }
        for (std::size_t i = 0; i < run.rows; ++i) CHECK(std::abs(work[i] - expected[i]) <= 1e-8);
        CHECK(std::abs(expected.back()) > 1);
        CHECK(run.energy_residual_max <= 1e-7);
    }
}

// ---- the energy balance

TEST_CASE(friction_takes_what_the_arm_loses) {
    Params params = falling()
                        .set("arm.damping", {0.3, 0.2, 0.1})
                        .set("arm.friction", {0.1, 0.2, 0.05})
                        .set("arm.friction_velocity", 0.01)
                        .set("time.stop", 5);
    const Run run = params.run();
    CHECK(run.outcome == ARM3R_RUN_OK, run.message);
    const auto lost = column(run, "energy_dissipated"), T = column(run, "energy_kinetic"),
               U = column(run, "energy_potential");
    for (std::size_t i = 1; i < run.rows; ++i) {
        CHECK(lost[i] >= lost[i - 1]);
        CHECK(std::abs((T[0] + U[0]) - (T[i] + U[i]) - lost[i]) <= 1e-8);
    }
    CHECK(lost.back() > 1);
}

TEST_CASE(coarse_fixed_steps_only_warn_of_the_energy_they_lose) {
    const Run run = falling().choose("solver.method", "rk4").set("solver.step", 0.02).set("time.stop", 3).run();
    CHECK(run.outcome == ARM3R_RUN_OK);
    REQUIRE(run.warnings.size() == 1u);
    CHECK(run.warnings[0].find("energy balance") != std::string::npos);
    CHECK(falling().choose("solver.method", "rk4").set("solver.step", 1e-4).run().warnings.empty());
}

// Steps of an absolute tolerance leave what they may: the balance is judged by the larger of both, and the advice names it.
TEST_CASE(the_energy_balance_is_judged_by_the_tolerance_that_steps_have) {
    for (const char* method : {"dopri5", "rodas4", "auto"}) {
        const Params loose = falling().choose("solver.method", method).set("solver.atol", 1e-6).set("time.stop", 3);
        const Run run = loose.run();
        CHECK(run.outcome == ARM3R_RUN_OK, method << ": " << run.message);
        CHECK(run.energy_residual_max > 1e-8, method << ": " << run.energy_residual_max);
        CHECK(Params(loose).set("solver.atol", 1e-4).run().outcome == ARM3R_RUN_OK, method);
        const Solver solver = make_setup(loose).solver, tight = make_setup(falling()).solver;
        CHECK(std::string(accuracy_advice(solver)).starts_with("tighten solver.atol"));
        CHECK(std::string(accuracy_advice(tight)).starts_with("tighten solver.rtol"));
    }
}

static double max_residual_of_rows(const Run& run) {
    double largest = 0;
    for (const double residual : column(run, "energy_residual")) largest = std::max(largest, std::abs(residual));
    return largest;
}

TEST_CASE(the_largest_residual_is_that_of_all_rows_and_steps) {
    // dopri5: largest between the steps, so that only rows see it; rk4 with a row at every step
    for (const double log_every : {1e-4, 3e-3, 5e-3, 7e-3, 1e-2, 1.3e-2}) {
        const Run run = falling().set("solver.rtol", 1e-5).set("time.log_every", log_every).run();
        CHECK(run.energy_residual_max == max_residual_of_rows(run));
    }
    const Params fixed = falling().choose("solver.method", "rk4").set("solver.step", 0.02);
    const Run every_step = Params(fixed).set("time.log_every", 0.02).run();
    CHECK(every_step.energy_residual_max == max_residual_of_rows(every_step));
    const Run two_rows = Params(fixed).set("time.log_every", 10).run();
    CHECK(two_rows.rows == 2u);
    CHECK(two_rows.energy_residual_max == every_step.energy_residual_max);
    CHECK(two_rows.energy_residual_max > max_residual_of_rows(two_rows));
}

// The quadratures of an arm with one of them changed: the message appears above 100 rtol times that one, for either
// sign.
static void check_limit(const Params& params, const FullState& later, double throughput) {
    const Setup setup = make_setup(params);
    FullState start{};
    for (int i = 0; i < 3; ++i) start[i] = setup.q[i];
    const auto energies_of = [&](const FullState& y) { return energies(setup.plant, 0, y, ContactMode::free); };
    EnergyBalance<double> balance;
    balance.start(0, energies_of(start));
    balance.update(energies_of(start), start);
    CHECK(balance.totals(0, setup.plant, 0, 0).residual == 0);
    balance.update(energies_of(later), later);
    EnergyTotals totals = balance.totals(0, setup.plant, 0, 0);
    const double limit = 100 * setup.solver.rtol * throughput;
    totals.residual = 0.99 * limit;
    CHECK(!balance_error(setup.solver, totals).has_value(), throughput);
    totals.residual = 1.01 * limit;
    CHECK(balance_error(setup.solver, totals).has_value(), throughput);
}

TEST_CASE(every_flow_of_energy_widens_the_limit_of_the_balance) {
    const Params params = unequal_params();
    const Setup setup = make_setup(params);
    const FullState rest{setup.q[0], setup.q[1], setup.q[2]};
    for (const std::size_t work : {work_of_actuators, work_of_wall, dissipated}) {
        for (const double flow : {-70.0, 70.0}) {
            FullState y = rest;
            y[work] = flow;
            check_limit(params, y, 70);
        }
    }
    FullState moving = rest, lower = rest;
    moving[4] = 3;
    lower[1] -= 2;
    const Energies<double> start = energies(setup.plant, 0, rest, ContactMode::free);
    check_limit(params, moving, energies(setup.plant, 0, moving, ContactMode::free).kinetic);
    check_limit(params, lower, start.potential - energies(setup.plant, 0, lower, ContactMode::free).potential);
}

TEST_CASE(rounding_at_rest_gives_no_warning_and_a_nan_residual_is_the_largest) {
    const Setup setup = make_setup(unequal_params());
    const FullState rest{setup.q[0], setup.q[1], setup.q[2]};
    const Energies<double> at_rest = energies(setup.plant, 0, rest, ContactMode::free);
    EnergyBalance<double> balance;
    balance.start(0, at_rest);
    balance.update(at_rest, rest);
    EnergyTotals totals = balance.totals(0, setup.plant, 0, 0);
    totals.residual = 0.9e-12 * weight_times_reach(setup.plant.arm);
    CHECK(!balance_error(setup.solver, totals).has_value());
    totals.residual *= 1.2;
    CHECK(balance_error(setup.solver, totals).has_value());
    totals.steps = 1e4;
    CHECK(!balance_error(setup.solver, totals).has_value());

    include_residual(totals.residual, -1);
    CHECK(totals.residual == 1);
    include_residual(totals.residual, std::nan(""));
    include_residual(totals.residual, 2);
    CHECK(totals.residual == HUGE_VAL);
    CHECK(balance_error(setup.solver, totals).has_value());
}

TEST_CASE(a_damped_arm_comes_to_rest_without_subnormal_numbers) {
    for (const char* method : methods) {
        Params params = falling()
                            .set("arm.damping", {3, 2, 2})
                            .set("arm.gravity", {0, 0, 0})
                            .set("time.stop", 200)
                            .set("time.log_every", 0.1);
        const Run run =
            params.choose("solver.method", method).set("solver.step", 0.01).set("solver.max_step", 0.01).run();
        CHECK(run.outcome == ARM3R_RUN_OK, run.message);
        for (std::size_t i = 0; i < run.columns.size(); ++i)
            for (const double value : run.column(i))
                CHECK(std::fpclassify(value) != FP_SUBNORMAL,
                      method << ": " << value << " in " << column_table[run.columns[i]].name);
        for (const char* name : {"qd1", "qd2", "qd3"}) CHECK(last(run, name) == 0);
    }
}

// ---- how a run may end

TEST_CASE(a_run_that_fails_in_its_first_step_has_the_row_at_0) {
    const Run run = falling().choose("solver.method", "rk4").set("solver.step", 5).set("time.stop", 100).run();
    CHECK(run.outcome == ARM3R_RUN_DIVERGED);
    REQUIRE(run.rows >= 1u);
    CHECK(column(run, "t")[0] == 0);
    CHECK(column(run, "qdd2")[0] != 0);
}

TEST_CASE(an_angle_beyond_1e5_rad_is_diverged) {
    for (const char* method : methods) {
        const Run run = unequal_params()
                            .choose("solver.method", method)
                            .set("initial.q", {1e5 - 0.5, 0.7, -0.9})
                            .set("initial.qd", {3, 0, 0})
                            .run();
        CHECK(run.outcome == ARM3R_RUN_DIVERGED);
        CHECK(run.message.find("joint 1") != std::string::npos);
        CHECK(run.rows >= 2u);
        CHECK(run.t_end < 1);
    }
}

// A point mass at the end of a link without mass, stretched out: its mass matrix is regular, but not to rounding.
TEST_CASE(an_arm_that_is_singular_to_rounding_is_ill_conditioned) {
    const auto outcome = [](double inertia, double q3) {
        Params params = unequal_params().set("arm.gravity", {0, 0, 0}).set("initial.q", {0, 0.7, q3});
        params.set("arm.link2.length", 1).set("arm.link2.com", 0).set("arm.link2.inertia", {1e-3, 1e-3, 0});
        params.set("arm.link3.length", 1).set("arm.link3.com", 1).set("arm.link3.mass", 1);
        return params.set("arm.link3.inertia", {1e-3, 1e-3, inertia}).set("time.stop", 1).run().outcome;
    };
    CHECK(outcome(4e-15, 0) == ARM3R_RUN_ILL_CONDITIONED);
    CHECK(outcome(4e-15, 1e-6) == ARM3R_RUN_OK);
    CHECK(outcome(1e-13, 0) == ARM3R_RUN_OK);
}

TEST_CASE(steps_that_cannot_bear_the_contact_are_diverged) {
    const Run run =
        juggled().choose("solver.method", "rk4").set("wall.contact.stiffness", 1e15).set("solver.step", 0.01).run();
    CHECK(run.outcome == ARM3R_RUN_DIVERGED);
    CHECK(!run.message.empty());
    for (std::size_t i = 0; i < run.columns.size(); ++i)
        for (const double value : run.column(i)) CHECK(std::isfinite(value));
}

TEST_CASE(friction_harder_than_the_clock_resolves_is_step_collapse) {
    Params params = falling().set("arm.friction", {1e12, 1e12, 1e12}).set("arm.friction_velocity", 1e-12);
    const Run run = params.run();
    CHECK(run.outcome == ARM3R_RUN_STEP_COLLAPSE, run.message);
    CHECK(run.rows == 1u);
}

TEST_CASE(contact_without_end_is_an_event_storm) {
    Params params = unequal_params()
                        .choose("controller.type", "gravity_compensation")
                        .set("wall", 1)
                        .choose("wall.motion.type", "sinusoid");
    const Setup setup = make_setup(params);
    params.set("wall.point", tip_position(setup.plant.arm, pose(setup.q)))
        .set("wall.motion.amplitude", 1e-3)
        .set("wall.motion.frequency", 1000);
    const Run run = params.run();
    CHECK(run.outcome == ARM3R_RUN_EVENT_STORM);
    CHECK(run.events.size() == 4096u);
    CHECK(std::abs(run.t_end - 2.048) <= 2e-3);
    CHECK(last(run, "t") > 2.03);
}

TEST_CASE(the_steps_are_a_budget) {
    const Run run = falling().set("solver.max_steps", 20).run();
    CHECK(run.outcome == ARM3R_RUN_BUDGET);
    CHECK(run.steps.accepted + run.steps.rejected == 20);
    CHECK(run.t_end < 1);
    CHECK(last(run, "t") <= run.t_end);
}

TEST_CASE(the_clock_is_a_budget) {
    const Params params = falling().choose("solver.method", "rk4").set("solver.step", 1e-6).set("time.stop", 9);
    const Run run = params.run({.time_limit = 0.02});
    CHECK(run.outcome == ARM3R_RUN_BUDGET);
    CHECK(run.elapsed_s < 1);
}

static void check_size_cap(const Params& params, const std::string& path) {
    try {
        params.run();
        CHECK(false, "nothing was refused");
    } catch (const Error& error) {
        CHECK(error.status() == ARM3R_E_SIZE_CAP);
        CHECK(error.problems().at(0).path == path);
    }
}

TEST_CASE(a_run_too_large_is_refused_before_it_starts) {
    check_size_cap(falling().set("time.log_every", 1e-9), "time.log_every");
    check_size_cap(falling().set("time.stop", 1e9).set("time.log_every", 1e-12), "time.log_every");
    check_size_cap(falling().choose("solver.method", "rk4").set("solver.step", 1e-8), "solver.step");
    check_size_cap(falling().choose("solver.method", "rk4").set("solver.step", 1e-3).set("solver.max_steps", 500),
                   "solver.step");
}

TEST_CASE(the_stop_flag_ends_a_run_before_its_first_step) {
    const std::int32_t stop = 1;
    const Run run = falling().run({.stop = &stop});
    CHECK(run.outcome == ARM3R_RUN_STOPPED);
    CHECK(run.t_end == 0);
}

struct Reports {
    int count = 0;
    double stop = 0;
    std::int32_t answer;
    static std::int32_t note(void* user, double, double stop, std::int64_t) {
        Reports& self = *static_cast<Reports*>(user);
        self.count += 1;
        self.stop = stop;
        return self.answer;
    }
};

TEST_CASE(the_progress_function_is_called_and_may_end_the_run) {
    Reports on{.answer = 0}, enough{.answer = 1}, failing{.answer = -1};
    CHECK(falling().run({.progress = Reports::note, .user = &on}).outcome == ARM3R_RUN_OK);
    CHECK(juggled().run({.progress = Reports::note, .user = &enough}).outcome == ARM3R_RUN_STOPPED);
    CHECK(enough.count == 1);
    CHECK(enough.stop == 3);
    CHECK_THROWS(juggled().run({.progress = Reports::note, .user = &failing}), Error);
}

// Asked to report from amid the rows of a long step, it raises the stop flag.
TEST_CASE(a_run_stopped_amid_its_rows_has_come_as_far_as_they_have) {
    std::int32_t stop = 0;
    const auto raise = [](void* user, double, double, std::int64_t) -> std::int32_t {
        *static_cast<std::int32_t*>(user) = 1;
        return 0;
    };
    Params params = unequal_params().set("arm.gravity", {0, 0, 0}).set("initial.q", {0, 0, 0});
    params.set("initial.qd", {1e-3, 0, 0}).set("time.stop", 10).set("time.log_every", 1e-4);
    const Run run = params.run({.stop = &stop, .progress = raise, .user = &stop});
    CHECK(run.outcome == ARM3R_RUN_STOPPED);
    CHECK(run.rows >= 2u);
    CHECK(run.rows < 1e5);
    CHECK(run.t_end >= last(run, "t"));
}

TEST_CASE(a_wrong_parameter_is_refused) {
    CHECK_THROWS(falling().set("arm.link2.length", -1).run(), Error);
    CHECK_THROWS(valid_setup(std::vector<double>(3)), Error);
}

// ---- warnings

TEST_CASE(a_link_behind_the_wall_is_named_with_the_time) {
    Params params = unequal_params()
                        .choose("controller.type", "gravity_compensation")
                        .set("wall", 1)
                        .set("wall.normal", {0, 0, -1});
    const Run run = params.set("wall.point", {0, 0, 2}).set("wall.motion.velocity", 0.2).set("time.stop", 7.3).run();
    REQUIRE(run.warnings.size() == 1u);
    CHECK(run.warnings[0] ==
          "a link other than at its tip is behind the wall from t = 5.93 s on; "
          "only the tip feels the wall");
    CHECK(params.set("time.stop", 4).run().warnings.empty());
}

// Elbow in front or behind, tip in contact or beside the plate.
TEST_CASE(only_a_tip_in_contact_may_be_behind_the_wall) {
    const auto warnings = [](const Vec3<double>& normal, const Vec3<double>& off, const Vec3<double>& velocity) {
        Params params = unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1);
        const Setup setup = make_setup(params);
        const Vec3<double> tip = tip_position(setup.plant.arm, pose(setup.q));
        params.set("wall.normal", normal).set("wall.point", Vec3<double>(tip + off)).set("wall.size", {2, 2});
        return params.set("wall.motion.velocity", velocity).set("time.stop", 4).run().warnings;
    };
    const std::string said = "a link other than at its tip is behind the wall from t = ";
    CHECK(warnings({-1, 0, 0}, {-0.05, 0, 0}, {0, 0, 0}).empty());
    const auto elbow = warnings({0, 0, -1}, {0, 0, -0.05}, {0, 0, 0});
    REQUIRE(elbow.size() == 1u);
    CHECK(elbow[0].starts_with(said + "0 s"));
    const auto beside = warnings({-1, 0, 0}, {-0.002, -1.3, 0}, {0, 0.1, 0});
    REQUIRE(beside.size() == 1u);
    CHECK(beside[0].starts_with(said + "3"));
}

// A small shelf between the heights of tip and elbow: link 2 passes it at 0.535 m from the axis, link 3 at 0.93 m.
TEST_CASE(a_link_through_a_plate_is_behind_it_whichever_link_it_is) {
    const auto warnings = [](double radius) {
        Params params = unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1);
        params.set("wall.normal", {0, 0, -1}).choose("wall.motion.type", "fixed").set("wall.size", {0.2, 0.2});
        params.set("wall.point", {radius * std::cos(0.4), radius * std::sin(0.4), 0.75});
        return params.set("time.stop", 1).run().warnings.size();
    };
    CHECK(warnings(0.535) == 1u);
    CHECK(warnings(0.73) == 0u);
    CHECK(warnings(0.93) == 1u);
}

TEST_CASE(slips_are_named_in_the_runs_warnings) {
    CHECK(falling().run().warnings.empty());
    CHECK(falling().set("initial.q", {0.4, -30, 0.2}).run().warnings.size() == 1u);
}

TEST_SUITE_END()

}  // namespace arm3r
