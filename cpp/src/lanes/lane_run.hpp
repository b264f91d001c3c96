#pragma once
// Runs that march side by side, each as if alone: T = double is one run, Pack<N> are N. What all methods share: clock,
// state, contact, books and metrics of every lane. What is rare, a change of contact or the end of a run, is done
// lane by lane in doubles, by the same functions for every T.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "arm3r/numbers/eigen_traits.hpp"
#include "base/noinline.hpp"
#include "contact/contact_change.hpp"
#include "control/sampled_controller.hpp"
#include "record/energy_balance.hpp"
#include "run/performance.hpp"

namespace arm3r {

// What is the same in all lanes, so that nothing that no lane needs is computed, and every lane rounds alike.
struct Structure {
    Solver::Method method;
    int order;  // of taylor
    bool has_wall, acts_on_arm, has_outline, may_be_ill_conditioned;
    Motion motion;
    int knots;  // of a table
    Rotation rotation;
    Law law;
    bool has_friction;  // of the wall
    ControllerChoices controller;
    SetpointChoices setpoint;
    SamplingChoices sampling;
    SensorChoices sensors;
    ObserverChoices observer;
    EstimationChoices estimation;
    bool has_load;
    std::array<bool, 8> flags;  // of arm and model

    bool operator==(const Structure&) const = default;
};

Structure structure_of(const Setup& setup);

// Of theta, for an instant near t in a step of h.
inline double event_resolution(double t, double h) {
    return std::max(finest_event, 4 * std::numeric_limits<double>::epsilon() * std::abs(t)) / h;
}

// N: state_size, or full_size where a continuous controller remembers something.
template <class T, std::size_t N = state_size>
class March {
public:
    using Mask = typename Lanes<T>::Mask;
    using Y = State<T, N>;
    static constexpr int lanes = Lanes<T>::count;

    explicit March(const Setup& any_lane);

    // Put a run into a lane. The lanes put in since then begin with the next call of begin().
    void put(int lane, const Setup& setup);
    ARM3R_INLINE void begin() {
        look();
        for (int lane = 0; lane < lanes; ++lane)
            if (is_new_[lane]) begin_lane(lane);
        if (N == full_size) start_memory();
        begun_ = alive_;
        if (is_controlled_ || N == full_size || any_embedded_) look();
        for (bool& is_new : is_new_) is_new = false;
    }

    // A law of the user's own, for the only lane.
    void use(const UserLaw& law) { loop_.user = law; }
    std::string complaint() const { return loop_.complaint(); }
    const Known<T>& known() const { return loop_.known(); }
    double contact(int lane) const { return Lanes<T>::get(rhs_.contact, lane); }
    double force_phase(int lane) const { return Lanes<T>::get(rhs_.force_phase, lane); }
    Vec3<double> torque(int lane) const {
        const Vec3<T>& tau = plant_.controller.torque;
        return {Lanes<T>::get(tau[0], lane), Lanes<T>::get(tau[1], lane), Lanes<T>::get(tau[2], lane)};
    }

    void retire(int lane);
    bool is_running(int lane) const { return running_[lane]; }
    bool is_anyone_running() const { return any(alive_); }
    bool has_ended(int lane) const { return running_[lane] && (outcome_[lane] != ARM3R_RUN_OK || at_stop(lane)); }
    ARM3R_INLINE bool someone_ended() const { return failed_ || any(alive_ && t_ >= stop_); }
    void forget_failures() { failed_ = false; }

    void stop_lane(int lane, arm3r_outcome outcome) {
        if (outcome_[lane] == ARM3R_RUN_OK) outcome_[lane] = outcome;
        failed_ = true;
    }
    Metrics metrics(int lane) const;
    double peak_force(int lane) const {  // N, normal
        return is_elastic_ ? Lanes<T>::get(true_contact_.stiffness[0], lane) * Lanes<T>::get(deepest_, lane)
                           : Lanes<T>::get(peak_, lane);
    }
    Flows flows(int lane) const;
    Steps steps(int lane) const {
        const auto count = [&](const T& x) { return std::int64_t(Lanes<T>::get(x, lane)); };
        return {count(accepted_), count(rejected_), count(evaluations_)};
    }

