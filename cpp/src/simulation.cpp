#include "simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "error.hpp"
#include "events.hpp"
#include "ledger.hpp"
#include "numbers.hpp"
#include "row_log.hpp"
#include "schema.hpp"
#include "size_cap.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double smallest_rate = 1e-140;  // rad/s: below it products would be subnormal, and slow
constexpr std::size_t most_events = 4096;
constexpr int looks_per_adaptive_step = 9, looks_per_fixed_step = 2;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

bool is_finite(const FullState& y) {
    return std::all_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); });
}

// The state at t = 0.
FullState start_of(const Setup& setup) {
    FullState y{};
    for (int i = 0; i < 3; ++i) {
        y[i] = setup.q[i];
        y[3 + i] = setup.qd[i];
    }
    return y;
}

Setup small_enough(Setup setup) {
    refuse_too_large(setup);
    return setup;
}

std::array<double, 3> plain(const Vec3<double>& v) { return {v[0] + 0.0, v[1] + 0.0, v[2] + 0.0}; }

class Simulator {
public:
    Simulator(std::span<const double> params, const RunOptions& options)
        : setup_(small_enough(make_setup(params))),
          options_(options),
          rhs_(setup_.plant),
          watch_(setup_.plant, setup_.solver.method == Solver::dopri5 ? looks_per_adaptive_step : looks_per_fixed_step),
          rows_(setup_, run_, options.rows),
          y_(start_of(setup_)),
          mode_(watch_.mode_at_start(y_)),
          ledger_(setup_, y_, mode_) {
        if (!options.rows) return;
        run_.events.reserve(most_events);
        run_.warnings = likely_slips(params);
    }

    Run run() {
        start();
        while (run_.outcome == ARM3R_RUN_OK && t_ < setup_.stop) {
            if (steps_taken() >= setup_.solver.max_steps)
                end(ARM3R_RUN_BUDGET, "solver.max_steps is used up at t = " + shortest(t_) +
                                          " s; stiff friction or contact, or a tolerance too tight?");
            else if (poll()) setup_.solver.method == Solver::dopri5 ? adaptive_step() : fixed_step();
        }
        finish();
        return std::move(run_);
    }

private:
    Scene scene() const { return {setup_.plant, setup_.simscape, ledger_.energy_at_start(), mode_, inside_}; }

    void log_until(double t) {
        if (options_.rows) rows_.log_until(t, scene(), [this] { return poll(); });
    }

    // ---- contact

    Touch touch() const {
        if (mode_ == Mode::embedded || !setup_.plant.has_wall) return Touch::none;
        if (setup_.solver.method == Solver::rk4) return Touch::each_stage;
        return mode_ == Mode::contact ? Touch::pressed : Touch::none;
    }

    void note_depth(double depth) {
        run_.peak_force = std::max(run_.peak_force, setup_.plant.contact.stiffness[0] * depth);
    }

    // What is still stored in the contact is lost (4.9): something where the tip leaves over an edge, else nothing.
    void change_mode(double t, const FullState& y, Mode next) {
        const double lost = energies(setup_.plant, t, y, mode_).contact;
        y_[8] += lost;
        inside_.c[0][8] += lost;  // for the rows of this step that are still to come
        if (next == Mode::contact) record(Event::make, t, y);
        if (mode_ == Mode::contact) record(Event::brk, t, y);
        mode_ = next;
    }

    void record(Event::Type type, double t, const FullState& y) {
        note_event(type, t);
        if (events_seen_++ == most_events) {
            end(ARM3R_RUN_EVENT_STORM, "more than 4096 contact events, the last at t = " + shortest(t) + " s");
            return;
        }
        if (options_.rows)
            run_.events.push_back({type, t, joints_out(angles(y)), joints_out(rates(y)),
                                   plain(tip_position(setup_.plant.arm, pose(angles(y))))});
    }

    std::array<double, 3> joints_out(const Vec3<double>& v) const { return plain(setup_.simscape ? flipped(v) : v); }

    void note_event(Event::Type type, double t) {
        if (type == Event::make) {
            run_.contacts += 1;
            if (run_.contacts == 1) run_.first_contact = t;
            touching_since_ = t;
        } else {
            if (std::isnan(run_.first_release)) run_.first_release = t;
            run_.contact_time += t - touching_since_;
        }
    }

