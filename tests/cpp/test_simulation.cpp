#include <boost/test/unit_test.hpp>

#include "arm3r/plant.hpp"
#include "error.hpp"
#include "fixtures.hpp"

namespace arm3r {

BOOST_AUTO_TEST_SUITE(simulation)

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

BOOST_AUTO_TEST_CASE(rows_stand_at_multiples_of_log_every_and_at_the_end) {
    for (const char* method : methods) {
        Params params = falling().choose("solver.method", method);
        const auto rows = [&](double stop, double log_every) {
            return times(params.set("time.stop", stop).set("time.log_every", log_every));
        };
        BOOST_TEST(rows(0.3, 0.1) == (std::vector<double>{0, 0.1, 0.2, 0.3}));
        BOOST_TEST(rows(0.35, 0.1) == (std::vector<double>{0, 0.1, 0.2, 3 * 0.1, 0.35}));
        BOOST_TEST(rows(3 * 0.1, 0.1) == (std::vector<double>{0, 0.1, 0.2, 3 * 0.1}));
        BOOST_TEST(rows(0.25, 1) == (std::vector<double>{0, 0.25}));
        BOOST_TEST(rows(0, 0.1) == (std::vector<double>{0}));
        BOOST_TEST(rows(0.1 + 1e-12, 0.1) == (std::vector<double>{0, 0.1 + 1e-12}));
        BOOST_TEST(rows(0.1 + 1e-9, 0.1) == (std::vector<double>{0, 0.1, 0.1 + 1e-9}));
        BOOST_TEST(rows(1, 0.001).size() == 1001u);
    }
}

BOOST_AUTO_TEST_CASE(the_log_changes_neither_steps_nor_end_nor_events) {
    for (const char* method : methods) {
        const Params params = juggled().choose("solver.method", method);
        const Run usual = params.run();
        BOOST_TEST(usual.events.size() >= 2u);
        for (const double log_every : {1e-4, 0.37, 100.0}) {
            const Run other = Params(params).set("time.log_every", log_every).run();
            BOOST_TEST(other.steps.accepted == usual.steps.accepted);
            BOOST_TEST(other.steps.evaluations == usual.steps.evaluations);
            BOOST_TEST(same_bits(other.peak_force, usual.peak_force));
            for (std::size_t i = 0; i < usual.columns.size(); ++i)
                BOOST_TEST(same_bits(other.column(i).back(), usual.column(i).back()));
            BOOST_REQUIRE_EQUAL(other.events.size(), usual.events.size());
            for (std::size_t i = 0; i < usual.events.size(); ++i)
                BOOST_TEST(same_bits(other.events[i].t, usual.events[i].t));
        }
    }
}

BOOST_AUTO_TEST_CASE(rows_between_steps_lie_on_the_motion) {
    const Run rows = falling().set("time.log_every", 0.01).run();
    for (const double t : {0.13, 0.57, 0.88}) {
        const Run until = falling().set("time.stop", t).set("solver.rtol", 1e-12).set("solver.atol", 1e-14).run();
        for (const char* name : {"q1", "q2", "q3", "qd1", "qd2", "qd3"})
            BOOST_TEST(std::abs(column(rows, name)[std::size_t(std::lround(t * 100))] - last(until, name)) <= 1e-7);
    }
}

// Every number of a row, recomputed from t, q and qd of that row.
BOOST_AUTO_TEST_CASE(a_row_is_about_one_instant) {
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
        BOOST_TEST(distance(vector_at("qdd1", "qdd2", "qdd3", i), forward_dynamics(arm, p, qd, tau, f)) <= 1e-9);
        BOOST_TEST(distance(tau, gravity_torque(arm, p)) <= 1e-12);
        BOOST_TEST(distance(vector_at("tau_g1", "tau_g2", "tau_g3", i), gravity_torque(arm, p)) <= 1e-12);
        BOOST_TEST(distance(vector_at("tip_x", "tip_y", "tip_z", i), tip_position(arm, p)) <= 1e-14);
        BOOST_TEST(distance(vector_at("tip_vx", "tip_vy", "tip_vz", i), tip_velocity(arm, p, qd)) <= 1e-13);
        BOOST_TEST(distance(vector_at("tip_jvx", "tip_jvy", "tip_jvz", i), tip_velocity(arm, p, qd)) <= 1e-13);
        BOOST_TEST(distance(vector_at("tip_dvx", "tip_dvy", "tip_dvz", i), tip_velocity(arm, p, qd)) <= 1e-5);
        BOOST_TEST(std::abs(column(run, "depth")[i] - depth) <= 1e-14);
        BOOST_TEST(distance(f, 1000 * pressed * setup.plant.wall.n) <= 1e-9);
        BOOST_TEST(std::abs(column(run, "energy_kinetic")[i] - kinetic_energy(arm, p, qd)) <= 1e-13);
        BOOST_TEST(std::abs(column(run, "energy_potential")[i] - potential_energy(arm, p)) <= 1e-13);
        BOOST_TEST(std::abs(column(run, "energy_contact")[i] - 500 * pressed * pressed) <= 1e-12);
    }
    BOOST_TEST(touched);
}

