// Runs by adaptive steps (5.2), one at a time.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/number_text.hpp"
#include "contact/contact_search.hpp"
#include "control/sampled_controller.hpp"
#include "integrate/step_limits.hpp"
#include "integrate/stepper.hpp"
#include "record/end_messages.hpp"
#include "record/energy_balance.hpp"
#include "run/adaptive_run.hpp"
#include "run/interactive_run.hpp"
#include "run/performance.hpp"
#include "run/run_recorder.hpp"
#include "setup/time_instants.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int looks_per_step = 9;

// The state at the start.
FullState start_of(const Setup& setup) {
    FullState y{};
    for (int i = 0; i < 3; ++i) {
        y[i] = setup.q[i];
        y[3 + i] = setup.qd[i];
    }
    return y;
}

// A step that was taken, as far as the next one depends on it.
struct Taken {
    double h, error;
    bool crosses, was_last;
    bool goes_on;  // but for a new torque
    bool at_jump;  // of a formula of time alone
};

// All that changes in the course of a run, beside what its recorder and its stepper keep: a copy goes on by itself.
struct Progress {
    struct Present {
        FullState y{};
        double h = 0;
        double theta = 0;  // where the present instant lies in the last step
        bool just_rejected = false;
        bool trial_was_finite = true;  // the last one that was rejected
        double touching_since = 0, events = 0;
        Peak peak{};
        bool waits = true, has_set_off = false;  // at a sample not yet attended; the first one is behind
        Taken taken{};
    };

    explicit Progress(const Setup& setup) : now_{start_of(setup)} {}

    ControlLoop<double> loop_;
    Tally<double> tally_;
    Present now_;
    Ledger ledger_;
};

// N: state_size, or full_size where a continuous controller remembers something.
template <std::size_t N>
class AdaptiveRun : public Stepwise, Recorder, Progress {
    using Y = State<double, N>;

public:
    AdaptiveRun(const Setup& setup, const RunOptions& options)
        : Recorder(setup, options), Progress(setup_), stepper_(setup_), watch_(setup_.plant, looks_per_step) {
        mode_ = watch_.mode_at_start(setup_.start, now_.y);
        ledger_ = Ledger(setup_.plant, setup_.start, now_.y, mode_);
        loop_.put(0, setup_.digital, setup_.estimation);
        loop_.user = options.user_law;
        start();
    }

    AdaptiveRun(const AdaptiveRun& other)
        : Recorder(other), Progress(other), stepper_(setup_, other.stepper_), watch_(setup_.plant, looks_per_step) {}

    bool is_over() const override { return !now_.waits; }
    void use(const UserLaw& law) override { loop_.user = law; }

    void go_on() override {
        now_.waits = false;
        if (now_.has_set_off) settle();
        else set_off();
        while (is_going_on() && run_.t_end < setup_.stop) {
            if (double(run_.steps.accepted + run_.steps.rejected) >= setup_.solver.max_steps)
                end(ARM3R_RUN_BUDGET, steps_used_up(run_.t_end));
            else if (poll() && step()) {
                if (stand_at_sample()) return;
                settle();
            }
        }
    }

    void show(const UserLaw& law) const override {
        ControlLoop<double> rehearsal = loop_;
        rehearsal.user = law;
        Vec3<double> held;
        Instant<double> now = instant();
        rehearsal.attend(true, setup_.clock_rounding(), setup_.plant.arm, now, held);
    }

    std::unique_ptr<Stepwise> copy() const override { return std::make_unique<AdaptiveRun>(*this); }

    Run so_far() const override { return AdaptiveRun(*this).conclude(); }

    Run conclude() override {
        if (!is_over()) end(ARM3R_RUN_STOPPED, "the simulation stands" + at_time(run_.t_end));
        note_end();
        Flows flows = ledger_.flows();
        flows.leverage = leverage(setup_.plant, run_.peak_force);
        return finish(now_.y, now_.theta, flows);
    }

private:
    // The components that there are.
    Y moving() const {
        Y y;
        std::copy_n(now_.y.begin(), N, y.begin());
        return y;
    }

