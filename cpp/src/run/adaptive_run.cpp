// Runs with adaptive steps (5.2), one at a time.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "contact/contact_search.hpp"
#include "control/sampled_controller.hpp"
#include "integrate/step_limits.hpp"
#include "integrate/stepper.hpp"
#include "record/end_messages.hpp"
#include "record/energy_balance.hpp"
#include "record/metrics.hpp"
#include "run/adaptive_run.hpp"
#include "run/interactive_run.hpp"
#include "run/performance.hpp"
#include "run/run_recorder.hpp"
#include "setup/time_instants.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int samples_per_step = 9;

// The initial state.
FullState start_of(const Setup& setup) {
    FullState y{};
    for (int i = 0; i < 3; ++i) {
        y[i] = setup.q[i];
        y[3 + i] = setup.qd[i];
    }
    return y;
}

// The last step, as far as the next one depends on it.
struct LastStep {
    double h, error;
    bool crosses, was_last;
    bool continues;  // the method can continue without a restart, unless the torque is new
    bool at_jump;    // the step ends at a jump of a formula of time
};

// All that changes in a run, except in its recorder and its stepper. A copy continues as the original would.
struct Progress {
    struct RunState {
        FullState y{};
        double h = 0;
        double theta = 0;  // the present instant within the last step
        bool just_rejected = false;
        bool trial_was_finite = true;  // of the last rejected step
        Peak peak{};
        bool is_waiting = true, has_started = false;  // the run waits at a sample; the first sample has been taken
        LastStep last_step{};
    };

    explicit Progress(const Setup& setup) : state_{start_of(setup)} {}

    SampledController<double> sampled_;
    PerformanceSums<double> sums_;
    RunState state_;
    EnergyBalance<double> balance_;
};

// N: state_size, or full_size where a continuous controller remembers something.
template <std::size_t N>
class AdaptiveRun : public InteractiveRun, RunRecorder, Progress {
    using Y = State<double, N>;

public:
    AdaptiveRun(const Setup& setup, const RunOptions& options)
        : RunRecorder(setup, options), Progress(setup_), stepper_(setup_), search_(setup_.plant, samples_per_step) {
        start_contact(search_.mode_at_start(setup_.start, state_.y));
        balance_.start(0, energies(setup_.plant, setup_.start, state_.y, mode_));
        state_.peak = {force_now(), setup_.start};
        sampled_.load_lane(0, setup_.digital, setup_.estimation);
        sampled_.user = options.user_law;
        start_memory();
    }

    AdaptiveRun(const AdaptiveRun& other)
        : RunRecorder(other),
          Progress(other),
          stepper_(setup_, other.stepper_),
          search_(setup_.plant, samples_per_step) {}

    bool is_over() const override { return !state_.is_waiting; }
    void set_user_law(const UserLaw& law) override { sampled_.user = law; }

    void advance() override {
        state_.is_waiting = false;
        if (state_.has_started) finish_step();
        else initialise();
        while (is_running() && run_.t_end < setup_.stop) {
            if (double(run_.steps.accepted + run_.steps.rejected) >= setup_.solver.max_steps)
                end(ARM3R_RUN_BUDGET, step_budget_message(run_.t_end));
            else if (poll() && step()) {
                if (stops_at_sample()) return;
                finish_step();
            }
        }
    }

    void preview(const UserLaw& law) const override {
        SampledController<double> rehearsal = sampled_;
        rehearsal.user = law;
        Vec3<double> held;
        PlantOutput<double> now = plant_output();
        rehearsal.update(true, setup_.clock_rounding(), setup_.plant.arm, now, held);
    }

    std::unique_ptr<InteractiveRun> copy() const override { return std::make_unique<AdaptiveRun>(*this); }

    Run snapshot() const override { return AdaptiveRun(*this).conclude(); }

    Run conclude() override {
        if (!is_over()) end(ARM3R_RUN_STOPPED, "the simulation stands" + at_time(run_.t_end));
        set_end_metrics();
        return finish(state_.y, state_.theta,
                      balance_.totals(0, setup_.plant, run_.peak_force, double(run_.steps.accepted)));
    }

private:
    // The components in use.
    Y moving() const {
        Y y;
        std::copy_n(state_.y.begin(), N, y.begin());
        return y;
    }

    // ---- contact

    WallState<double> wall_now() const { return wall_at(setup_.plant.wall, run_.t_end); }

    Indentation<double> indentation_now() const {
        return tip_indentation(setup_.plant, wall_now(), pose(angles(state_.y)), rates(state_.y));
    }

    double force_now() const {
        return mode_ == ContactMode::contact ? normal_force(setup_.plant.contact, indentation_now()) : 0;
    }

