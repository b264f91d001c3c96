#pragma once
// The record of the run in one lane of a lane run: its rows and events, and how it ended.

#include <utility>

#include "lanes/lane_run.hpp"
#include "record/end_messages.hpp"
#include "run/run_recorder.hpp"

namespace arm3r {

template <class Method>
class LaneRecord : public RunRecorder {
public:
    LaneRecord(const Setup& setup, const RunOptions& options, Method& lane_run, int lane)
        : RunRecorder(setup, options), lane_run_(&lane_run), lane_(lane) {}
    // A copy records another lane run, which continues as that of `other`.
    LaneRecord(const LaneRecord& other, Method& lane_run) : LaneRecord(other) { lane_run_ = &lane_run; }

    // Once the lane stands at its start, before its first sample; and before its first step.
    void record_contact_at_start() {
        start_contact(lane_run_->mode(lane_));
        inputs_ = lane_run_->inputs(lane_);
    }
    void record_start() {
        update_row_context();
        const FullState y = lane_run_->y(lane_);
        start_rows(y, {y[3], y[4], y[5]}, lane_run_->energy_at_start(lane_));
    }

    // Before each change of contact.
    void record_change(const ContactChange& change) {
        update_dense_output();
        record_contact_change(change, dense_(change.theta));
    }

    using RunRecorder::is_running;
    using RunRecorder::next_row;
    double t_end() const { return run_.t_end; }
    arm3r_outcome outcome() const { return run_.outcome; }
    void stop(std::string message) { end(ARM3R_RUN_STOPPED, std::move(message)); }

    // Whether there is to be another step.
    bool goes_on() {
        if (!is_running() || lane_run_->has_ended(lane_)) return false;
        const std::int64_t before = std::exchange(steps_at_last_poll_, run_.steps.accepted + run_.steps.rejected);
        return poll(steps_at_last_poll_ - before);
    }
    void forget_dense_output() { had_dense_output_ = std::exchange(has_dense_output_, false); }

    // What the last step leaves in the record; its dense output is computed only if rows or events lie in it.
    void record_step() {
        const std::int64_t accepted_before = run_.steps.accepted;
        run_.steps = lane_run_->steps(lane_);
        if (run_.steps.accepted == accepted_before) {
            has_dense_output_ = had_dense_output_;  // of the step before
            return;
        }
        theta_ = lane_run_->theta(lane_);
        stand_at_end();
        const double until = lane_run_->may_jump_at_end(lane_) ? run_.t_end - setup_.clock_rounding() : run_.t_end;
        if (is_row_due(until) && !is_out_of_range(lane_run_->y(lane_))) {
            update_dense_output();
            log_until(until);
        }
        if (seeks_singular_pose()) {
            update_dense_output();
            seek_singular_pose(theta_);
        }
    }
    void stand_at_end() { run_.t_end = lane_run_->t(lane_); }

    // The values that hold from the end of the step on: a new torque, a new phase.
    void update_row_context() {
        if (setup_.digital.sampling.on || setup_.estimation.on)
            store_controller_state(lane_run_->controller_state(lane_));
        inputs_ = lane_run_->inputs(lane_);
        if (!setup_.digital.sampling.on) return;
        setup_.plant.held_torque = lane_run_->torque(lane_);
        record_torque();
        if (options_.user_law.function && options_.time_limit > 0) read_clock();
    }

    Run record_end() {
        update_dense_output();
        return finish(lane_run_->y(lane_), theta_, set_end_metrics());
    }

private:
    LaneRecord(const LaneRecord&) = default;

    void update_dense_output() {
        if (std::exchange(has_dense_output_, true)) return;
        if constexpr (requires { lane_run_->f1(0); })
            dense_.assign(hermite(lane_run_->t0(lane_), lane_run_->h(lane_), lane_run_->y0(lane_), lane_run_->f0(lane_),
                                  lane_run_->y(lane_), lane_run_->f1(lane_)));
        else lane_run_->fill_dense_output(lane_, dense_);
    }

    EnergyTotals set_end_metrics() {
        const arm3r_outcome asked = run_.outcome;
        static_cast<Metrics&>(run_) = lane_run_->metrics(lane_);
        run_.outcome = asked;
        if constexpr (requires { lane_run_->method().choices(0); }) run_.choices = lane_run_->method().choices(lane_);
        const arm3r_outcome outcome = lane_run_->outcome(lane_);
        if (outcome != ARM3R_RUN_OK) end(outcome, reason(outcome));
        return lane_run_->totals(lane_);
    }

    std::string reason(arm3r_outcome outcome) const {
        const double t = run_.t_end;
        switch (outcome) {
            case ARM3R_RUN_BUDGET: return step_budget_message(t);
            case ARM3R_RUN_EVENT_STORM: return event_storm_message(t);
            case ARM3R_RUN_CONTROLLER: return lane_run_->error_message();
            case ARM3R_RUN_ILL_CONDITIONED: return ill_conditioned_message(t);
            case ARM3R_RUN_STEP_COLLAPSE: return step_collapse_message(lane_run_->h(lane_), t);
            default: return divergence_reason(t);
        }
    }
    std::string divergence_reason(double t) const {
        if constexpr (Method::completes_before_sample)
            if (!is_out_of_range(lane_run_->y(lane_)))
                return divergence_message({}, {}, t);  // no step had a finite end
        return divergence_message(run_.q, run_.qd, t);
    }

    Method* lane_run_;
    const int lane_;
    double theta_ = 0;
    bool has_dense_output_ = true, had_dense_output_ = true;  // whether dense_ is that of the last step, and was before
    std::int64_t steps_at_last_poll_ = -1;
};

}  // namespace arm3r
