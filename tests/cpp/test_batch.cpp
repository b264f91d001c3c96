#include <algorithm>

#include "base/error.hpp"
#include "batch/worker.hpp"
#include "batch_runs.hpp"
#include "check.hpp"

namespace arm3r {

// A batch is what its runs are alone, bit for bit: for every width, number of threads and order.
TEST_SUITE(batch)

// An arm of its own in every lane, and a wall in front of it.
static Runs pushed_arms(Random& random, std::string_view method, int count) {
    Runs runs;
    runs.base.choose("solver.method", method).choose("controller.type", "gravity_compensation").set("wall", 1);
    runs.base.set("wall.acts_on_arm", 1).set("wall.point", {1.9, 0.05, 0.1}).set("wall.motion.velocity", 0.3);
    runs.base.set("time.stop", 1).set("time.log_every", 0.1).set("arm.damping", {0.02, 0.03, 0.01});
    const auto vary = [&](const char* name, double low, double high) {
        runs.names.emplace_back(name);
        runs.values.push_back(spread(random, low, high, count));
    };
    vary("initial.q[0]", -0.3, 0.3);
    vary("initial.q[1]", -0.7, -0.4);
    vary("initial.q[2]", 0.9, 1.3);
    vary("initial.qd[1]", -0.3, 0.3);
    vary("wall.contact.stiffness", 10, 3000);
    vary("wall.normal[1]", -0.2, 0.2);
    vary("arm.link3.density", 4000, 9000);
    vary("arm.damping[1]", 0.001, 0.05);
    vary("controller.gravity", 9.7, 9.9);
    return runs;
}

TEST_CASE(runs_with_arms_and_walls_of_their_own_have_the_bits_of_the_run_alone) {
    Random random(31);
    for (const char* method : {"rk4", "dopri5", "taylor"}) {
        const Runs runs = pushed_arms(random, method, 45);
        const std::vector<double> table = check_widths_and_threads(runs);
        check_against_single_runs(runs, table);
        double contacts = 0;
        for (std::size_t i = 0; i < runs.count(); ++i) contacts += runs.number(table, "contacts", i);
        CHECK(contacts > 20);
    }
}

TEST_CASE(so_have_random_arms_that_fall_under_any_gravity_beside_an_oscillating_plate) {
    Random random(32);
    for (const char* method : {"rk4", "dopri5", "taylor"}) {
        Runs runs;
        runs.base = unequal_params();
        runs.base.choose("solver.method", method)
            .set("time.stop", 0.7)
            .set("wall", 1)
            .set("wall.point", {1.5, 0.2, 0.1});
        runs.base.set("wall.size", {0.9, 0.8}).choose("wall.motion.type", "sinusoid").set("wall.motion.amplitude", 0.4);
        runs.base.set("wall.motion.frequency", 2).set("wall.acts_on_arm", 1).set("wall.contact.stiffness", 800);
        for (const char* name :
             {"initial.q[0]", "initial.q[1]", "initial.q[2]", "arm.gravity[0]", "wall.motion.phase"}) {
            runs.names.emplace_back(name);
            runs.values.push_back(spread(random, -1, 1, 21));
        }
        runs.names.emplace_back("wall.size[0]");
        runs.values.push_back(spread(random, 0.1, 1, 21));
        check_against_single_runs(runs, check_widths_and_threads(runs));
    }
}

// Against walls of every law that move in every way, each of whose numbers differs from lane to lane.
static Runs against_walls(Random& random, std::string_view law, std::string_view motion, std::string_view rotation) {
    Runs runs = pushed_arms(random, "rk4", 19);
    runs.base.choose("wall.contact.law", law).choose("wall.motion.type", motion).choose("wall.rotation.type", rotation);
    const auto vary = [&](const std::string& name, double low, double high) {
        const auto place = std::size_t(std::find(runs.names.begin(), runs.names.end(), name) - runs.names.begin());
        if (place == runs.names.size()) runs.names.push_back(name), runs.values.emplace_back();
        runs.values[place] = spread(random, low, high, 19);
    };
    if (law == "diagonal") {
        for (const char* item : {"[1]", "[2]"}) vary(std::string("wall.contact.stiffness") + item, 5, 50);
    } else {
        vary("wall.contact.friction.coefficient", 0.1, 0.5), vary("wall.contact.friction.slip_velocity", 0.01, 0.02);
    }
    if (law == "kelvin_voigt") vary("wall.contact.damping", 1, 9);
    if (law == "hunt_crossley") {
        vary("wall.contact.stiffness", 3e3, 3e4);
        vary("wall.contact.exponent", 1, 3), vary("wall.contact.dissipation", 0.1, 3);
    }
    if (motion == "ramp") {
        vary("wall.motion.distance", 0.1, 0.4), vary("wall.motion.start", 0, 0.2);
        vary("wall.motion.duration", 0.3, 0.9), vary("wall.motion.direction[1]", -0.2, 0.2);
        runs.base.set("wall.motion.direction", {-1, 0, 0.1});
    }
    if (motion == "table") {
        for (int i = 0; i < 4; ++i) {
            const std::string item = "[" + std::to_string(i) + "]";
            vary("wall.motion.t" + item, 0.2 * i, 0.2 * i + 0.1), vary("wall.motion.s" + item, 0.1 * i, 0.1 * i + 0.1);
            vary("wall.motion.v" + item, -0.3, 0.5), vary("wall.motion.a" + item, -1, 1);
        }
    }
    if (rotation != "none") runs.base.set("wall.rotation.axis", {0.3, -0.8, 0.5}), vary("wall.rotation.axis[0]", 0, 1);
    if (rotation == "constant") vary("wall.rotation.rate", -0.5, 0.5);
    if (rotation == "sinusoid") {
        vary("wall.rotation.amplitude", -0.5, 0.5), vary("wall.rotation.frequency", 0.3, 2);
        vary("wall.rotation.phase", -1, 1);
    }
    return runs;
}

TEST_CASE(so_have_runs_against_walls_of_every_law_that_move_in_every_way) {
    Random random(36);
    for (const auto& [law, motion, rotation] : {std::array{"spring", "ramp", "none"},
                                                {"spring", "table", "constant"},
                                                {"diagonal", "constant", "none"},
                                                {"diagonal", "ramp", "sinusoid"},
                                                {"kelvin_voigt", "constant", "none"},
                                                {"kelvin_voigt", "table", "none"},
                                                {"kelvin_voigt", "constant", "constant"},
                                                {"hunt_crossley", "constant", "none"},
                                                {"hunt_crossley", "ramp", "sinusoid"},
                                                {"hunt_crossley", "table", "constant"}}) {
        Runs runs = against_walls(random, law, motion, rotation);
        for (const char* method : {"rk4", "dopri5"}) {
            runs.base.choose("solver.method", method);
            const std::vector<double> table = check_widths_and_threads(runs);
            check_against_single_runs(runs, table);
            double contacts = 0, ok = 0;
            for (std::size_t i = 0; i < runs.count(); ++i) {
                contacts += runs.number(table, "contacts", i);
                ok += int(runs.number(table, "outcome", i)) == ARM3R_RUN_OK;
            }
            CHECK(contacts > 5, law << ", " << motion << ", " << rotation);
            CHECK(ok == 19, law << ", " << motion << ", " << rotation);
        }
    }
}

TEST_CASE(a_run_that_fails_ends_with_its_outcome_and_disturbs_no_other) {
    Random random(33);
    for (const char* method : {"rk4", "dopri5", "taylor"}) {
        Runs calm = pushed_arms(random, method, 32);
        calm.names.insert(calm.names.end(), {"initial.qd[0]", "solver.max_steps"});
        calm.values.push_back(std::vector<double>(32, 0.1));
        calm.values.push_back(std::vector<double>(32, 1e6));
        Runs troubled = calm;
        std::vector<double>&angle = troubled.values[0], &rate = troubled.values[9], &most = troubled.values[10];
        troubled.values[4][1] = -1;       // no stiffness
        angle[3] = 99999, rate[3] = 1e3;  // beyond 1e5 rad soon
        most[6] = most[20] = 1;
        const std::vector<double> quiet = check_widths_and_threads(calm), table = check_widths_and_threads(troubled);
        for (std::size_t i = 0; i < 32; ++i) {
            const auto outcome = int(troubled.number(table, "outcome", i));
            if (i == 1) {
                CHECK(outcome == ARM3R_RUN_INVALID);
                CHECK(std::isnan(troubled.number(table, "t_end", i)));
            } else if (i == 3) {
                CHECK(outcome == ARM3R_RUN_DIVERGED);
            } else if (i == 6 || i == 20) {
                CHECK(outcome == ARM3R_RUN_BUDGET);
            } else {
                for (std::size_t c = 0; c < summary_table().size(); ++c)
                    CHECK(same(table[c * 32 + i], quiet[c * 32 + i]));
            }
        }
    }
}

TEST_CASE(a_run_that_fails_in_its_first_step_has_the_numbers_of_its_start) {
    Runs runs;
    runs.base = unequal_params();
    runs.base.choose("solver.method", "taylor").set("arm.friction_velocity", 1e-12);
    runs.names = {"arm.friction[0]", "initial.qd[0]"};
    runs.values = {{1e12, 0.1}, {1e-12, 0}};
    const std::vector<double> table = check_widths_and_threads(runs);
    CHECK(runs.number(table, "outcome", 0) == ARM3R_RUN_STEP_COLLAPSE);
    CHECK(runs.number(table, "q1", 0) == 0.4);
    CHECK(runs.number(table, "t_end", 0) == 0);
}

TEST_CASE(a_damped_arm_comes_to_rest_in_every_lane) {
    for (const char* method : {"rk4", "taylor"}) {
        Runs runs;
        runs.base.choose("solver.method", method).set("solver.step", 0.01).set("time.stop", 250);
        runs.base.set("arm.damping", {3, 3, 3}).set("arm.gravity", {0, 0, 0}).set("time.log_every", 1);
        runs.names = {"initial.qd[0]", "arm.damping[2]"};
        runs.values = {{0.1, 1, 0.2, 0.4, -0.3, 0.5, 0.6, 0.7, 0.8}, {5, 6, 7, 8, 9, 10, 11, 12, 13}};
        const std::vector<double> table = check_widths_and_threads(runs);
        const double rest = std::string_view(method) == "taylor" ? 1e-9 : 0;  // to its tolerance
        for (std::size_t i = 0; i < runs.count(); ++i)
            for (const char* rate : {"qd1", "qd2", "qd3"}) CHECK(std::abs(runs.number(table, rate, i)) <= rest);
    }
}

TEST_CASE(neither_order_nor_the_callers_rounding_of_tiny_numbers_matters) {
    Random random(35);
    for (const char* method : {"rk4", "taylor"}) {
        const Runs runs = pushed_arms(random, method, 40);
        const std::vector<double> table = runs.together({});
        Runs backwards = runs;
        for (std::vector<double>& values : backwards.values) std::reverse(values.begin(), values.end());
        const std::vector<double> reversed = backwards.together({});
        for (std::size_t c = 0; c < summary_table().size(); ++c)
            for (std::size_t i = 0; i < 40; ++i) CHECK(same(table[c * 40 + i], reversed[c * 40 + 39 - i]));
#if defined(__x86_64__)
        constexpr unsigned flush_to_zero = 0x8040;  // and subnormal operands are zero
        const unsigned usual = __builtin_ia32_stmxcsr();
        __builtin_ia32_ldmxcsr(usual | flush_to_zero);
        const std::vector<double> flushed = runs.together({});
        __builtin_ia32_ldmxcsr(usual);
        for (std::size_t i = 0; i < table.size(); ++i) CHECK(same(table[i], flushed[i]));
#endif
    }
}

TEST_CASE(a_run_of_no_length_and_a_batch_of_no_runs_are_fine) {
    Runs runs;
    runs.base.set("time.stop", 0).choose("solver.method", "rk4");
    runs.names = {"initial.q[0]"};
    runs.values = {{0.1, 0.2}};
    check_against_single_runs(runs, check_widths_and_threads(runs));
    runs.values = {{}};
    CHECK(runs.together({}).empty());
}

TEST_CASE(what_cannot_vary_is_refused_by_name) {
    Runs runs;
    runs.values = {{1}};
    for (const char* name : {"solver.method", "wall", "wall.acts_on_arm"}) {
        runs.names = {name};
        CHECK_THROWS(runs.together({}), Error,
                     [&](const Error& e) { return std::string(e.what()).find(name) != std::string::npos; });
    }
    runs.names = {"initial.q[0]", "initial.q[0]"};
    runs.values = {{1}, {1}};
    CHECK_THROWS(runs.together({}), Error);
}

static std::int32_t ask_to_stop(void* user, std::int64_t, std::int64_t) { return *static_cast<std::int32_t*>(user); }

TEST_CASE(a_batch_that_is_stopped_says_so_in_every_row_that_is_not_finished) {
    Random random(34);
    Runs runs = pushed_arms(random, "rk4", 300);
    runs.base.set("time.stop", 1000).set("wall.motion.velocity", 0).set("time.log_every", 100);
    for (std::int32_t answer : {1, -1}) {
        BatchOptions options{.progress = ask_to_stop, .user = &answer, .threads = 2};
        if (answer < 0) {
            CHECK_THROWS(runs.together(options), Error);
            continue;
        }
        const std::vector<double> table = runs.together(options);
        for (std::size_t i = 0; i < runs.count(); ++i) CHECK(runs.number(table, "outcome", i) == ARM3R_RUN_STOPPED);
    }
}

TEST_SUITE_END()

}  // namespace arm3r
