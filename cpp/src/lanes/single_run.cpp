#include "lanes/single_run.hpp"

#include <utility>

#include "arm3r/numbers/eigen_traits.hpp"
#include "integrate/fixed_steps.hpp"
#include "lanes/lane_events.hpp"
#include "lanes/lane_taylor.hpp"
#include "lanes/single_rk4.hpp"
#include "record/end_messages.hpp"
#include "run/run_recorder.hpp"

namespace arm3r {
namespace {

// Whether a step is complete, with its contact and metrics, before the sample at its end.
template <class Integrator>
constexpr bool completes_before_sample = requires(Integrator run) { run.method(); };

template <class T, std::size_t N>
using ByError = LaneEvents<T, N>;
template <class T, std::size_t N>
using LocatedRk4 = LaneEvents<T, N, FixedSteps<T, N>>;
template <class T, std::size_t N>
using GridRk4 = std::conditional_t<N == state_size, SingleRk4, LaneRk4<T, N>>;

FullState initial_derivative(const FullState& y) { return {y[3], y[4], y[5]}; }

template <class Integrator>
class SingleRun : protected RunRecorder {
public:
    SingleRun(const Setup& setup, const RunOptions& options)
        : RunRecorder(setup, options), loaded_(setup_), lane_run_(setup_) {
        lane_run_.set_user_law(options_.user_law);
        observe_changes();
        lane_run_.load_lane(0, loaded_);
    }

    Run run() {
        lane_run_.start_lanes();
        record_contact_at_start();
        record_start();
        while (goes_on()) {
            forget_dense_output();
            advance(lane_run_, next_row());  // several steps, as far as nothing happens in them
            record_step();
            update_row_context();
        }
        return record_end();
    }

protected:
    // A copy continues as `other` would.
    SingleRun(const SingleRun& other)
        : RunRecorder(other),
          loaded_(other.loaded_),
          lane_run_(loaded_),
          theta_(other.theta_),
          has_dense_output_(other.has_dense_output_),
          steps_at_last_poll_(other.steps_at_last_poll_) {
        lane_run_ = other.lane_run_;
        lane_run_.set_setup(loaded_);
        observe_changes();
    }

    void record_contact_at_start() {
        start_contact(lane_run_.mode(0));
        inputs_ = lane_run_.inputs(0);
    }
    void record_start() {
        update_row_context();
        start_rows(lane_run_.y(0), initial_derivative(lane_run_.y(0)), lane_run_.energy_at_start(0));
    }

    // Whether there is to be another step.
    bool goes_on() {
        if (!is_running() || lane_run_.has_ended(0)) return false;
        const std::int64_t before = std::exchange(steps_at_last_poll_, run_.steps.accepted + run_.steps.rejected);
        return poll(steps_at_last_poll_ - before);
    }

    // What the last step leaves in the records; its dense output is computed only if rows or events lie in it.
    void record_step() {
        const std::int64_t accepted_before = run_.steps.accepted;
        run_.steps = lane_run_.steps(0);
        if (run_.steps.accepted == accepted_before) {
            has_dense_output_ = had_dense_output_;  // of the step before
            return;
        }
        theta_ = lane_run_.theta(0);
        run_.t_end = lane_run_.t(0);
        const double until = lane_run_.may_jump_at_end() ? run_.t_end - setup_.clock_rounding() : run_.t_end;
        if (is_row_due(until) && !is_out_of_range(lane_run_.y(0))) {
            update_dense_output();
            log_until(until);
        }
        if (seeks_singular_pose()) {
            update_dense_output();
            seek_singular_pose(theta_);
        }
    }

    // The values that hold from the end of the step on: a new torque, a new phase.
    void update_row_context() {
        if (setup_.digital.sampling.on || setup_.estimation.on) store_controller_state(lane_run_.controller_state());
        inputs_ = lane_run_.inputs(0);
        if (!setup_.digital.sampling.on) return;
        setup_.plant.held_torque = lane_run_.torque(0);
        record_torque();
        if (options_.user_law.function && options_.time_limit > 0) read_clock();
    }

    Run record_end() {
        update_dense_output();
        return finish(lane_run_.y(0), theta_, set_end_metrics());
    }

    Integrator& lane_run() { return lane_run_; }
    const Integrator& lane_run() const { return lane_run_; }
    void forget_dense_output() { had_dense_output_ = std::exchange(has_dense_output_, false); }

private:
    void observe_changes() {
        lane_run_.set_observer([this](int, const ContactChange& change) {
            update_dense_output();
            record_contact_change(change, dense_(change.theta));
        });
    }

    void update_dense_output() {
        if (std::exchange(has_dense_output_, true)) return;
        if constexpr (requires { lane_run_.f1(); })
            dense_.assign(hermite(lane_run_.t0(0), lane_run_.h(0), lane_run_.y0(0), lane_run_.f0(0), lane_run_.y(0),
                                  lane_run_.f1()));
        else lane_run_.fill_dense_output(0, dense_);
    }