    // The solution from place a to place b within the step has been gone through in the present mode.
    void note_passage(double a, double b) {
        if (mode_ == Mode::contact)
            run_.impulse += setup_.plant.contact.stiffness[0] * watch_.depth_integral(inside_, a, b);
    }

    // ---- steps

    void start() {
        if (mode_ == Mode::contact) {
            record(Event::make, 0.0, y_);
            note_depth(
                tip_indentation(setup_.plant, wall_at(setup_.plant.wall, 0.0), pose(angles(y_)), rates(y_)).depth);
        }
        derive();
        h_ = first_step();
        constexpr double a_moment = 1e-3;  // s
        FullState ahead;                   // straight on, in place of a solution before there is a step
        for (std::size_t i = 0; i < state_size; ++i) ahead[i] = y_[i] + a_moment * f_[i];
        inside_ = hermite(0.0, a_moment, y_, f_, ahead, f_);
        if (options_.rows && setup_.stop > 0) rows_.log(scene(), 0.0, y_, 0.0);  // whatever becomes of the first step
    }

    // The derivative at the present instant, with the sines and cosines that the next stages turn from.
    void derive() {
        rhs_.touch = touch();
        rhs_.begin_step(y_);
        rhs_(t_, y_, f_);
        run_.steps.evaluations += 1;
    }

    double weighted_norm(const FullState& v) const {
        double largest = 0;
        for (std::size_t i = 0; i < motion_size; ++i)
            largest = std::max(largest, std::abs(v[i]) / (setup_.solver.atol + setup_.solver.rtol * std::abs(y_[i])));
        return largest;
    }

    double first_step() {  // (5.2)
        if (setup_.solver.method == Solver::rk4) return setup_.solver.step;
        const double size = weighted_norm(y_), slope = weighted_norm(f_);
        const double trial = size < 1e-5 || slope < 1e-5 ? 1e-6 : 0.01 * size / slope;
        FullState euler, f1;
        for (std::size_t i = 0; i < state_size; ++i) euler[i] = y_[i] + trial * f_[i];
        rhs_(trial, euler, f1);
        run_.steps.evaluations += 1;
        for (std::size_t i = 0; i < state_size; ++i) f1[i] -= f_[i];
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
        const auto fastest = [](const FullState& v) {
            return std::max({std::abs(v[3]), std::abs(v[4]), std::abs(v[4] + v[5])});
        };
        return std::min(turn / fastest(y_), std::sqrt(2 * turn / fastest(f_)));
    }

    double largest_step() const {  // (5.2)
        const Plant<double>& plant = setup_.plant;
        double h = std::min(setup_.solver.max_step, turning_time());
        if (plant.has_wall && plant.wall.motion == Motion::sinusoid) h = std::min(h, 1 / (16 * plant.wall.frequency));
        if (plant.acts_on_arm && mode_ == Mode::contact && plant.contact.stiffness[0] > 0)
            h = std::min(h, 0.25 * pi *
                                std::sqrt(effective_mass(plant.arm, pose(angles(y_)), plant.wall.n) /
                                          plant.contact.stiffness[0]));
        return h;
    }

    void adaptive_step() {
        const double rest = setup_.stop - t_;
        const double wanted = std::min(h_, largest_step());
        const bool last = wanted >= rest;
        const double h = last ? rest : rest < 2 * wanted ? 0.5 * rest : wanted;  // no sliver of a step at the end
        if (h < 16 * epsilon * std::max(t_, 1e-3) && !last) {
            collapse(h);
            return;
        }
        stepper_.step(rhs_, t_, y_, f_, h);
        run_.steps.evaluations += 6;
        const double error = is_finite(stepper_.y1) && is_finite(stepper_.f1)
                                 ? stepper_.error(y_, h, setup_.solver.rtol, setup_.solver.atol)
                                 : infinite_;
        if (!(error < 1)) {
            reject(h, error);
            return;
        }
        inside_ = stepper_.interpolant(t_, y_, h);
        double deepest = 0;
        const std::optional<Crossing> crossing = watch_.next(inside_, 0, mode_, deepest);
        note_depth(deepest);
        const double theta = crossing ? crossing->theta : 1;
        note_passage(0, theta);
        const double t1 = crossing ? t_ + theta * h : last ? setup_.stop : t_ + h;
        log_until(t1);
        if (run_.outcome != ARM3R_RUN_OK) return;
        theta_ = theta;
        y_ = crossing ? inside_(theta) : stepper_.y1;
        const bool came_to_rest = accept(t1);
        if (crossing) change_mode(t1, y_, crossing->next);
        if (crossing || came_to_rest) derive();
        else carry_over();
        ledger_.close(t_, y_, mode_, run_);
        const double factor = step_factor(error);
        h_ = h * (just_rejected_ ? std::min(factor, 1.0) : factor);
        just_rejected_ = false;
    }

