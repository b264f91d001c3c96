#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "batch/simulation.hpp"
#include "check.hpp"
#include "control/controller_view.hpp"
#include "fixtures.hpp"
#include "lanes/single_run.hpp"
#include "run/interactive_run.hpp"

namespace arm3r {

TEST_SUITE(user_law)

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
        CHECK(truth.qd[1] == sensed.qd[1]);
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

TEST_CASE(is_asked_at_its_samples_only) {
    for (const char* method : {"dopri5", "rodas4", "auto", "rk4", "taylor"}) {
        Pushing law;
        const Run run = law.run(controlled(method));
        CHECK(run.outcome == ARM3R_RUN_OK, run.message);
        CHECK(run.has_user_law);
        REQUIRE(law.ticks.size() == 101u);
        for (std::size_t i = 0; i < law.ticks.size(); ++i) {
            CHECK(law.ticks[i] == double(i));
            CHECK_CLOSE(law.times[i], double(i) / 500, 1e-15);
        }
    }
}

TEST_CASE(its_failure_ends_the_run_at_that_tick) {
    for (const char* method : {"dopri5", "rk4", "taylor"}) {
        Pushing refuses, breaks;
        refuses.refuse_at = 0, breaks.break_at = 17;
        const Run none = refuses.run(controlled(method)), some = breaks.run(controlled(method));
        CHECK(none.outcome == ARM3R_RUN_CONTROLLER);
        CHECK(some.outcome == ARM3R_RUN_CONTROLLER);
        CHECK(refuses.ticks.size() == 1u);
        CHECK(breaks.ticks.size() == 18u);
        CHECK(none.message == "the controller asked to stop with -3 at tick 0, t = 0 s");
        CHECK(some.message.find("at tick 17, t = 0.034 s") != some.message.npos, some.message);
        CHECK(some.rows >= 1u);
        for (std::size_t i = 0; i < some.columns.size(); ++i)
            for (const double value : some.column(i)) CHECK(std::isfinite(value));
    }
}

TEST_CASE(there_is_no_run_without_it) { CHECK_THROWS(controlled("dopri5").run(), Error); }

TEST_CASE(a_copy_goes_on_as_the_original) {
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
        CHECK(same(one->snapshot(), whole));
    }
    CHECK(same(run->conclude(), whole));
}

TEST_CASE(a_rehearsal_changes_nothing) {
    Pushing law, shown;
    const Params params = controlled("auto");
    const Run whole = law.run(params);
    const std::unique_ptr<InteractiveRun> run = start_interactive_run(valid_setup(params), {});
    run->set_user_law({Pushing::ask, &law});
    while (!run->is_over()) {
        run->preview({Pushing::ask, &shown});
        run->advance();
    }
    CHECK(same(run->conclude(), whole));
    CHECK(shown.ticks.size() == 101u);
}

TEST_SUITE_END()

}  // namespace arm3r