    // ---- contact

    WallState<double> wall_now() const { return wall_at(setup_.plant.wall, run_.t_end); }

    Indentation<double> indentation_now() const {
        return tip_indentation(setup_.plant, wall_now(), pose(angles(now_.y)), rates(now_.y));
    }

    double force_now() const {
        return mode_ == Mode::contact ? normal_force(setup_.plant.contact, indentation_now()) : 0;
    }

    // The solution up to place b within the step has been gone through in the present mode.
    void note_passage(double b) {
        if (mode_ == Mode::contact) run_.impulse += watch_.impulse(inside_, 0, b);
    }

    void change_mode(const Change& change) {
        now_.y[work_of_wall] += change.gained;
        now_.y[dissipated] += change.lost;
        if (change.makes()) note_event(Event::make, change.t);
        if (change.breaks()) note_event(Event::brk, change.t);
        note_change(change, now_.y);
        if (has_memory(setup_.plant)) tell_controller();
    }

    // A continuous controller sees contact as it is; its integral starts anew with each (7.4).
    void tell_controller() {
        const Controller<double>& controller = setup_.plant.controller;
        contact_ = is_touching(mode_) ? 1 : 0;
        if (controller.switching == Switching::always) force_phase_ = 1;
        else if (controller.switching == Switching::in_contact) force_phase_ = contact_;
        else force_phase_ = std::max(force_phase_, contact_);
        if (contact_ == 0 && integrates_force(controller.type)) now_.y[law_at] = 0;
    }

    void note_event(Event::Type type, double t) {
        if (type == Event::make) {
            run_.contacts += 1;
            if (run_.contacts == 1) run_.first_contact = t;
            now_.touching_since = t;
        } else {
            if (std::isnan(run_.first_release)) run_.first_release = t;
            run_.contact_time += t - now_.touching_since;
        }
        if (++now_.events > most_events) end(ARM3R_RUN_EVENT_STORM, event_storm(t));
    }

    // ---- start

    void start() {
        if (is_touching(mode_)) note_event(Event::make, setup_.start);
        now_.peak = {force_now(), setup_.start};
        start_memory();
    }

    void set_off() {
        now_.has_set_off = true;
        attend();
        derive();
        now_.h = first_step();
        FullState f{};
        std::copy_n(stepper_.f0().begin(), N, f.begin());
        begin(now_.y, f, mode_, ledger_.energy_at_start());
    }

    void start_memory() {
        if constexpr (N == full_size) {
            tell_controller();
            const Plant<double>& plant = setup_.plant;
            const Sensed<double> truth = instant().seen;
            for (int i = 0; i < 3; ++i) now_.y[filter_at + i] = truth.f_on_tip[i];
            stepper_.set(touch(), contact_, force_phase_, infinite);
            const Sensed<double> sensed = stepper_.right_hand_side().sense(truth.t, wall_now(), truth.pose, truth.q,
                                                                           truth.qd, truth.f_on_tip, moving());
            if (has_law(plant.controller.type)) {
                const auto memory = memory_at_start(plant.controller, sensed);
                std::copy(memory.begin(), memory.end(), now_.y.begin() + law_at);
            }
            const Vec3<double> p = momentum(plant.controller.model, truth.pose, truth.qd);
            for (int i = 0; i < 3; ++i) now_.y[observer_at + i] = p[i];
        }
    }