    void carry_over() {  // the last stage is the first of the next step
        f_ = stepper_.f1;
        rhs_.begin_step(y_);
    }

    void reject(double h, double error) {
        run_.steps.rejected += 1;
        just_rejected_ = true;
        trial_was_finite_ = std::isfinite(error);
        h_ = trial_was_finite_ ? h * std::min(1.0, step_factor(error)) : 0.1 * h;
    }

    void collapse(double h) {
        if (trial_was_finite_)
            end(ARM3R_RUN_STEP_COLLAPSE, "the step fell to " + shortest(h) + " s at t = " + shortest(t_) +
                                             " s: the motion changes faster than the clock resolves");
        else end(ARM3R_RUN_DIVERGED, "the motion is no longer finite after t = " + shortest(t_) + " s");
    }

    void fixed_step() {
        const double t1 = std::min(setup_.stop, double(run_.steps.accepted + 1) * setup_.solver.step);
        const bool last = t1 >= setup_.stop - 1e-9 * setup_.solver.step;
        const double h = last ? setup_.stop - t_ : setup_.solver.step;
        const double t0 = t_;
        const FullState y0 = y_, f0 = f_;
        FullState y1 = rk4_step(rhs_, t_, y_, f_, h);
        run_.steps.evaluations += 3;
        if (!is_finite(y1)) {
            end(ARM3R_RUN_DIVERGED,
                "the motion is no longer finite after t = " + shortest(t_) + " s; a smaller solver.step may hold it");
            return;
        }
        y_ = y1;
        accept(last ? setup_.stop : t1);
        derive();
        inside_ = hermite(t0, h, y0, f0, y_, f_);
        theta_ = 1;
        settle_fixed_step(t0, h);
    }

    // Contact is located after the step; a change of mode acts from the next step on.
    void settle_fixed_step(double t0, double h) {
        double deepest = 0, from = 0;
        bool changed = false;
        while (const std::optional<Crossing> crossing = watch_.next(inside_, from, mode_, deepest)) {
            const double t = t0 + crossing->theta * h;
            note_passage(from, crossing->theta);
            log_until(t);
            change_mode(t, inside_(crossing->theta), crossing->next);
            changed = true;
            from = crossing->theta;
            if (run_.outcome != ARM3R_RUN_OK || from >= 1) break;
        }
        note_depth(deepest);
        note_passage(from, 1);
        log_until(t_);
        if (changed) derive();
        ledger_.close(t_, y_, mode_, run_);
    }

    // Returns whether a rate that was next to nothing has been made nothing.
    bool accept(double t1) {
        bool came_to_rest = false;
        for (std::size_t i = 3; i < motion_size; ++i) {
            if (y_[i] == 0 || std::abs(y_[i]) >= smallest_rate) continue;
            y_[i] = 0;
            came_to_rest = true;
        }
        t_ = t1;
        run_.steps.accepted += 1;
        for (int i = 0; i < 3; ++i)
            if (std::abs(y_[i]) > sincos_limit)
                end(ARM3R_RUN_DIVERGED,
                    "joint " + std::to_string(i + 1) + " turned beyond 1e5 rad at t = " + shortest(t_) + " s");
        if (!well_conditioned())
            end(ARM3R_RUN_ILL_CONDITIONED,
                "the mass matrix is no longer positive definite to rounding at t = " + shortest(t_) + " s");
        return came_to_rest;
    }