BOOST_AUTO_TEST_CASE(columns_of_the_wall_are_there_only_with_a_wall) {
    BOOST_CHECK_THROW(column(falling().run(), "depth"), std::invalid_argument);
    BOOST_CHECK_THROW(column(falling().run(), "wall_x"), std::invalid_argument);
    BOOST_TEST(last(falling().run(), "contact") == 0);
    BOOST_TEST(juggled().run().columns.size() == column_table().size());
}

BOOST_AUTO_TEST_CASE(the_other_convention_negates_joints_2_and_3_and_nothing_else) {
    Params other = juggled()
                       .choose("arm.convention", "simscape")
                       .set("initial.q", {0.4, -0.7, 0.9})
                       .set("initial.qd", {0.5, 0.4, -0.3});
    const Run slide = juggled().run(), simscape = other.run();
    for (const std::size_t i : slide.columns) {
        const std::string name(column_table()[i].name);
        const bool of_joint = (name.starts_with("q") || name.starts_with("tau")) && !name.ends_with("1");
        for (std::size_t row = 0; row < slide.rows; ++row)
            BOOST_TEST(column(simscape, name)[row] == (of_joint ? -1 : 1) * column(slide, name)[row]);
    }
    for (std::size_t i = 0; i < slide.events.size(); ++i) {
        BOOST_TEST(simscape.events[i].q[1] == -slide.events[i].q[1]);
        BOOST_TEST(simscape.events[i].qd[2] == -slide.events[i].qd[2]);
        BOOST_TEST(simscape.events[i].tip[2] == slide.events[i].tip[2]);
    }
}

// ---- controllers and limits

BOOST_AUTO_TEST_CASE(compensation_by_either_algorithm_holds_the_arm) {
    for (const char* algorithm : {"closed_form", "recursion"}) {
        Params params = unequal_params()
                            .choose("controller.type", "gravity_compensation")
                            .choose("controller.algorithm", algorithm);
        const Run run = params.set("arm.gravity", {2, -3, -9}).set("controller.gravity", {2, -3, -9}).run();
        BOOST_TEST(std::abs(last(run, "q1") - 0.4) <= 1e-9);
        BOOST_TEST(std::abs(last(run, "q2") - 0.7) <= 1e-9);
        BOOST_TEST(std::abs(last(run, "q3") + 0.9) <= 1e-9);
    }
}

BOOST_AUTO_TEST_CASE(a_torque_limit_holds_or_lets_fall) {
    Params params = unequal_params().choose("controller.type", "gravity_compensation").set("time.stop", 2);
    const double needed = column(params.run(), "tau2")[0];
    const auto fell = [&](double limit) {
        return std::abs(last(params.set("arm.torque_limit", {HUGE_VAL, limit, HUGE_VAL}).run(), "q2") - 0.7);
    };
    BOOST_TEST(fell(needed * 1.001) <= 1e-9);
    BOOST_TEST(fell(needed * 0.99) > 0.5);
    BOOST_TEST(column(params.run(), "tau2")[0] == needed * 0.99);
}

BOOST_AUTO_TEST_CASE(a_constant_torque_is_applied_in_the_arms_convention) {
    Params params = falling().choose("controller.type", "constant").set("controller.torque", {1, 2, 3});
    for (const char* convention : {"slide", "simscape"}) {
        const Run run = params.choose("arm.convention", convention).run();
        for (std::size_t i = 0; i < run.rows; ++i)
            BOOST_TEST((column(run, "tau1")[i] == 1 && column(run, "tau2")[i] == 2 && column(run, "tau3")[i] == 3));
    }
}

// ---- the books