    // One lane, in doubles.
    double t(int lane) const { return Lanes<T>::get(t_, lane); }
    double h(int lane) const { return Lanes<T>::get(h_, lane); }
    FullState y(int lane) const { return state_of(y_, lane); }
    Mode mode(int lane) const { return mode_[lane]; }
    double energy_at_start(int lane) const { return Lanes<T>::get(energy_at_start_, lane); }
    arm3r_outcome outcome(int lane) const { return outcome_[lane]; }

protected:
    static FullState state_of(const Y& y, int lane) {
        FullState one{};
        for (std::size_t i = 0; i < N; ++i) one[i] = Lanes<T>::get(y[i], lane);
        return one;
    }
    ARM3R_INLINE static Mask select_mask(const Mask& which, const Mask& a, const Mask& b) {
        return (which && a) || (!which && b);
    }

    // ---- one instant

    // Pose, wall, indentation, derivative and energies at the present state.
    ARM3R_INLINE void observe() {
        if (needs_derivative_) {
            rhs_.begin_step(y_);
            p_ = rhs_.pose_near(y_);
        } else {
            p_ = pose(Vec3<T>(y_[0], y_[1], y_[2]));
        }
        const Vec3<T> qd(y_[3], y_[4], y_[5]);
        if (plant_.has_wall) {
            wall_ = wall_at(plant_.wall, t_);
            in_ = tip_indentation(plant_, wall_, p_, qd);
        }
        kinetic_ = kinetic_energy(plant_.arm, p_, qd);
        potential_ = potential_energy(plant_.arm, p_);
        if (is_controlled_ && any(is_due())) control();
        if (needs_derivative_) derive();
        else if (is_scored_) tau_ = torque_without_memory({y_[0], y_[1], y_[2]}, p_);
    }
    void look();

    ARM3R_INLINE Vec3<T> torque_without_memory(const Vec3<T>& q, const Pose<T>& p) const {
        return limited(plant_.arm, arm3r::control(plant_.controller, q, p), plant_.controller.saturation);
    }

    // With a controller's memory it is long: once for all who ask.
    ARM3R_INLINE void derive() {
        if constexpr (N == state_size) rhs_.derivative(t_, wall_, p_, in_, y_, f_, tau_);
        else Apart<T>::run([this]() ARM3R_INLINE_LAMBDA { rhs_.derivative(t_, wall_, p_, in_, y_, f_, tau_); });
    }

    // ---- digital controllers

    // A step ends where one of them has something to do: at the earliest of this and the end of the run.
    ARM3R_INLINE T next_instant() const { return is_controlled_ ? min(stop_, loop_.next()) : stop_; }

    ARM3R_INLINE Mask is_due() const { return begun_ && loop_.next() <= t_ + slack_; }
    void control();

    // What they look at.
    ARM3R_INLINE Instant<T> instant() const {
        const T o(0.0);
        Vec3<T> f = none<T>(), n = none<T>();
        T face = o, contact = o;
        if (plant_.has_wall) {
            f = force_on_tip();
            n = normal(plant_.wall, wall_);
            face = dot(n, wall_.position) + plant_.wall.face_offset;
            contact = select(dot(n, f) > o, T(1.0), o);
        }
        if (plant_.load.on) f = plus(f, load_at(plant_.load, t_));
        const Vec3<T> q(y_[0], y_[1], y_[2]), qd(y_[3], y_[4], y_[5]);
        Instant<T> now{{t_, q, qd, p_, f, f, n, face, contact, o}, {}};
        if constexpr (N == full_size) now.f_filtered = {y_[filter_at], y_[filter_at + 1], y_[filter_at + 2]};
        return now;
    }