    // Adds the impulse of the last step up to theta = b, in the present contact mode.
    void add_impulse(double b) {
        if (mode_ == ContactMode::contact) run_.impulse += search_.impulse(dense_, 0, b);
    }

    void change_mode(const ContactChange& change) {
        state_.y[work_of_wall] += change.gained;
        state_.y[dissipated] += change.lost;
        if (change.breaks()) contacts_.end_transient(state_.peak);
        record_contact_change(change, state_.y);
        if (contacts_.is_event_storm()) end(ARM3R_RUN_EVENT_STORM, event_storm_message(change.t));
        update_inputs();
    }

    void update_inputs() {
        if (has_memory(setup_.plant)) inputs_.update(setup_.plant.controller, is_touching(mode_), state_.y[law_at]);
    }

    // ---- start

    void initialise() {
        state_.has_started = true;
        update_controller();
        derive();
        state_.h = first_step();
        FullState f{};
        std::copy_n(stepper_.f0().begin(), N, f.begin());
        start_rows(state_.y, f, balance_.energy_at_start(0));
    }

    void start_memory() {
        if constexpr (N == full_size) {
            update_inputs();
            set_inputs(infinite);
            state_.y = stepper_.right_hand_side().with_initial_memory(state_.y, wall_now(), plant_output().measurement);
        }
    }

    // The plant's output for a sampled controller.
    PlantOutput<double> plant_output() const {
        const Plant<double>& plant = setup_.plant;
        const Pose<double> p = pose(angles(state_.y));
        const WallState<double> wall = plant.has_wall ? wall_now() : no_wall<double>();
        Vec3<double> f(0, 0, 0);
        if (mode_ == ContactMode::contact) {
            const Indentation<double> in = tip_indentation(plant, wall, p, rates(state_.y));
            f = only_where(in.depth > 0, contact_force(plant.wall, wall, plant.contact, in, Clamping::clamped)).on_tip;
        }
        return arm3r::plant_output(plant, wall, run_.t_end, moving(), p, f);
    }

    // Updates a sampled controller if it is due. Returns whether its torque may have changed.
    bool update_controller() {
        if (sampled_.next() > run_.t_end + setup_.clock_rounding() || !is_running()) return false;
        PlantOutput<double> now = plant_output();
        sampled_.update(true, setup_.clock_rounding(), setup_.plant.arm, now, setup_.plant.held_torque);
        record_torque();
        store_controller_state(sampled_.controller_state());
        if (sampled_.has_failed()) end(ARM3R_RUN_CONTROLLER, sampled_.error_message());
        if (sampled_.user.function && options_.time_limit > 0) read_clock();
        return true;
    }

    // Whether the run must wait for the controller's torque.
    bool stops_at_sample() {
        return state_.is_waiting = is_running() && sampled_.next_sample() <= run_.t_end + setup_.clock_rounding();
    }

    ContactForceMode force_mode() const {
        return mode_ == ContactMode::contact     ? ContactForceMode::pressed
               : mode_ == ContactMode::separated ? ContactForceMode::released
                                                 : ContactForceMode::none;
    }

    void set_inputs(double latest) { stepper_.set(force_mode(), inputs_.contact, inputs_.force_phase, latest); }

    // The derivative at the present instant, where the next step starts.
    void derive() {
        set_inputs(infinite);
        stepper_.set_start(run_.t_end, moving());
    }

    // ---- steps

    double weighted_norm(const Y& v) const {
        double largest = 0;
        for (std::size_t i = 0; i < N; i = i + 1 == motion_size ? state_size : i + 1)
            largest =
                std::max(largest, std::abs(v[i]) / (setup_.solver.atol + setup_.solver.rtol * std::abs(state_.y[i])));
        return largest;
    }

    double first_step() {  // (5.2)
        const Y y = moving(), &f = stepper_.f0();
        const double size = weighted_norm(y), slope = weighted_norm(f);
        const double trial = size < 1e-5 || slope < 1e-5 ? 1e-6 : 0.01 * size / slope;
        Y euler, f1;
        for (std::size_t i = 0; i < N; ++i) euler[i] = y[i] + trial * f[i];
        stepper_.evaluate(run_.t_end + trial, euler, f1);
        for (std::size_t i = 0; i < N; ++i) f1[i] -= f[i];
        const double bend = weighted_norm(f1) / trial;
        const double steepest = std::max(slope, bend);
        const double by_slope = steepest <= 1e-15 ? std::max(1e-6, 1e-3 * trial) : fifth_root(0.01 / steepest);
        return std::min(100 * trial, by_slope);
    }