    // What a digital controller looks at.
    Instant<double> instant() const {
        const Plant<double>& plant = setup_.plant;
        const Pose<double> p = pose(angles(now_.y));
        Vec3<double> f(0, 0, 0), n(0, 0, 0);
        double face = 0, contact = 0;
        if (plant.has_wall) {
            const WallState<double> wall = wall_now();
            if (mode_ == Mode::contact) {
                const Indentation<double> in = tip_indentation(plant, wall, p, rates(now_.y));
                f = only_where(in.depth > 0, contact_force(plant.wall, wall, plant.contact, in, Grip::clipped)).on_tip;
            }
            n = normal(plant.wall, wall);
            face = dot(n, wall.position) + plant.wall.face_offset;
            contact = dot(n, f) > 0 ? 1 : 0;
        }
        if (plant.load.on) f = plus(f, load_at(plant.load, run_.t_end));
        Instant<double> now{{run_.t_end, angles(now_.y), rates(now_.y), p, f, f, n, face, contact, 0}, {}};
        if constexpr (N == full_size)
            now.f_filtered = {now_.y[filter_at], now_.y[filter_at + 1], now_.y[filter_at + 2]};
        return now;
    }

    // Whatever a digital controller has to do now; whether its torque may have changed.
    bool attend() {
        if (loop_.next() > run_.t_end + setup_.clock_rounding() || !is_going_on()) return false;
        Instant<double> now = instant();
        loop_.attend(true, setup_.clock_rounding(), setup_.plant.arm, now, setup_.plant.controller.torque);
        note_torque();
        note_known(loop_.known());
        if (loop_.has_failed()) end(ARM3R_RUN_CONTROLLER, loop_.complaint());
        if (loop_.user.function && options_.time_limit > 0) read_clock();
        return true;
    }

    // Whether the controller has to be asked before the run goes on.
    bool stand_at_sample() {
        return now_.waits = is_going_on() && loop_.next_sample() <= run_.t_end + setup_.clock_rounding();
    }

    Touch touch() const {
        return mode_ == Mode::contact ? Touch::pressed : mode_ == Mode::separated ? Touch::released : Touch::none;
    }

    // The derivative at the present instant, from where the next step goes.
    void derive() {
        stepper_.set(touch(), contact_, force_phase_, infinite);
        stepper_.begin(run_.t_end, moving());
    }

    // ---- steps

