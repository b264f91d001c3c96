#pragma once
// What every method of simulation shares: the rows, events and messages of a run, and the questions whether to go on.

#include <chrono>

#include "contact/contact_change.hpp"
#include "record/diagnosis.hpp"
#include "record/row_log.hpp"

namespace arm3r {

inline constexpr double most_events = 4096;

// The time since it was made; a copy starts anew.
class Stopwatch {
public:
    Stopwatch() = default;
    Stopwatch(const Stopwatch&) {}
    double seconds() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begun_ = Clock::now();
};

inline void note_energies(const FullState& y, const Plant<double>& plant, double lost_at_edges, Metrics& metrics) {
    metrics.work_of_actuators = y[work_of_actuators];
    metrics.work_of_wall = y[work_of_wall];
    metrics.dissipated = y[dissipated];
    metrics.dissipated_parts = dissipated_parts(plant, y, lost_at_edges);
}

// A copy goes on by itself: no member refers to another one.
class Recorder {
public:
    // Throws Error where the run is too large.
    Recorder(const Setup& setup, const RunOptions& options);
    Recorder(const Recorder&) = default;
    Recorder& operator=(const Recorder&) = delete;

protected:
    // The first row, and the present mode. Before the first step the solution is a straight line.
    void begin(const FullState& y, const FullState& f, Mode mode, double energy_at_start);

    // Whether there are rows before t still to log.
    bool is_row_due(double t) { return options_.rows && rows().is_due(t); }
    // All rows before t, from the solution within the last step.
    void log_until(double t) {
        if (options_.rows) rows().log_until(t, scene(), [this] { return poll(); });
    }

    // What a digital controller and the estimator know from now on; a continuous law takes the wall for so stiff.
    void note_known(const Known<double>& known) {
        known_ = known;
        Controller<double>& law = setup_.plant.controller;
        if (asks_estimator(law) && known.identifiable > 0) law.gains.assumed_stiffness = known.stiffness;
    }

    // The torque of a digital controller that acts from now on.
    void note_torque() { swings_.note(run_.t_end, setup_.plant.controller.torque); }

    // A change of contact at place theta within the last step: its rows before, the event, and what it cost.
    void note_change(const Change& change, const FullState& y);

    void end(arm3r_outcome outcome, std::string message);
    bool is_going_on() const { return run_.outcome == ARM3R_RUN_OK; }
    // Whether to go on; the clock is read now and then only.
    bool poll();
    void read_clock();

    // The last row, the verdict of the books, and what is left to say.
    Run finish(const FullState& y, double theta, const Flows& flows);

    std::array<double, 3> joints_out(const Vec3<double>& v) const;
    std::string at_time(double t) const;  // " at t = 1.5 s"

    Stopwatch stopwatch_;
    Setup setup_;  // of its plant, a digital controller changes the torque
    const RunOptions options_;
    Run run_;  // its t_end is the present time
    Mode mode_ = Mode::free;
    Inside inside_;                         // the solution within the last step
    Known<double> known_;                   // to a digital controller
    double contact_ = 0, force_phase_ = 0;  // to a continuous one
    double lost_at_edges_ = 0;              // J, by springs that lose the tip across an edge of the plate

private:
    RowLog rows() { return {setup_, run_}; }
    Scene scene() const {
        return {setup_.plant,
                setup_.simscape,
                energy_at_start_,
                mode_,
                inside_,
                setup_.law(),
                setup_.digital.sampling.on,
                known_,
                contact_,
                force_phase_,
                lost_at_edges_};
    }
    void explain(const FullState& y);
    void record(Event::Type type, double t, const FullState& y);
    TorqueSwings swings_;
    double energy_at_start_ = 0;
    unsigned polls_ = 0;
    double next_report_ = 0;
};

}  // namespace arm3r