    bool well_conditioned() const {
        const Mat3<double> M = mass_matrix(setup_.plant.arm, pose(angles(y_)));
        return M(0, 0) > 0 && M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2) > 8 * epsilon * M(1, 1) * M(2, 2);
    }

    // ---- the end

    double steps_taken() const { return double(run_.steps.accepted + run_.steps.rejected); }

    void end(arm3r_outcome outcome, std::string message) {
        if (run_.outcome != ARM3R_RUN_OK) return;
        run_.outcome = outcome;
        run_.message = std::move(message);
    }

    // Whether to go on. The clock is read now and then only.
    bool poll() {
        if (options_.stop && *options_.stop) end(ARM3R_RUN_STOPPED, "stopped at t = " + shortest(t_) + " s");
        if (++polls_ % 256 == 0) read_clock();
        return run_.outcome == ARM3R_RUN_OK;
    }

    void read_clock() {
        const double elapsed = seconds_since(begun_);
        if (options_.time_limit > 0 && elapsed > options_.time_limit)
            end(ARM3R_RUN_BUDGET,
                "the time limit of " + shortest(options_.time_limit) + " s is used up at t = " + shortest(t_) + " s");
        if (!options_.progress || elapsed < next_report_) return;
        next_report_ = elapsed + 0.02;
        const std::int32_t answer =
            options_.progress(options_.user, t_, setup_.stop, static_cast<std::int64_t>(steps_taken()));
        if (answer < 0)
            throw Error(ARM3R_E_CALLBACK, "the progress function asked to stop with " + std::to_string(answer));
        if (answer > 0) end(ARM3R_RUN_STOPPED, "stopped at t = " + shortest(t_) + " s");
    }

    void judge() {
        const std::optional<std::string> complaint = ledger_.complaint(run_);
        if (!complaint) return;
        if (ledger_.is_strict()) end(ARM3R_RUN_ENERGY, *complaint);
        else run_.warnings.push_back(*complaint);
    }

    void finish() {
        if (run_.outcome == ARM3R_RUN_OK) {
            if (options_.rows) rows_.log(scene(), t_, y_, theta_);
            judge();
        }
        if (rows_.link_behind_wall_since() >= 0)
            run_.warnings.push_back("a link other than at its tip is behind the wall from t = " +
                                    shortest(rows_.link_behind_wall_since()) + " s on; only the tip feels the wall");
        note_end();
        run_.elapsed_s = seconds_since(begun_);
    }

    void note_end() {
        run_.t_end = std::max(t_, rows_.last_time());
        run_.energy_residual_max = std::max(run_.energy_residual_max, run_.ledger_residual);
        run_.q = joints_out(angles(y_));
        run_.qd = joints_out(rates(y_));
        const Pose<double> p = pose(angles(y_));
        run_.tip = plain(tip_position(setup_.plant.arm, p));
        for (std::size_t i = motion_size; i < state_size; ++i) run_.books[i - motion_size] = y_[i];
        if (mode_ != Mode::contact) return;
        run_.contact_time += t_ - touching_since_;
        const double depth = tip_indentation(setup_.plant, wall_at(setup_.plant.wall, t_), p, rates(y_)).depth;
        run_.final_force = setup_.plant.contact.stiffness[0] * std::max(0.0, depth);
    }

    static constexpr double infinite_ = std::numeric_limits<double>::infinity();

    const Clock::time_point begun_ = Clock::now();
    const Setup setup_;
    const RunOptions options_;
    Run run_;
    RightHandSide<double, double> rhs_;
    ContactWatch watch_;
    Dopri5<double, state_size, motion_size> stepper_;
    RowLog rows_;

    double t_ = 0, h_ = 0;
    FullState y_, f_{};
    Mode mode_;
    Ledger ledger_;
    Inside inside_;     // the solution within the last step
    double theta_ = 0;  // where t_ lies in it
    double touching_since_ = 0;
    std::size_t events_seen_ = 0;
    bool just_rejected_ = false;
    bool trial_was_finite_ = true;  // the last one that was rejected

    unsigned polls_ = 0;
    double next_report_ = 0;
};

}  // namespace

Run simulate(std::span<const double> params, const RunOptions& options) {
    std::vector<Problem> problems = validate(params);
    if (!problems.empty()) throw Error(ARM3R_E_SCENARIO, std::move(problems));
    return Simulator(params, options).run();
}

}  // namespace arm3r
