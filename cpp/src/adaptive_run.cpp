// Runs by Dormand and Prince (5.2), one at a time.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "events.hpp"
#include "ledger.hpp"
#include "numbers.hpp"
#include "recorder.hpp"
#include "runs.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int looks_per_step = 9;

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

class AdaptiveRun : Recorder {
public:
    AdaptiveRun(std::span<const double> params, const RunOptions& options)
        : Recorder(params, options),
          rhs_(setup_.plant),
          watch_(setup_.plant, looks_per_step),
          y_(start_of(setup_)),
          ledger_(setup_, y_, mode_ = watch_.mode_at_start(y_)) {}

    Run run() {
        start();
        while (is_going_on() && run_.t_end < setup_.stop) {
            if (double(run_.steps.accepted + run_.steps.rejected) >= setup_.solver.max_steps)
                end(ARM3R_RUN_BUDGET, steps_used_up(run_.t_end));
            else if (poll()) step();
        }
        note_end();
        return finish(y_, theta_, ledger_.flows());
    }

private:
    // ---- contact

    double depth() const {
        const WallState<double> wall = wall_at(setup_.plant.wall, run_.t_end);
        return tip_indentation(setup_.plant, wall, pose(angles(y_)), rates(y_)).depth;
    }

    void note_depth(double depth) {
        run_.peak_force = std::max(run_.peak_force, setup_.plant.contact.stiffness[0] * depth);
    }

    // The solution up to place b within the step has been gone through in the present mode.
    void note_passage(double b) {
        if (mode_ == Mode::contact)
            run_.impulse += setup_.plant.contact.stiffness[0] * watch_.depth_integral(inside_, 0, b);
    }

    // What is still stored in the contact is lost (4.9): something where the tip leaves over an edge, else nothing.
    void change_mode(const Change& change) {
        y_[8] += change.lost;
        if (change.to == Mode::contact) note_event(Event::make, change.t);
        if (change.from == Mode::contact) note_event(Event::brk, change.t);
        note_change(change, y_);
    }

    void note_event(Event::Type type, double t) {
        if (type == Event::make) {
            run_.contacts += 1;
            if (run_.contacts == 1) run_.first_contact = t;
            touching_since_ = t;
        } else {
            if (std::isnan(run_.first_release)) run_.first_release = t;
            run_.contact_time += t - touching_since_;
        }
        if (++events_ > most_events) end(ARM3R_RUN_EVENT_STORM, event_storm(t));
    }

    // ---- steps

    void start() {
        if (mode_ == Mode::contact) {
            note_event(Event::make, 0.0);
            note_depth(depth());
        }
        derive();
        h_ = first_step();
        begin(y_, f_, mode_, ledger_.energy_at_start());
    }

    // The derivative at the present instant, with the sines and cosines that the next stages turn from.
    void derive() {
        rhs_.touch = mode_ == Mode::contact ? Touch::pressed : Touch::none;
        rhs_.begin_step(y_);
        rhs_(run_.t_end, y_, f_);
        run_.steps.evaluations += 1;
    }

    double weighted_norm(const FullState& v) const {
        double largest = 0;
        for (std::size_t i = 0; i < motion_size; ++i)
            largest = std::max(largest, std::abs(v[i]) / (setup_.solver.atol + setup_.solver.rtol * std::abs(y_[i])));
        return largest;
    }

    double first_step() {  // (5.2)
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

    void step() {
        const double rest = setup_.stop - run_.t_end;
        const double wanted = std::min(h_, largest_step());
        const bool last = wanted >= rest;
        const double h = last ? rest : rest < 2 * wanted ? 0.5 * rest : wanted;  // no sliver of a step at the end
        if (h < 16 * epsilon * std::max(run_.t_end, 1e-3) && !last) {
            collapse(h);
            return;
        }
        stepper_.step(rhs_, run_.t_end, y_, f_, h);
        run_.steps.evaluations += 6;
        const double error = is_finite(stepper_.y1) && is_finite(stepper_.f1)
                                 ? stepper_.error(y_, h, setup_.solver.rtol, setup_.solver.atol)
                                 : infinite;
        if (!(error < 1)) {
            reject(h, error);
            return;
        }
        inside_ = stepper_.interpolant(run_.t_end, y_, h);
        double deepest = 0;
        const std::optional<Crossing> crossing = watch_.next(inside_, 0, mode_, deepest);
        const double theta = crossing ? crossing->theta : 1;
        const double t1 = crossing ? run_.t_end + theta * h : last ? setup_.stop : run_.t_end + h;
        log_until(t1);
        if (!is_going_on()) return;
        note_depth(deepest);
        note_passage(theta);
        theta_ = theta;
        y_ = crossing ? inside_(theta) : stepper_.y1;
        const bool came_to_rest = accept(t1);
        if (crossing) change_mode({theta, t1, energies(setup_.plant, t1, y_, mode_).contact, mode_, crossing->next});
        if (crossing || came_to_rest) derive();
        else carry_over();
        ledger_.close(run_.t_end, y_, mode_);
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
            end(ARM3R_RUN_STEP_COLLAPSE, "the step fell to " + shortest(h) + " s at t = " + shortest(run_.t_end) +
                                             " s: the motion changes faster than the clock resolves");
        else end(ARM3R_RUN_DIVERGED, "the motion is no longer finite after t = " + shortest(run_.t_end) + " s");
    }

    // Returns whether a rate that was next to nothing has been made nothing.
    bool accept(double t1) {
        bool came_to_rest = false;
        for (std::size_t i = 3; i < motion_size; ++i) {
            if (y_[i] == 0 || std::abs(y_[i]) >= smallest_rate) continue;
            y_[i] = 0;
            came_to_rest = true;
        }
        run_.t_end = t1;
        run_.steps.accepted += 1;
        for (int i = 0; i < 3; ++i)
            if (std::abs(y_[i]) > sincos_limit)
                end(ARM3R_RUN_DIVERGED,
                    "joint " + std::to_string(i + 1) + " turned beyond 1e5 rad at t = " + shortest(run_.t_end) + " s");
        if (!well_conditioned())
            end(ARM3R_RUN_ILL_CONDITIONED,
                "the mass matrix is no longer positive definite to rounding at t = " + shortest(run_.t_end) + " s");
        return came_to_rest;
    }

    bool well_conditioned() const {
        const Mat3<double> M = mass_matrix(setup_.plant.arm, pose(angles(y_)));
        return M(0, 0) > 0 && M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2) > 8 * epsilon * M(1, 1) * M(2, 2);
    }

    void note_end() {
        run_.q = joints_out(angles(y_));
        run_.qd = joints_out(rates(y_));
        run_.tip = plain(tip_position(setup_.plant.arm, pose(angles(y_))));
        for (std::size_t i = motion_size; i < state_size; ++i) run_.books[i - motion_size] = y_[i];
        if (mode_ != Mode::contact) return;
        run_.contact_time += run_.t_end - touching_since_;
        run_.final_force = setup_.plant.contact.stiffness[0] * std::max(0.0, depth());
    }

    RightHandSide<double, double> rhs_;
    ContactWatch watch_;
    Dopri5<double, state_size, motion_size> stepper_;
    double h_ = 0;
    FullState y_, f_{};
    Ledger ledger_;
    double theta_ = 0;  // where the present instant lies in the last step
    bool just_rejected_ = false;
    bool trial_was_finite_ = true;  // the last one that was rejected
    double touching_since_ = 0, events_ = 0;
};

}  // namespace

Run run_adaptively(std::span<const double> params, const RunOptions& options) {
    return AdaptiveRun(params, options).run();
}

}  // namespace arm3r