BOOST_AUTO_TEST_CASE(friction_takes_what_the_arm_loses) {
    Params params = falling()
                        .set("arm.damping", {0.3, 0.2, 0.1})
                        .set("arm.friction", {0.1, 0.2, 0.05})
                        .set("arm.friction_velocity", 0.01)
                        .set("time.stop", 5);
    const Run run = params.run();
    BOOST_TEST(run.outcome == ARM3R_RUN_OK, run.message);
    const auto lost = column(run, "energy_dissipated"), T = column(run, "energy_kinetic"),
               U = column(run, "energy_potential");
    for (std::size_t i = 1; i < run.rows; ++i) {
        BOOST_TEST(lost[i] >= lost[i - 1]);
        BOOST_TEST(std::abs((T[0] + U[0]) - (T[i] + U[i]) - lost[i]) <= 1e-8);
    }
    BOOST_TEST(lost.back() > 1);
}

BOOST_AUTO_TEST_CASE(coarse_fixed_steps_only_warn_of_the_energy_they_lose) {
    const Run run = falling().choose("solver.method", "rk4").set("solver.step", 0.02).set("time.stop", 3).run();
    BOOST_TEST(run.outcome == ARM3R_RUN_OK);
    BOOST_REQUIRE_EQUAL(run.warnings.size(), 1u);
    BOOST_TEST(run.warnings[0].find("energy balance") != std::string::npos);
    BOOST_TEST(falling().choose("solver.method", "rk4").set("solver.step", 1e-4).run().warnings.empty());
}

BOOST_AUTO_TEST_CASE(a_damped_arm_comes_to_rest_without_subnormal_numbers) {
    for (const char* method : methods) {
        Params params = falling()
                            .set("arm.damping", {3, 2, 2})
                            .set("arm.gravity", {0, 0, 0})
                            .set("time.stop", 200)
                            .set("time.log_every", 0.1);
        const Run run =
            params.choose("solver.method", method).set("solver.step", 0.01).set("solver.max_step", 0.01).run();
        BOOST_TEST(run.outcome == ARM3R_RUN_OK, run.message);
        for (std::size_t i = 0; i < run.columns.size(); ++i)
            for (const double value : run.column(i))
                BOOST_TEST(std::fpclassify(value) != FP_SUBNORMAL,
                           method << ": " << value << " in " << column_table()[run.columns[i]].name);
        for (const char* name : {"qd1", "qd2", "qd3"}) BOOST_TEST(last(run, name) == 0);
    }
}

// ---- how a run may end

BOOST_AUTO_TEST_CASE(an_angle_beyond_1e5_rad_is_diverged) {
    for (const char* method : methods) {
        const Run run = unequal_params()
                            .choose("solver.method", method)
                            .set("initial.q", {1e5 - 0.5, 0.7, -0.9})
                            .set("initial.qd", {3, 0, 0})
                            .run();
        BOOST_TEST(run.outcome == ARM3R_RUN_DIVERGED);
        BOOST_TEST(run.message.find("joint 1") != std::string::npos);
        BOOST_TEST(run.rows >= 2u);
        BOOST_TEST(run.t_end < 1);
    }
}

BOOST_AUTO_TEST_CASE(steps_that_cannot_bear_the_contact_are_diverged) {
    const Run run =
        juggled().choose("solver.method", "rk4").set("wall.contact.stiffness", 1e15).set("solver.step", 0.01).run();
    BOOST_TEST(run.outcome == ARM3R_RUN_DIVERGED);
    BOOST_TEST(!run.message.empty());
    for (std::size_t i = 0; i < run.columns.size(); ++i)
        for (const double value : run.column(i)) BOOST_TEST(std::isfinite(value));
}

BOOST_AUTO_TEST_CASE(friction_harder_than_the_clock_resolves_is_step_collapse) {
    Params params = falling().set("arm.friction", {1e12, 1e12, 1e12}).set("arm.friction_velocity", 1e-12);
    const Run run = params.run();
    BOOST_TEST(run.outcome == ARM3R_RUN_STEP_COLLAPSE, run.message);
    BOOST_TEST(run.rows == 1u);
}

BOOST_AUTO_TEST_CASE(contact_without_end_is_an_event_storm) {
    Params params = unequal_params()
                        .choose("controller.type", "gravity_compensation")
                        .set("wall", 1)
                        .choose("wall.motion.type", "sinusoid");
    const Setup setup = make_setup(params);
    params.set("wall.point", tip_position(setup.plant.arm, pose(setup.q)))
        .set("wall.motion.amplitude", 1e-3)
        .set("wall.motion.frequency", 1000);
    const Run run = params.run();
    BOOST_TEST(run.outcome == ARM3R_RUN_EVENT_STORM);
    BOOST_TEST(run.events.size() == 4096u);
    BOOST_TEST(std::abs(run.t_end - 2.048) <= 2e-3);
    BOOST_TEST(last(run, "t") > 2.03);
}