    // Contact as it is at this instant, known to the modes or not yet.
    ARM3R_INLINE Vec3<T> force_on_tip() const {
        Mask pressed = in_.depth > T(0.0) && !embedded_;
        if (plant_.wall.has_outline) pressed = pressed && inside_outline(plant_.wall, in_) >= T(0.0);
        if (!any(pressed)) return none<T>();
        return only_where(pressed, contact_force(plant_.wall, wall_, true_contact_, in_, Grip::clipped)).on_tip;
    }

    // ---- the score

    // A step begins; contact, phase and a held torque are for all of it what they are now.
    ARM3R_INLINE void begin_passage() {
        passage_.start = t_;
        passage_.touching = touching_;
        phase_ = loop_.is_on() ? loop_.known().force_phase : rhs_.force_phase;
        for (int i = 0; i < 3; ++i) q_before_[i] = y_[i], tau_before_[i] = tau_[i];
        see(t_, p_, wall_, in_, tau_, {y_[3], y_[4], y_[5]}, passage_.sights[0]);
    }

    // A sight of the present passage.
    ARM3R_INLINE void see(const T& t, const Pose<T>& p, const WallState<T>& wall, const Indentation<T>& in,
                          const Vec3<T>& tau, const Vec3<T>& qd, Sight<T>& sight) const {
        const Controller<T>& law = loop_.is_on() ? loop_.controller() : plant_.controller;
        see_motion(looks_, plant_, true_contact_, law, t, p, wall, in, passage_.touching, phase_, sight);
        see_torque(plant_.arm, holds_torque() ? tau_before_ : tau, qd, sight);
    }

    // The present instant is the passage's last.
    template <std::size_t n>
    ARM3R_INLINE void end_passage(const Rule<n>& rule, const T& duration) {
        passage_.duration = duration;
        see(short_of(t_), p_, wall_, in_, tau_, {y_[3], y_[4], y_[5]}, passage_.sights[n - 1]);
        for (int i = 0; i < 3; ++i)
            passage_.work[i] = holds_torque()
                                   ? T(tau_before_[i] * (y_[i] - q_before_[i]))
                                   : T(duration * mean_of(rule, passage_, [i](const Sight<T>& s) ARM3R_INLINE_LAMBDA {
                                           return s.power[i];
                                       }));
    }

    bool holds_torque() const { return plant_.controller.type == Controls::constant; }

    // The same in doubles, at places of the step; the torque of a digital controller is the step's.
    template <class See>
    void with_view(int lane, const Inside& inside, See see) const {
        const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
        Setup setup = setups_[lane];
        if (asks_estimator(plant_.controller))
            setup.plant.controller.gains.assumed_stiffness = get(plant_.controller.gains.assumed_stiffness);
        const Vec3<double> held{get(tau_before_[0]), get(tau_before_[1]), get(tau_before_[2])};
        const double phase = loop_.is_on() ? get(phase_) : force_phase(lane);
        see(StepView{setup, inside, mode_[lane] == Mode::contact, contact(lane), phase,
                     holds_torque() ? &held : nullptr, short_of(t(lane))});
    }

    // From place a to place b of the step in the lane's present mode.
    template <std::size_t n>
    void score_alone(int lane, const Rule<n>& rule, const Inside& inside, double a, double b) {
        Tally<double> tally = tally_of(lane);
        with_view(lane, inside, [&](const StepView& view) { add_alone(rule, view.pressed, view, a, b, tally); });
        set_tally(lane, tally);
    }