    double weighted_norm(const Y& v) const {
        double largest = 0;
        for (std::size_t i = 0; i < N; i = i + 1 == motion_size ? state_size : i + 1)
            largest =
                std::max(largest, std::abs(v[i]) / (setup_.solver.atol + setup_.solver.rtol * std::abs(now_.y[i])));
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

    // In which time the fastest link angle turns as far as a step may, at its present rate and acceleration. Motions without
    // an error of their own, a spin without gravity, a compensated drift, would take steps in which the wall passes unseen
    // and the work of a turning torque is badly summed.
    double turning_time() const {
        const double turn = std::min(0.25 * pi, fifth_root(1e5 * setup_.solver.rtol));
        const auto fastest = [](const auto& v) {
            return std::max({std::abs(v[3]), std::abs(v[4]), std::abs(v[4] + v[5])});
        };
        return std::min(turn / fastest(now_.y), std::sqrt(2 * turn / fastest(stepper_.f0())));
    }

    double largest_step() const {  // (5.2)
        const Plant<double>& plant = setup_.plant;
        double h = std::min(setup_.solver.max_step, turning_time());
        if (plant.has_wall) h = std::min(h, longest_look(plant.wall));
        if (!stepper_.is_stiff() && plant.acts_on_arm && is_touching(mode_)) {
            const Indentation<double> in = indentation_now();
            const double quarter = contact_time(plant, wall_now(), pose(angles(now_.y)), in);
            h = std::min({h, quarter, time_to_break(plant.contact, in, quarter, setup_.solver.rtol)});
        }
        return h;
    }

    // Where a step ends at the latest, and what changes there.
    struct Bound {
        double t;                       // s
        bool is_knot, is_jump, is_due;  // of a formula of time alone, that formula jumps; the controller is due
        double latest;                  // s, what is seen of such formulas before (5.8)
    };

    Bound bound() const {
        const double knot = next_knot(setup_, run_.t_end), due = loop_.next(), rounding = setup_.clock_rounding();
        const double first = std::min({knot, due, setup_.stop});
        const double t = knot <= std::min(first + rounding, setup_.stop) ? knot : first;
        const bool is_knot = t == knot, is_jump = t == next_jump(setup_, run_.t_end);
        const bool has_sides = is_jump || (is_knot && setup_.plant.wall.motion == Motion::table);
        return {t, is_knot, is_jump, due <= t + rounding, has_sides ? just_before(t) : infinite};
    }

    // Whether a step was taken; the rest of it is settle().
    bool step() {
        const Bound bound = this->bound();
        const double rest = bound.t - run_.t_end, wanted = std::min(now_.h, largest_step());
        const bool last = wanted >= rest - setup_.clock_rounding();
        const double h = last ? rest : rest < 2 * wanted ? 0.5 * rest : wanted;  // no sliver of a step at the end
        if (h < 16 * epsilon * std::max(std::abs(run_.t_end), 1e-3) && !last) {
            collapse(h);
            return false;
        }
        stepper_.set(touch(), contact_, force_phase_, last ? bound.latest : infinite);
        const Y y = moving();
        const double error = stepper_.attempt(run_.t_end, y, h);
        if (!(error < 1)) {
            reject(h, error);
            return false;
        }
        stepper_.interpolate(run_.t_end, y, h, inside_);
        const std::optional<Crossing> crossing = watch_.next(inside_, 0, mode_, now_.peak);
        const double theta = crossing ? crossing->theta : 1;
        const double t1 = crossing ? run_.t_end + theta * h : last ? bound.t : run_.t_end + h;
        const bool reached = t1 == bound.t;
        log_until(reached && (bound.is_jump || bound.is_due) ? t1 - setup_.clock_rounding() : t1);
        if (!is_going_on()) return false;
        note_passage(theta);
        if (is_scored_) score_passage(theta, t1);
        now_.theta = theta;
        if (crossing) now_.y = state_at_crossing(y, h, theta);
        else std::copy_n(stepper_.end().begin(), N, now_.y.begin());
        const bool came_to_rest = accept(t1);
        if (crossing) change_mode(change_at(setup_.plant, indentation_now(), theta, t1, mode_, crossing->next));
        now_.taken = {h,
                      error,
                      crossing.has_value(),
                      last,
                      !(crossing || came_to_rest || (reached && bound.is_knot)),
                      reached && bound.is_jump};
        return true;
    }

    // The solution within a step of RODAS4 has one order less than its end, which is not enough for the works: these are taken
    // from a second step, which ends at the crossing (5.6).
    FullState state_at_crossing(const Y& start, double h, double theta) {
        FullState y = inside_(theta);
        if (stepper_.is_stiff() && std::isfinite(stepper_.attempt(run_.t_end, start, theta * h)))
            std::copy_n(stepper_.end().begin() + motion_size, ledger_size, y.begin() + motion_size);
        return y;
    }

    void settle() {
        const bool new_torque = attend();
        stepper_.set(touch(), contact_, force_phase_, infinite);
        stepper_.accept(run_.t_end, moving(), now_.taken.h, now_.taken.goes_on && !new_torque);
        ledger_.close(setup_.plant, run_.t_end, now_.y, mode_);
        const double factor = stepper_.factor(now_.taken.error);
        now_.h = std::max(now_.taken.h, now_.taken.was_last ? now_.h : 0.0) *
                 (now_.just_rejected ? std::min(factor, 1.0) : factor);
        now_.just_rejected = false;
        if (now_.taken.at_jump) now_.h = std::min(now_.h, first_step());
    }

    void reject(double h, double error) {
        run_.steps.rejected += 1;
        now_.just_rejected = true;
        now_.trial_was_finite = std::isfinite(error);
        now_.h = now_.trial_was_finite ? h * std::min(1.0, stepper_.factor(error)) : 0.1 * h;
    }

    void collapse(double h) {
        if (now_.trial_was_finite)
            end(ARM3R_RUN_STEP_COLLAPSE, "the step fell to " + shortest(h) + " s at t = " + shortest(run_.t_end) +
                                             " s: the motion changes faster than the clock resolves");
        else end(ARM3R_RUN_DIVERGED, "the motion is no longer finite after t = " + shortest(run_.t_end) + " s");
    }

    // Returns whether a rate that was next to nothing has been made nothing.
    bool accept(double t1) {
        bool came_to_rest = false;
        for (std::size_t i = 3; i < motion_size; ++i) {
            if (now_.y[i] == 0 || std::abs(now_.y[i]) >= smallest_rate) continue;
            now_.y[i] = 0;
            came_to_rest = true;
        }
        run_.t_end = t1;
        run_.steps.accepted += 1;
        for (int i = 0; i < 3; ++i)
            if (std::abs(now_.y[i]) > sincos_limit)
                end(ARM3R_RUN_DIVERGED,
                    "joint " + std::to_string(i + 1) + " turned beyond 1e5 rad at t = " + shortest(run_.t_end) + " s");
        if (!well_conditioned())
            end(ARM3R_RUN_ILL_CONDITIONED,
                "the mass matrix is no longer positive definite to rounding at t = " + shortest(run_.t_end) + " s");
        return came_to_rest;
    }

    bool well_conditioned() const {
        const Mat3<double> M = mass_matrix(setup_.plant.arm, pose(angles(now_.y)));
        return M(0, 0) > 0 && M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2) > 8 * epsilon * M(1, 1) * M(2, 2);
    }