    // The time in which the fastest link angle turns by the maximum allowed per step, at its present rate and
    // acceleration. Motions without an error estimate of their own (a spin without gravity, a compensated drift) would
    // otherwise take steps in which the wall passes unnoticed and the work of a turning torque is inaccurate.
    double turning_time() const {
        const double turn = std::min(0.25 * pi, fifth_root(1e5 * setup_.solver.rtol));
        const auto fastest = [](const auto& v) {
            return std::max({std::abs(v[3]), std::abs(v[4]), std::abs(v[4] + v[5])});
        };
        return std::min(turn / fastest(state_.y), std::sqrt(2 * turn / fastest(stepper_.f0())));
    }

    double max_step() const {  // (5.2)
        const Plant<double>& plant = setup_.plant;
        double h = std::min(setup_.solver.max_step, turning_time());
        if (plant.has_wall) h = std::min(h, max_wall_step(plant.wall));
        if (!stepper_.is_stiff() && plant.acts_on_arm && is_touching(mode_)) {
            const Indentation<double> in = indentation_now();
            const double quarter = contact_time(plant, wall_now(), pose(angles(state_.y)), in);
            h = std::min({h, quarter, time_to_break(plant.contact, in, quarter, setup_.solver.rtol)});
        }
        return h;
    }

    // The latest end of the step and the reasons for it.
    struct StepEnd {
        double t;                       // s
        bool is_knot, is_jump, is_due;  // a formula of time changes, or jumps; the controller is due
        double latest;                  // s, where formulas of time are evaluated at the latest (5.8)
    };

    StepEnd step_end() const {
        const double knot = next_knot(setup_, run_.t_end), due = sampled_.next(), rounding = setup_.clock_rounding();
        double t = std::min({knot, due, setup_.stop});
        // No step is as short as the rounding errors of the clock.
        for (double other = knot; other <= t + rounding; other = next_knot(setup_, other)) t = other;
        if (t >= setup_.stop - rounding) t = setup_.stop;
        const bool is_knot = knot <= t, is_jump = next_jump(setup_, run_.t_end) <= t;
        const bool has_sides = is_jump || (is_knot && setup_.plant.wall.motion == Motion::table);
        return {t, is_knot, is_jump, due <= t + rounding, has_sides ? just_before(knot) : infinite};
    }

    // Returns whether a step was accepted; finish_step() completes it.
    bool step() {
        const StepEnd step_end = this->step_end();
        const double rest = step_end.t - run_.t_end, wanted = std::min(state_.h, max_step());
        const bool last = wanted >= rest - setup_.clock_rounding();
        const double h = last ? rest : rest < 2 * wanted ? 0.5 * rest : wanted;  // avoids a very short last step
        if (h < 16 * epsilon * std::max(std::abs(run_.t_end), 1e-3) && !last) {
            collapse(h);
            return false;
        }
        set_inputs(last ? step_end.latest : infinite);
        const Y y = moving();
        const double error = stepper_.attempt(run_.t_end, y, h);
        if (!(error < 1)) return reject(h, error);
        stepper_.interpolate(run_.t_end, y, h, dense_);
        const Peak peak_before = state_.peak;
        const std::optional<Crossing> crossing = search_.next(dense_, 0, mode_, state_.peak);
        const double theta = crossing ? crossing->theta : 1;
        const double t1 = crossing ? run_.t_end + theta * h : last ? step_end.t : run_.t_end + h;
        const bool reached = t1 == step_end.t;
        const bool diverges = crossing ? is_out_of_range(dense_(theta)) : is_out_of_range(stepper_.end());
        const bool waits = reached && (step_end.is_jump || step_end.is_due);  // for what holds from t1 on
        if (!diverges) log_until(waits ? t1 - setup_.clock_rounding() : t1);
        if (!is_running()) return false;
        if (theta_of_transient_end() <= theta) end_transient(peak_before);
        observe_step(theta, t1);
        state_.theta = theta;
        if (crossing) state_.y = state_at_crossing(y, h, theta);
        else std::copy_n(stepper_.end().begin(), N, state_.y.begin());
        const bool came_to_rest = accept(t1);
        if (crossing) change_mode(change_at(setup_.plant, indentation_now(), theta, t1, mode_, crossing->next));
        state_.last_step = {h,
                            error,
                            crossing.has_value(),
                            last,
                            !(crossing || came_to_rest || (reached && step_end.is_knot)),
                            reached && step_end.is_jump};
        return true;
    }

    // What is summed or looked for along the step, from its start to theta, which is the instant t1.
    void observe_step(double theta, double t1) {
        if (seeks_singular_pose()) seek_singular_pose(theta);
        add_impulse(theta);
        if (has_performance_) add_performance(theta, t1);
    }

    // Where in the step the first contact ceases to be transient.
    double theta_of_transient_end() const { return std::max((contacts_.transient_until - dense_.t0) / dense_.h, 0.0); }
    void end_transient(Peak peak) {
        if (mode_ == ContactMode::contact) search_.include_peak(dense_, theta_of_transient_end(), peak);
        contacts_.end_transient(peak);
    }