    // What the last passage hides between its sights; it ends at place b of the step.
    template <std::size_t n>
    void score_closely(int lane, const Rule<n>& rule, const Inside& inside, double b) {
        const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
        Passage<double> passage{
            get(passage_.start), get(passage_.duration), Lanes<T>::is(passage_.touching, lane), {}, {}};
        for (std::size_t j = 0; j < n; ++j) {
            const Sight<T>& sight = passage_.sights[j];
            passage.sights[j] = {get(sight.force), get(sight.force_wanted), get(sight.path_error_2),
                                 get(sight.saturated), none<double>()};
        }
        Tally<double> tally = tally_of(lane);
        with_view(lane, inside, [&](StepView view) {
            view.pressed = passage.touching;
            look_closer(rule, passage, view, 0, b, tally);
        });
        set_tally(lane, tally);
    }

    ARM3R_INLINE T stored() const {
        if (!plant_.acts_on_arm) return T(0.0);
        const auto pressed = touching_ && in_.depth > T(0.0);
        if (plant_.contact.law == Law::spring)
            return select(pressed, T(0.5 * true_contact_.stiffness[0] * in_.depth * in_.depth), T(0.0));
        return select(pressed, T(push(true_contact_, in_).stored + stored_sideways(true_contact_, in_)), T(0.0));
    }

    // ---- after a step

    // To `t1`, `y1` where `moved`; rates that are next to nothing become nothing.
    ARM3R_INLINE void accept(const Mask& moved, const T& t1, const Y& y1) {
        if (all(moved)) y_ = y1;
        else
            for (std::size_t i = 0; i < N; ++i) y_[i] = select(moved, y1[i], y_[i]);
        for (std::size_t i = 3; i < motion_size; ++i) y_[i] = select(abs(y_[i]) < T(smallest_rate), T(0.0), y_[i]);
        t_ = select(moved, t1, t_);
        accepted_ = accepted_ + select(moved, T(1.0), T(0.0));
    }

    ARM3R_INLINE static Mask is_finite(const Y& y) {
        T sum = y[0];
        for (std::size_t i = 1; i < N; ++i) sum = sum + y[i];
        return sum * 0.0 == T(0.0);
    }

    ARM3R_INLINE void close_books() {
        const T contact = stored();
        const T residual = ((kinetic_ + potential_ + contact) - energy_at_start_) -
                           (y_[work_of_actuators] + y_[work_of_wall] - y_[dissipated]);
        const T size = select(residual == residual, abs(residual), T(std::numeric_limits<double>::infinity()));
        residual_ = max(residual_, size);
        exchanged_ =
            max(max(max(exchanged_, abs(y_[work_of_actuators])), max(abs(y_[work_of_wall]), abs(y_[dissipated]))),
                max(kinetic_, abs(potential_ - potential_at_start_)));
        held_ = max(held_, T(abs(kinetic_) + abs(potential_) + abs(contact)));
    }

    ARM3R_INLINE void judge_lanes() {
        Mask bad = max(max(abs(y_[0]), abs(y_[1])), abs(y_[2])) > T(sincos_limit);
        if (may_be_ill_conditioned_) bad = bad || !well_conditioned();
        bad = bad || (accepted_ + rejected_ >= max_steps_ && t_ < stop_);
        bad = bad && alive_;
        if (any(bad)) fail_lanes(bad);
    }

    ARM3R_INLINE Mask well_conditioned() const {
        const Mat3<T> M = mass_matrix(plant_.arm, p_);
        constexpr double epsilon = std::numeric_limits<double>::epsilon();
        return M(0, 0) > T(0.0) && T(M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2)) > T(8 * epsilon * M(1, 1) * M(2, 2));
    }

    // ---- contact

    // The depth from a to b within the step that began at t0 has been gone through.
    void pass(int lane, const Polynomial<double>& depth, double t0, double a, double b);
    void change_mode(int lane, const Change& change);
    void pass_damped(int lane, const std::array<double, 5>& force, double t0, double duration);

    const Setup& setup(int lane) const { return setups_[lane]; }

    // What change_mode() has changed is felt from here on.
    void evaluate_anew();