    EnergyTotals set_end_metrics() {
        const arm3r_outcome asked = run_.outcome;
        static_cast<Metrics&>(run_) = lane_run_.metrics(0);
        run_.outcome = asked;
        if constexpr (requires { lane_run_.method().choices(); }) {
            run_.stiff_steps = double(lane_run_.method().stiff_steps());
            run_.choices = lane_run_.method().choices();
        }
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
            default: return divergence_reason(t);
        }
    }
    std::string divergence_reason(double t) const {
        if constexpr (completes_before_sample<Integrator>)
            if (!is_out_of_range(lane_run_.y(0))) return divergence_message({}, {}, t);  // no step had a finite end
        return divergence_message(run_.q, run_.qd, t);
    }

    const Setup loaded_;  // while setup_ follows the torque that is held
    Integrator lane_run_;
    double theta_ = 0;
    bool has_dense_output_ = true, had_dense_output_ = true;  // whether dense_ is that of the last step, and was before
    std::int64_t steps_at_last_poll_ = -1;
};

// It stands where a step has reached a sample.
template <class Integrator>
class StandingRun : public InteractiveRun, SingleRun<Integrator> {
    using Base = SingleRun<Integrator>;

public:
    StandingRun(const Setup& setup, const RunOptions& options) : Base(setup, options) {
        this->lane_run().place_lanes();
        this->record_contact_at_start();
    }
    StandingRun(const StandingRun&) = default;

    bool is_over() const override { return !stands_; }
    void set_user_law(const UserLaw& law) override { this->lane_run().set_user_law(law); }
    void preview(const UserLaw& law) const override { this->lane_run().preview(law); }
    std::unique_ptr<InteractiveRun> copy() const override { return std::make_unique<StandingRun>(*this); }
    Run snapshot() const override { return StandingRun(*this).conclude(); }

    void advance() override {
        stands_ = false;
        has_started_ ? finish_step() : start();
        while (this->goes_on()) {
            this->forget_dense_output();
            const bool has_moved = this->lane_run().take_step_outlined();
            if constexpr (completes_before_sample<Integrator>) this->record_step();
            else this->run_.t_end = this->lane_run().t(0);
            stands_ = has_moved && this->is_running() && !this->lane_run().has_failed() &&
                      this->lane_run().stands_at_sample();
            if (stands_) return;
            if (has_moved) finish_step();
        }
    }

    Run conclude() override {
        if constexpr (!completes_before_sample<Integrator>)
            if (stands_ && has_started_) {
                this->lane_run().skip_sample();
                finish_step();
            }
        if (!is_over()) this->end(ARM3R_RUN_STOPPED, "the simulation stands" + at_time(this->run_.t_end));
        return this->record_end();
    }

private:
    void start() {
        has_started_ = true;
        this->lane_run().start_steps_outlined();
        this->record_start();
    }
    void finish_step() {
        this->lane_run().finish_step_outlined();
        if constexpr (!completes_before_sample<Integrator>) this->record_step();
        this->update_row_context();
    }

    bool stands_ = true, has_started_ = false;
};

}  // namespace

template void LaneRk4<double, state_size>::step_outlined();
template void LaneRk4<double, full_size>::step_outlined();
template bool LaneRk4<double, state_size>::take_step_outlined();
template bool LaneRk4<double, full_size>::take_step_outlined();
template void LaneRk4<double, state_size>::finish_step_outlined();
template void LaneRk4<double, full_size>::finish_step_outlined();
template void LaneTaylor<double>::step_outlined();
template bool LaneTaylor<double>::take_step_outlined();
template void LaneTaylor<double>::finish_step_outlined();

namespace {

// Calls a template with the integrator of the setup's method.
template <class Visit>
auto with_integrator(const Setup& setup, Visit visit) {
    const auto by_memory = [&]<template <class, std::size_t> class Of>() {
        return has_memory(setup.plant) ? visit.template operator()<Of<double, full_size>>()
                                       : visit.template operator()<Of<double, state_size>>();
    };
    if (setup.solver.method == SolverMethod::taylor) return visit.template operator()<LaneTaylor<double>>();
    if (setup.solver.method != SolverMethod::rk4) return by_memory.template operator()<ByError>();
    if (setup.solver.events == StepEvents::located) return by_memory.template operator()<LocatedRk4>();
    return by_memory.template operator()<GridRk4>();
}

}  // namespace

Run run_alone(const Setup& setup, const RunOptions& options) {
    return with_integrator(setup, [&]<class Integrator>() { return SingleRun<Integrator>(setup, options).run(); });
}

std::unique_ptr<InteractiveRun> start_interactive_run(const Setup& setup, const RunOptions& options) {
    return with_integrator(setup, [&]<class Integrator>() -> std::unique_ptr<InteractiveRun> {
        return std::make_unique<StandingRun<Integrator>>(setup, options);
    });
}

}  // namespace arm3r