    // ---- score

    // From the begin of the step to place b in it, at t1.
    void score_passage(double b, double t1) {
        const bool is_sampled = setup_.digital.sampling.on;
        const StepView view{setup_,
                            inside_,
                            mode_ == Mode::contact,
                            contact_,
                            is_sampled ? loop_.known().force_phase : force_phase_,
                            is_sampled ? &setup_.plant.controller.torque : nullptr,
                            short_of(t1)};
        if (is_sampled && !Looks(setup_).motion()) add_alone(trapezoid, is_touching(mode_), view, 0, b, tally_);
        else add_alone(boole, is_touching(mode_), view, 0, b, tally_);
    }

    void note_end() {
        run_.steps.evaluations = stepper_.evaluations();
        run_.q = joints_out(angles(now_.y));
        run_.qd = joints_out(rates(now_.y));
        run_.tip = plain(tip_position(setup_.plant.arm, pose(angles(now_.y))));
        note_energies(now_.y, setup_.plant, lost_at_edges_, run_);
        if (is_touching(mode_)) run_.contact_time += run_.t_end - now_.touching_since;
        run_.peak_force = now_.peak.force;
        if (run_.contacts > 0) run_.peak_force_time = now_.peak.t;
        run_.final_force = force_now();
        if (is_scored_) tell_score(tally_, setup_, run_);
        run_.stiff_steps = double(stepper_.stiff_steps());
        run_.choices = stepper_.choices();
        if (known_.identifiable > 0) {
            run_.stiffness_estimate = known_.stiffness;
            run_.wall_speed_estimate = known_.wall_speed;
        }
    }

    Stepper<N> stepper_;
    ContactWatch watch_;
    const bool is_scored_ = setup_.is_scored();
};

}  // namespace

std::unique_ptr<Stepwise> begin_stepwise(const Setup& setup, const RunOptions& options) {
    if (has_memory(setup.plant)) return std::make_unique<AdaptiveRun<full_size>>(setup, options);
    return std::make_unique<AdaptiveRun<state_size>>(setup, options);
}

Run run_adaptively(const Setup& setup, const RunOptions& options) {
    const std::unique_ptr<Stepwise> run = begin_stepwise(setup, options);
    while (!run->is_over()) run->go_on();
    return run->conclude();
}

}  // namespace arm3r