    // The change to `next` at place theta within the step, t seconds, where the signals stand.
    Change change_of(int lane, const ContactSignals<double>& signals, double theta, double t, Mode next) const {
        const Indentation<double> in{value(signals.depth, theta),   0, value(signals.across1, theta),
                                     value(signals.across2, theta), 0, 0};
        return change_at(setups_[lane].plant, in, theta, t, mode_[lane], next);
    }

    void fail_lanes(const Mask& bad);

    // The depth or the force that `peak` is of, at t, where `here`.
    ARM3R_INLINE void reach(const Mask& here, const T& value, const T& t, T& peak) {
        peak_time_ = select(here && value > peak, t, peak_time_);
        peak = max_where(here, peak, value);
    }

    // N, along a depth over the step h: at five places, from one end to the other.
    template <class P, class S>
    ARM3R_INLINE static std::array<S, 5> forces(const Contact<P>& contact, const Polynomial<S>& depth, const S& h,
                                                const S& a, const S& b) {
        std::array<S, 5> force;
        const S o(0.0);
        for (int i = 0; i < 5; ++i) {
            const S theta = a + (b - a) * (0.25 * i);
            force[i] = normal_force(contact, Indentation<S>{value(depth, theta), slope(depth, theta) / h, o, o, o, o});
        }
        return force;
    }

    Plant<T>
        plant_;  // its contact is what the motion feels: no force in lanes that are embedded, or free where so decided
    RightHandSide<T, T> rhs_;
    bool needs_derivative_ = true, only_contact_is_felt_ = false, may_be_ill_conditioned_;

    bool is_controlled_, is_scored_;
    ControlLoop<T> loop_;
    Looks looks_;
    Tally<T> tally_;
    Passage<T> passage_;
    T phase_{0.0};                                           // of force control, in the passage
    Vec3<T> q_before_ = none<T>(), tau_before_ = none<T>();  // rad, N m: at its begin
    Contact<T> true_contact_;                                // in every mode: what sensors and the score read

    T t_{0.0}, h_{0.0}, stop_{0.0}, slack_{0.0};  // slack: how early an instant counts as reached, s
    Y y_{}, f_{};
    Pose<T> p_;
    WallState<T> wall_ = no_wall<T>();
    Indentation<T> in_{};
    Vec3<T> tau_ = none<T>();  // N m, applied
    T kinetic_, potential_;

    Mask alive_ = false, begun_ = false, touching_ = false, embedded_ = false;
    std::array<Mode, lanes> mode_{};
    bool any_embedded_ = false, any_touching_ = false;

    T energy_at_start_{0.0}, potential_at_start_{0.0}, residual_{0.0}, exchanged_{0.0}, held_{0.0};
    bool is_elastic_;                   // the force is the stiffness times the depth:
    T deepest_{0.0}, depth_time_{0.0};  // m, m s
    T peak_{0.0}, impulse_{0.0};        // N, N s: else
    T peak_time_{0.0};                  // s
    T accepted_{0.0}, rejected_{0.0}, evaluations_{0.0}, max_steps_{0.0};

private:
    bool at_stop(int lane) const { return !(Lanes<T>::get(t_, lane) < Lanes<T>::get(stop_, lane)); }
    void begin_lane(int lane);
    void start_memory();
    Tally<double> tally_of(int lane) const;
    void set_tally(int lane, const Tally<double>& tally);
    void tell_controller(int lane);
    void set_mode(int lane, Mode mode);
    double force_of(int lane) const;  // N, normal
    void note_peak(int lane, double value, double t, T& peak);
    void set_running(int lane, bool running);

    std::array<Setup, lanes> setups_;
    std::array<bool, lanes> running_{}, is_new_{};
    std::array<arm3r_outcome, lanes> outcome_{};
    bool failed_ = false;
    struct Contacts {
        double count, events, first_contact, first_release, time, since, lost_at_edges;
    };
    std::array<Contacts, lanes> contacts_;
};

}  // namespace arm3r
