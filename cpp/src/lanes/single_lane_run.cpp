// Runs by the methods of lane_run.hpp, with a single lane.

#include "lanes/single_lane_run.hpp"

#include <utility>

#include "lanes/lane_taylor.hpp"
#include "lanes/single_rk4.hpp"
#include "record/end_messages.hpp"
#include "run/run_recorder.hpp"

namespace arm3r {
namespace {

template <std::size_t N>
void fill_dense_output(LaneRk4<double, N>& lane_run, DenseOutput& dense) {
    dense.assign(hermite(lane_run.t0(0), lane_run.h(0), lane_run.y0(0), lane_run.f0(0), lane_run.y(0), lane_run.f1()));
}

void fill_dense_output(const LaneTaylor<double>& lane_run, DenseOutput& dense) { lane_run.fill_dense_output(0, dense); }

template <std::size_t N>
double end_theta(const LaneRk4<double, N>&) {
    return 1;
}
double end_theta(const LaneTaylor<double>& lane_run) { return lane_run.theta(0); }

FullState initial_derivative(const FullState& y) { return {y[3], y[4], y[5]}; }

template <class Integrator>
class SingleLaneRun : RunRecorder {
public:
    SingleLaneRun(const Setup& setup, const RunOptions& options)
        : RunRecorder(setup, options), loaded_(setup_), lane_run_(setup_) {}

    Run run() {
        lane_run_.set_user_law(options_.user_law);
        lane_run_.set_observer([this](int, const ContactChange& change) {
            update_dense_output();
            record_contact_change(change, dense_(change.theta));
        });
        lane_run_.load_lane(0, loaded_);
        lane_run_.start_lanes();
        update_row_context();
        start_contact(lane_run_.mode(0));
        start_rows(lane_run_.y(0), initial_derivative(lane_run_.y(0)), lane_run_.energy_at_start(0));
        std::int64_t accepted = -1;  // steps, at the last poll
        while (is_running() && !lane_run_.has_ended(0)) {
            const std::int64_t before = std::exchange(accepted, run_.steps.accepted);
            if (poll(accepted - before)) step();
        }
        update_dense_output();
        return finish(lane_run_.y(0), theta_, set_end_metrics());
    }

private:
    // Several steps, as far as nothing happens in them; the last one leaves its dense output.
    void step() {
        has_dense_output_ = false;
        advance(lane_run_, next_row());
        theta_ = end_theta(lane_run_);
        run_.t_end = lane_run_.t(0);
        run_.steps = lane_run_.steps(0);
        const double until = lane_run_.may_jump_at_end() ? run_.t_end - setup_.clock_rounding() : run_.t_end;
        if (is_row_due(until) && !is_out_of_range(lane_run_.y(0))) {
            update_dense_output();
            log_until(until);
        }
        if (seeks_singular_pose()) {
            update_dense_output();
            seek_singular_pose(theta_);
        }
        update_row_context();
    }

    // The values that hold from the end of the step on: a new torque, a new phase.
    void update_row_context() {
        if (setup_.digital.sampling.on || setup_.estimation.on) store_controller_state(lane_run_.controller_state());
        inputs_ = lane_run_.inputs(0);
        if (!setup_.digital.sampling.on) return;
        setup_.plant.held_torque = lane_run_.torque(0);
        record_torque();
    }

    // The dense output of the last step; it is computed only if rows or events lie in the step.
    void update_dense_output() {
        if (!has_dense_output_) fill_dense_output(lane_run_, dense_);
        has_dense_output_ = true;
    }

    EnergyTotals set_end_metrics() {
        const arm3r_outcome asked = run_.outcome;
        static_cast<Metrics&>(run_) = lane_run_.metrics(0);
        run_.outcome = asked;
        const arm3r_outcome outcome = lane_run_.outcome(0);
        if (outcome != ARM3R_RUN_OK) end(outcome, reason(outcome));
        return lane_run_.totals(0);
    }

    std::string reason(arm3r_outcome outcome) const {
        const double t = run_.t_end;
        switch (outcome) {
            case ARM3R_RUN_BUDGET: return step_budget_message(t);
            case ARM3R_RUN_EVENT_STORM: return event_storm_message(t);
            case ARM3R_RUN_CONTROLLER: return lane_run_.error_message();
            case ARM3R_RUN_ILL_CONDITIONED: return ill_conditioned_message(t);
            case ARM3R_RUN_STEP_COLLAPSE: return step_collapse_message(lane_run_.h(0), t);
            default: return divergence_message(run_.q, run_.qd, t);
        }
    }

    const Setup loaded_;  // while setup_ follows the torque that is held
    Integrator lane_run_;
    double theta_ = 0;
    bool has_dense_output_ = true;
};

}  // namespace

template void LaneRk4<double, state_size>::step_outlined();
template void LaneRk4<double, full_size>::step_outlined();
template void LaneTaylor<double>::step_outlined();

Run run_in_lane(const Setup& setup, const RunOptions& options) {
    if (setup.solver.method == SolverMethod::taylor) return SingleLaneRun<LaneTaylor<double>>(setup, options).run();
    if (has_memory(setup.plant)) return SingleLaneRun<LaneRk4<double, full_size>>(setup, options).run();
    return SingleLaneRun<SingleRk4>(setup, options).run();
}

}  // namespace arm3r