BOOST_AUTO_TEST_CASE(the_steps_are_a_budget) {
    const Run run = falling().set("solver.max_steps", 20).run();
    BOOST_TEST(run.outcome == ARM3R_RUN_BUDGET);
    BOOST_TEST(run.steps.accepted + run.steps.rejected == 20);
    BOOST_TEST(run.t_end < 1);
    BOOST_TEST(last(run, "t") <= run.t_end);
}

BOOST_AUTO_TEST_CASE(the_clock_is_a_budget) {
    const Params params = falling().choose("solver.method", "rk4").set("solver.step", 1e-6).set("time.stop", 9);
    const Run run = simulate(params, {.time_limit = 0.02});
    BOOST_TEST(run.outcome == ARM3R_RUN_BUDGET);
    BOOST_TEST(run.elapsed_s < 1);
}

static void check_size_cap(const Params& params, const std::string& path) {
    try {
        params.run();
        BOOST_ERROR("nothing was refused");
    } catch (const Error& error) {
        BOOST_TEST(error.status() == ARM3R_E_SIZE_CAP);
        BOOST_TEST(error.problems().at(0).path == path);
    }
}

BOOST_AUTO_TEST_CASE(a_run_too_large_is_refused_before_it_starts) {
    check_size_cap(falling().set("time.log_every", 1e-9), "time.log_every");
    check_size_cap(falling().set("time.stop", 1e9).set("time.log_every", 1e-12), "time.log_every");
    check_size_cap(falling().choose("solver.method", "rk4").set("solver.step", 1e-8), "solver.step");
    check_size_cap(falling().choose("solver.method", "rk4").set("solver.step", 1e-3).set("solver.max_steps", 500),
                   "solver.step");
}

BOOST_AUTO_TEST_CASE(the_stop_flag_ends_a_run_before_its_first_step) {
    const std::int32_t stop = 1;
    const Run run = simulate(falling(), {.stop = &stop});
    BOOST_TEST(run.outcome == ARM3R_RUN_STOPPED);
    BOOST_TEST(run.t_end == 0);
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

BOOST_AUTO_TEST_CASE(the_progress_function_is_told_and_may_end_the_run) {
    Reports on{.answer = 0}, enough{.answer = 1}, failing{.answer = -1};
    BOOST_TEST(simulate(falling(), {.progress = Reports::note, .user = &on}).outcome == ARM3R_RUN_OK);
    BOOST_TEST(simulate(juggled(), {.progress = Reports::note, .user = &enough}).outcome == ARM3R_RUN_STOPPED);
    BOOST_TEST(enough.count == 1);
    BOOST_TEST(enough.stop == 3);
    BOOST_CHECK_THROW(simulate(juggled(), {.progress = Reports::note, .user = &failing}), Error);
}

BOOST_AUTO_TEST_CASE(a_wrong_parameter_is_refused) {
    BOOST_CHECK_THROW(falling().set("arm.link2.length", -1).run(), Error);
    BOOST_CHECK_THROW(simulate(std::vector<double>(3), {}), Error);
}

// ---- warnings

BOOST_AUTO_TEST_CASE(a_link_behind_the_wall_is_named_with_the_time) {
    Params params = unequal_params()
                        .choose("controller.type", "gravity_compensation")
                        .set("wall", 1)
                        .set("wall.normal", {0, 0, -1});
    const Run run = params.set("wall.point", {0, 0, 2}).set("wall.motion.velocity", 0.2).set("time.stop", 7.3).run();
    BOOST_REQUIRE_EQUAL(run.warnings.size(), 1u);
    BOOST_TEST(run.warnings[0].find("behind the wall from t = ") != std::string::npos);
    BOOST_TEST(params.set("time.stop", 4).run().warnings.empty());
}

BOOST_AUTO_TEST_CASE(slips_are_named_in_the_runs_warnings) {
    BOOST_TEST(falling().run().warnings.empty());
    BOOST_TEST(falling().set("initial.q", {0.4, -30, 0.2}).run().warnings.size() == 1u);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace arm3r