    // The dense output of RODAS4 has one order less than the end of its step, which is not accurate enough for the
    // works: these come from a second step, which ends at the crossing (5.6).
    FullState state_at_crossing(const Y& start, double h, double theta) {
        FullState y = dense_(theta);
        if (stepper_.is_stiff() && std::isfinite(stepper_.attempt(run_.t_end, start, theta * h)))
            std::copy_n(stepper_.end().begin() + motion_size, quadrature_count, y.begin() + motion_size);
        return y;
    }

    void finish_step() {
        const bool new_torque = update_controller();
        set_inputs(infinite);
        stepper_.accept(run_.t_end, moving(), state_.last_step.h, state_.last_step.continues && !new_torque);
        balance_.update(energies(setup_.plant, run_.t_end, state_.y, mode_), state_.y);
        const double factor = stepper_.factor(state_.last_step.error);
        state_.h = std::max(state_.last_step.h, state_.last_step.was_last ? state_.h : 0.0) *
                   (state_.just_rejected ? std::min(factor, 1.0) : factor);
        state_.just_rejected = false;
        if (state_.last_step.at_jump) state_.h = std::min(state_.h, first_step());
    }

    // Returns that no step was accepted.
    bool reject(double h, double error) {
        run_.steps.rejected += 1;
        state_.just_rejected = true;
        state_.trial_was_finite = std::isfinite(error);
        state_.h = state_.trial_was_finite ? h * std::min(1.0, stepper_.factor(error)) : 0.1 * h;
        return false;
    }

    void collapse(double h) {
        if (state_.trial_was_finite) end(ARM3R_RUN_STEP_COLLAPSE, step_collapse_message(h, run_.t_end));
        else end(ARM3R_RUN_DIVERGED, divergence_message({}, {}, run_.t_end));
    }

    // Returns whether a joint came to rest.
    bool accept(double t1) {
        bool came_to_rest = false;
        for (std::size_t i = 3; i < motion_size; ++i) {
            const double rate = without_tiny_rate(state_.y[i]);
            came_to_rest = came_to_rest || rate != state_.y[i];
            state_.y[i] = rate;
        }
        run_.t_end = t1;
        run_.steps.accepted += 1;
        const Vec3<double> q = angles(state_.y);
        if (is_out_of_range(state_.y))
            end(ARM3R_RUN_DIVERGED, divergence_message(joints_out(setup_, q), joints_out(setup_, rates(state_.y)), t1));
        if (!is_well_conditioned(setup_.plant.arm, pose(q)))
            end(ARM3R_RUN_ILL_CONDITIONED, ill_conditioned_message(t1));
        return came_to_rest;
    }

    // ---- performance

    // The part of the step from its start to theta = b, which is the instant t1.
    void add_performance(double b, double t1) {
        const bool is_sampled = setup_.digital.sampling.on;
        const StepView view{setup_,
                            dense_,
                            mode_ == ContactMode::contact,
                            inputs_.contact,
                            is_sampled ? sampled_.controller_state().force_phase : inputs_.force_phase,
                            is_sampled ? &setup_.plant.held_torque : nullptr,
                            slightly_before(t1)};
        const bool touches = is_touching(mode_),
                   has_constant_samples = is_sampled && !tracked_quantities(setup_).motion();
        const Vec3<double> work = has_constant_samples ? add_whole_segment(trapezoid, touches, view, 0, b, sums_)
                                                       : add_whole_segment(boole, touches, view, 0, b, sums_);
        sums_.work = plus(sums_.work, work);
    }

    void set_end_metrics() {
        run_.steps.evaluations = stepper_.evaluations();
        set_end_values(setup_, run_.t_end, state_.y, is_touching(mode_), contacts_, state_.peak, run_);
        run_.final_force = force_now();
        if (has_performance_) write_performance(sums_, setup_, run_);
        run_.stiff_steps = double(stepper_.stiff_steps());
        run_.choices = stepper_.choices();
        if (is_touching(mode_)) set_estimate(controller_state_, 0, run_);
    }

    Stepper<N> stepper_;
    ContactSearch search_;
    const bool has_performance_ = setup_.has_performance();
};

}  // namespace

std::unique_ptr<InteractiveRun> start_interactive_run(const Setup& setup, const RunOptions& options) {
    if (has_memory(setup.plant)) return std::make_unique<AdaptiveRun<full_size>>(setup, options);
    return std::make_unique<AdaptiveRun<state_size>>(setup, options);
}

Run run_adaptively(const Setup& setup, const RunOptions& options) {
    const std::unique_ptr<InteractiveRun> run = start_interactive_run(setup, options);
    while (!run->is_over()) run->advance();
    return run->conclude();
}

}  // namespace arm3r
