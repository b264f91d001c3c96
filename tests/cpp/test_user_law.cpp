#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "batch/simulation.hpp"
#include "control/controller_view.hpp"
#include "fixtures.hpp"
#include "run/adaptive_run.hpp"
#include "run/interactive_run.hpp"

namespace arm3r {

BOOST_AUTO_TEST_SUITE(user_law)

namespace {

Params controlled(const char* method) {
    Params params = unequal_params().choose("controller.type", "user").choose("solver.method", method);
    params.set("initial.q", {0.3, -0.4, 0.9}).set("initial.qd", {0.1, -0.2, 0.3});
    params.set("time.stop", 0.2).set("sampling.rate", 500);
    return params;
}

// A law that turns the arm faster and faster, and stores the instants of its calls.
struct Pushing {
    std::vector<double> times, ticks;
    double refuse_at = -1, break_at = -1;

    static int ask(void* self, double tick, const GroundTruth& truth, const Measurement<double>& sensed,
                   const ControllerState<double>&, Vec3<double>& tau) {
        Pushing& law = *static_cast<Pushing*>(self);
        BOOST_TEST(truth.qd[1] == sensed.qd[1]);
        law.times.push_back(sensed.t);
        law.ticks.push_back(tick);
        tau = {0.1 + sensed.t, -0.3 * sensed.qd[1], tick == law.break_at ? NAN : 0.2};
        return tick == law.refuse_at ? -3 : 0;
    }

    Run run(const Params& params) {
        RunOptions options;
        options.user_law = {ask, this};
        return params.run(options);
    }
};

bool same(const Run& one, const Run& other) {
    if (one.rows != other.rows || one.columns != other.columns) return false;
    for (std::size_t i = 0; i < one.columns.size(); ++i)
        for (std::size_t row = 0; row < one.rows; ++row)
            if (!same_bits(one.column(i)[row], other.column(i)[row])) return false;
    return true;
}

}  // namespace

BOOST_AUTO_TEST_CASE(is_asked_at_its_samples_only) {
    for (const char* method : {"dopri5", "rodas4", "auto", "rk4", "taylor"}) {
        Pushing law;
        const Run run = law.run(controlled(method));
        BOOST_TEST(run.outcome == ARM3R_RUN_OK, run.message);
        BOOST_TEST(run.has_user_law);
        BOOST_REQUIRE(law.ticks.size() == 101u);
        for (std::size_t i = 0; i < law.ticks.size(); ++i) {
            BOOST_TEST(law.ticks[i] == double(i));
            BOOST_TEST(law.times[i] == double(i) / 500, boost::test_tools::tolerance(1e-15));
        }
    }
}

BOOST_AUTO_TEST_CASE(its_failure_ends_the_run_at_that_tick) {
    for (const char* method : {"dopri5", "rk4", "taylor"}) {
        Pushing refuses, breaks;
        refuses.refuse_at = 0, breaks.break_at = 17;
        const Run none = refuses.run(controlled(method)), some = breaks.run(controlled(method));
        BOOST_TEST(none.outcome == ARM3R_RUN_CONTROLLER);
        BOOST_TEST(some.outcome == ARM3R_RUN_CONTROLLER);
        BOOST_TEST(refuses.ticks.size() == 1u);
        BOOST_TEST(breaks.ticks.size() == 18u);
        BOOST_TEST(none.message == "the controller asked to stop with -3 at tick 0, t = 0 s");
        BOOST_TEST(some.message.find("at tick 17, t = 0.034 s") != some.message.npos, some.message);
        BOOST_TEST(some.rows >= 1u);
        for (std::size_t i = 0; i < some.columns.size(); ++i)
            for (const double value : some.column(i)) BOOST_TEST(std::isfinite(value));
    }
}

BOOST_AUTO_TEST_CASE(there_is_no_run_without_it) { BOOST_CHECK_THROW(controlled("dopri5").run(), Error); }

BOOST_AUTO_TEST_CASE(a_copy_goes_on_as_the_original) {
    Pushing law, again;
    const Params params = controlled("dopri5");
    const Run whole = law.run(params);
    const std::unique_ptr<InteractiveRun> run = start_interactive_run(valid_setup(params), {});
    run->set_user_law({Pushing::ask, &again});
    for (int i = 0; i < 30; ++i) run->advance();
    const std::unique_ptr<InteractiveRun> copy = run->copy();
    for (InteractiveRun* one : {copy.get(), run.get()}) {
        one->set_user_law({Pushing::ask, &again});
        while (!one->is_over()) one->advance();
        BOOST_TEST(same(one->snapshot(), whole));
    }
    BOOST_TEST(same(run->conclude(), whole));
}

BOOST_AUTO_TEST_CASE(a_rehearsal_changes_nothing) {
    Pushing law, shown;
    const Params params = controlled("auto");
    const Run whole = law.run(params);
    const std::unique_ptr<InteractiveRun> run = start_interactive_run(valid_setup(params), {});
    run->set_user_law({Pushing::ask, &law});
    while (!run->is_over()) {
        run->preview({Pushing::ask, &shown});
        run->advance();
    }
    BOOST_TEST(same(run->conclude(), whole));
    BOOST_TEST(shown.ticks.size() == 101u);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace arm3r
