// Runs by the methods that march (march.hpp), with a single lane.

#include "lanes/single_lane_run.hpp"
#include "base/number_text.hpp"
#include "lanes/lane_rk4.hpp"
#include "lanes/lane_taylor.hpp"
#include "record/end_messages.hpp"
#include "run/run_recorder.hpp"

namespace arm3r {
namespace {

template <std::size_t N>
void solve_within(FixedMarch<double, N>& march, Inside& inside) {
    inside.take(hermite(march.t0(0), march.h(0), march.y0(0), march.f0(0), march.y(0), march.f1()));
}

void solve_within(const TaylorMarch<double>& march, Inside& inside) { inside = march.solution(0); }

template <std::size_t N>
double place(const FixedMarch<double, N>&) {
    return 1;
}
double place(const TaylorMarch<double>& march) { return march.theta(0); }

FullState straight_on(const FullState& y) { return {y[3], y[4], y[5]}; }

template <class Marching>
class MarchingRun : Recorder {
public:
    MarchingRun(const Setup& setup, const RunOptions& options) : Recorder(setup, options), march_(setup_) {}

    Run run() {
        march_.use(options_.user_law);
        march_.put(0, setup_);
        march_.begin();
        tell_rows();
        begin(march_.y(0), straight_on(march_.y(0)), march_.mode(0), march_.energy_at_start(0));
        while (is_going_on() && !march_.has_ended(0))
            if (poll()) step();
        know_solution();
        return finish(march_.y(0), theta_, note_end());
    }

private:
    void step() {
        is_known_ = false;
        march_.step([&](int, const Change& change) {
            know_solution();
            note_change(change, inside_(change.theta));
        });
        theta_ = place(march_);
        run_.t_end = march_.t(0);
        run_.steps = march_.steps(0);
        const double until = march_.turns() ? run_.t_end - setup_.clock_rounding() : run_.t_end;
        if (is_row_due(until)) {
            know_solution();
            log_until(until);
        }
        tell_rows();
    }

    // What holds from the end of the step on: a new torque, a new phase.
    void tell_rows() {
        note_known(march_.known());
        contact_ = march_.contact(0);
        force_phase_ = march_.force_phase(0);
        if (!setup_.digital.sampling.on) return;
        setup_.plant.controller.torque = march_.torque(0);
        note_torque();
    }

    // The solution within the last step; it is asked for only where rows or events lie in the step.
    void know_solution() {
        if (!is_known_) solve_within(march_, inside_);
        is_known_ = true;
    }

    Flows note_end() {
        const arm3r_outcome asked = run_.outcome;
        static_cast<Metrics&>(run_) = march_.metrics(0);
        run_.outcome = asked;
        const arm3r_outcome outcome = march_.outcome(0);
        if (outcome != ARM3R_RUN_OK) end(outcome, reason(outcome));
        return march_.flows(0);
    }

    std::string reason(arm3r_outcome outcome) const {
        const double t = run_.t_end;
        switch (outcome) {
            case ARM3R_RUN_BUDGET: return steps_used_up(t);
            case ARM3R_RUN_EVENT_STORM: return event_storm(t);
            case ARM3R_RUN_CONTROLLER: return march_.complaint();
            case ARM3R_RUN_ILL_CONDITIONED:
                return "the mass matrix is no longer positive definite to rounding" + at_time(t);
            case ARM3R_RUN_STEP_COLLAPSE:
                return "the step fell to " + shortest(march_.h(0)) + " s" + at_time(t) +
                       ": the motion changes faster than the clock resolves";
            default: return divergence(t);
        }
    }

    std::string divergence(double t) const {
        for (int i = 0; i < 3; ++i)
            if (!(std::abs(run_.q[i]) <= sincos_limit))
                return "joint " + std::to_string(i + 1) + " turned beyond 1e5 rad" + at_time(t);
        return "the motion is no longer finite after t = " + shortest(t) + " s";
    }

    Marching march_;
    double theta_ = 0;
    bool is_known_ = true;
};

}  // namespace

Run run_marching(const Setup& setup, const RunOptions& options) {
    if (setup.solver.method == Solver::taylor) return MarchingRun<TaylorMarch<double>>(setup, options).run();
    if (has_memory(setup.plant)) return MarchingRun<FixedMarch<double, full_size>>(setup, options).run();
    return MarchingRun<FixedMarch<double>>(setup, options).run();
}

}  // namespace arm3r
