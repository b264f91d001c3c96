#pragma once
// What every method of simulation shares: the rows, events and messages of a run, and when it stops.

#include <chrono>

#include "record/contact_tally.hpp"
#include "record/diagnosis.hpp"
#include "record/row_log.hpp"

namespace arm3r {

// The time since it was made; a copy starts at zero.
class Stopwatch {
public:
    Stopwatch() = default;
    Stopwatch(const Stopwatch&) {}
    double seconds() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    const Clock::time_point started_ = Clock::now();
};

// A copy continues by itself: no member refers to another one.
class RunRecorder {
public:
    // Throws Error where the run is too large.
    RunRecorder(const Setup& setup, const RunOptions& options);
    RunRecorder(const RunRecorder&) = default;
    RunRecorder& operator=(const RunRecorder&) = delete;

protected:
    // Sets the contact mode at the start.
    void start_contact(ContactMode mode);
    // Writes the first row. Before the first step the dense output is a straight line.
    void start_rows(const FullState& y, const FullState& f, double energy_at_start);

    // Whether there is a row before t that is not written yet.
    bool is_row_due(double t) { return options_.rows && row_log().is_due(t); }
    // The instant of the next row, s: it is due once a step ends behind it.
    double next_row() const { return options_.rows ? time_of(setup_, run_.rows) : infinite; }
    // Writes all rows before t, from the dense output of the last step; not called for a step that diverges, so that the
    // end of the run does not depend on which columns are written.
    void log_until(double t) {
        if (options_.rows) row_log().log_until(t, row_context(), [this] { return poll(); });
    }

    // Whether the steps are to be searched for the first passage of a singular pose, in the dense output up to theta.
    bool seeks_singular_pose() const { return seeks_singular_pose_ && !run_.singular_passage; }
    void seek_singular_pose(double theta);

    // The state of the sampled controller and of the estimator from now on; a continuous law uses the estimated
    // stiffness.
    void store_controller_state(const ControllerState<double>& controller_state) {
        controller_state_ = controller_state;
        Controller<double>& law = setup_.plant.controller;
        if (asks_estimator(law) && setup_.estimation.on)
            law.gains.assumed_stiffness = controller_state.assumed_stiffness;
    }

    // The torque of a sampled controller that acts from now on.
    void record_torque() { oscillation_.include(run_.t_end, setup_.plant.held_torque); }

    // Records a change of contact in the last step: the rows before it, the event, and its energy.
    void record_contact_change(const ContactChange& change, const FullState& y);

    void end(arm3r_outcome outcome, std::string message);
    bool is_running() const { return run_.outcome == ARM3R_RUN_OK; }
    // Whether the run continues, so many steps after the last time; the clock is read now and then only.
    bool poll(std::int64_t steps = 1);
    void read_clock();

    // Writes the last row, checks the energy balance, and adds messages and warnings.
    Run finish(const FullState& y, double theta, const EnergyTotals& totals);

    Stopwatch stopwatch_;
    Setup setup_;  // a sampled controller changes the torque of its plant
    const RunOptions options_;
    Run run_;  // its t_end is the present time
    ContactMode mode_ = ContactMode::free;
    DenseOutput dense_;                         // the solution within the last step
    ControllerState<double> controller_state_;  // of a sampled controller
    ContinuousInputs inputs_;                   // of a continuous one
    ContactTally contacts_;

private:
    RowLog row_log() { return {setup_, run_}; }
    std::optional<EndValues> end_values(const FullState& y, double theta) const;
    RowContext row_context() const { return row_context(plan_); }
    RowContext row_context(const RowPlan& plan) const {
        return {setup_.plant,
                setup_.convention,
                energy_at_start_,
                mode_,
                dense_,
                setup_.controller(),
                setup_.digital.sampling.on,
                controller_state_,
                inputs_,
                contacts_.lost_at_edges,
                jumps_,
                setup_.clock_rounding(),
                plan};
    }
    void explain(const FullState& y);
    void record(Event::Type type, double t, const FullState& y);
    RowPlan plan_;
    std::vector<double> jumps_;
    bool seeks_singular_pose_ = false;
    TorqueOscillation oscillation_;
    double energy_at_start_ = 0;
    std::int64_t steps_since_reading_ = 0;  // of the clock
    double next_report_ = 0;
};

}  // namespace arm3r
