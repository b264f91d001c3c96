#pragma once
// Runs in lanes, each with the same bits as alone: T = double is one run, Pack<N> are N. This class has what all
// methods share: time, state, contact, energy balance and metrics of every lane. Rare events (a change of contact, the
// end of a run) are handled lane by lane in doubles, by the same functions for every T.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/widths.hpp"
#include "control/compiled_laws.hpp"
#include "control/continuous_inputs.hpp"
#include "control/sampled_controller.hpp"
#include "lanes/lane_contact.hpp"
#include "lanes/lane_performance.hpp"
#include "record/energy_balance.hpp"
#include "setup/time_instants.hpp"

namespace arm3r {

// The choices that all runs of a lane group share, so that terms that no lane needs are not computed and every lane has
// the same rounding.
struct BatchKey {
    SolverMethod method;
    int order;  // of taylor
    bool may_be_ill_conditioned;
    int knots;  // of the wall's table
    PlantChoices plant;
    ArmChoices arm, model;
    ElbowChoices elbow, elbow_of_model;
    WallChoices wall;
    ContactChoices contact;
    ControllerChoices controller;
    ReferenceChoices reference;
    SamplingChoices sampling;
    SensorChoices sensors;
    ObserverChoices observer;
    EstimationChoices estimation;
    bool has_external_force;

    bool operator==(const BatchKey&) const = default;
};

BatchKey batch_key_of(const Setup& setup);

// The resolution in theta of an instant near t in a step of h.
template <class T>
ARM3R_INLINE T event_resolution(const T& t, const T& h) {
    return max(T(event_time_tolerance), T(4 * std::numeric_limits<double>::epsilon() * abs(t))) / h;
}

// Where the wall acts on the motion: wherever the tip is inside, as each stage of a step decides; in contact; or as the
// contact mode says, which the steps then end at.
enum class ContactFelt { inside, in_contact, by_mode };

// N: state_size, or full_size where a continuous controller remembers something.
template <class T, std::size_t N = state_size>
class LaneRun {
public:
    using Mask = typename Lanes<T>::Mask;
    using Y = State<T, N>;
    static constexpr int lanes = Lanes<T>::count;
    static constexpr bool completes_before_sample = false;  // a step, with its contact and metrics

    explicit LaneRun(const Setup& any_lane, ContactFelt felt = ContactFelt::inside);
    LaneRun(const LaneRun&) = delete;  // an empty lane points to rest_

    // Loads a run into a lane; the setup must stay where it is until the next one is loaded. The lanes loaded since the
    // last start (run_loop.hpp) start with the next one.
    void load_lane(int lane, const Setup& setup);
    // The lanes that were loaded stand at their start, before the first sample: contact, energy and memory.
    ARM3R_INLINE void place_lanes() {
        observe_outlined();
        for (int lane = 0; lane < lanes; ++lane)
            if (is_new_[lane]) start_lane(lane);
        if (N == full_size) start_memory();
    }
    // Their first sample, and the derivative with it.
    ARM3R_INLINE void start_steps() {
        started_ = active_;
        if (is_controlled_ || N == full_size || contact_.any_embedded()) observe_outlined();
        is_new_.fill(false);
    }
    // A single run that was assigned to this one continues here as it would there, with a copy of its setup, once its
    // observer is set.
    void set_setup(const Setup& setup) { setups_[0] = &setup; }
    // Of a single run: whether it stands at a sample that has not been taken, and continues without it.
    bool stands_at_sample() const { return any(sampled_.next_sample() <= t_ + slack_); }
    void skip_sample() { started_ = false; }

    // Keeps what rows need: the dense output of a step, and what the controller has measured.
    void keep_for_rows() {
        keeps_dense_output_ = true;
        sampled_.keep_measurements();
    }

    // Called before each change of contact of a lane.
    void set_observer(std::function<void(int lane, const ContactChange&)> changes) { on_change_ = std::move(changes); }
    // A user's law, for a run with a single lane.
    void set_user_law(const UserLaw& law) { sampled_.user = law; }
    std::string error_message() const { return sampled_.error_message(); }
    ControllerState<double> controller_state(int lane) const { return lane_of(sampled_.controller_state(), lane); }
    // Calls a law as the present sample would, without an effect on the run.
    void preview(const UserLaw& law) const {
        SampledController<T> rehearsal = sampled_;
        rehearsal.user = law;
        Vec3<T> held;
        PlantOutput<T> now = plant_output();
        rehearsal.update(true, slack_, plant_.arm, now, held);
    }
    ContinuousInputs inputs(int lane) const {
        return {Lanes<T>::get(rhs_.contact, lane), Lanes<T>::get(rhs_.force_phase, lane)};
    }
    Vec3<double> torque(int lane) const {
        const Vec3<T>& tau = plant_.held_torque;
        return {Lanes<T>::get(tau[0], lane), Lanes<T>::get(tau[1], lane), Lanes<T>::get(tau[2], lane)};
    }

    void clear_lane(int lane);
    bool is_running(int lane) const { return running_[lane]; }
    bool any_running() const { return any_running_; }
    bool has_ended(int lane) const { return running_[lane] && (outcome_[lane] != ARM3R_RUN_OK || at_stop(lane)); }
    ARM3R_INLINE bool any_ended() const { return failed_ || in_any_lane(active_ && t_ >= stop_); }
    bool has_failed() const { return failed_; }
    void clear_failures() { failed_ = false; }

    void stop_lane(int lane, arm3r_outcome outcome) {
        if (outcome_[lane] == ARM3R_RUN_OK) outcome_[lane] = outcome;
        failed_ = true;
    }
    Metrics metrics(int lane) const;
    EnergyTotals totals(int lane) const {
        return balance_.totals(lane, setups_[lane]->plant, contact_.peak(lane).force, Lanes<T>::get(accepted_, lane));
    }
    Steps steps(int lane) const {
        const auto count = [&](const T& x) { return std::int64_t(Lanes<T>::get(x, lane)); };
        return {count(accepted_), count(rejected_), count(evaluations_)};
    }

    // One lane, in doubles.
    double t(int lane) const { return Lanes<T>::get(t_, lane); }
    double h(int lane) const { return Lanes<T>::get(h_, lane); }
    FullState y(int lane) const { return state_of(y_, lane); }
    ContactMode mode(int lane) const { return contact_.mode(lane); }
    double energy_at_start(int lane) const { return balance_.energy_at_start(lane); }
    arm3r_outcome outcome(int lane) const { return outcome_[lane]; }

protected:
    LaneRun& operator=(const LaneRun&) = default;

    // The lanes whose run goes on.
    ARM3R_INLINE Mask goes_on() const {
        if (!failed_) return active_;
        Mask going = active_;
        for (int lane = 0; lane < lanes; ++lane)
            if (outcome_[lane] != ARM3R_RUN_OK) Lanes<T>::mark(going, lane, false);
        return going;
    }
    // Stops the lanes for one reason.
    [[gnu::noinline]] void stop_lanes(const Mask& here, arm3r_outcome outcome) {
        for (int lane = 0; lane < lanes; ++lane)
            if (running_[lane] && Lanes<T>::is(here, lane)) stop_lane(lane, outcome);
    }

    static FullState state_of(const Y& y, int lane) {
        FullState one{};
        for (std::size_t i = 0; i < N; ++i) one[i] = Lanes<T>::get(y[i], lane);
        return one;
    }

    // ---- one instant

    // Evaluates pose, wall, indentation, derivative and energies at the present state.
    template <Terms terms = Terms::any>
    ARM3R_INLINE void observe() {
        locate_tip<terms>();
        sample_and_derive<terms>();
    }
    void observe_outlined();

    // The part of it before the sample that is due.
    template <Terms terms = Terms::any>
    ARM3R_INLINE void locate_tip() {
        if (needs_derivative_) {
            rhs_.begin_step(y_);
            p_ = rhs_.pose_near(y_);
        } else {
            p_ = pose(Vec3<T>(y_[0], y_[1], y_[2]));
        }
        if (plant_.has_wall) locate_wall<terms>(Vec3<T>(y_[3], y_[4], y_[5]));
    }
    template <Terms terms = Terms::any>
    ARM3R_INLINE void sample_and_derive() {
        if (is_controlled_ && in_any_lane(is_due())) update_controller(is_due());
        if (needs_derivative_) derive<terms>();
        else if (performance_.is_on()) tau_ = torque_without_memory(plant_, Vec3<T>(y_[0], y_[1], y_[2]), p_);
        compute_energies();
    }
    ARM3R_INLINE void compute_energies() {
        kinetic_ = kinetic_energy(plant_.arm, p_, Vec3<T>(y_[3], y_[4], y_[5]));
        potential_ = potential_energy_of_pose(plant_.arm, p_);
    }

    // With common terms nothing else of wall and indentation is needed.
    template <Terms terms>
    ARM3R_INLINE void locate_wall(const Vec3<T>& qd) {
        if constexpr (terms == Terms::common) {
            const WallState<T> now = even_wall_at(plant_.wall, t_);
            wall_.position = now.position, wall_.velocity = now.velocity;
            set_indentation(plant_.wall, now, tip_position(plant_.arm, p_), tip_velocity(plant_.arm, p_, qd), in_);
        } else {
            wall_ = wall_at(plant_.wall, t_);
            in_ = tip_indentation(plant_, wall_, p_, qd);
        }
    }

    // All lanes by the same formula, whatever asks for it. With a controller's memory the code is long, and is compiled once.
    template <Terms terms = Terms::any>
    ARM3R_INLINE void derive() {
        if constexpr (N != state_size) {
            Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { rhs_.derivative(t_, wall_, p_, in_, y_, f_, tau_); });
        } else {
            if (terms == Terms::common || has_common_terms_)
                rhs_.common_derivative(min(t_, rhs_.latest), p_, y_, f_, tau_);
            else if constexpr (terms == Terms::any) rhs_.derivative(t_, wall_, p_, in_, y_, f_, tau_);
        }
    }

    // ---- digital controllers

    // A step ends at the next event of the sampled controllers or at the end of the run.
    ARM3R_INLINE T next_instant() const { return is_controlled_ ? min(stop_, sampled_.next()) : stop_; }

    ARM3R_INLINE Mask is_due() const { return started_ && sampled_.next() <= t_ + slack_; }
    void update_controller(const Mask& due);

    ARM3R_INLINE PlantOutput<T> plant_output() const {
        return arm3r::plant_output(plant_, wall_, t_, y_, p_, plant_.has_wall ? force_on_tip() : zero_vector<T>());
    }

    // The contact force at this instant, as far as the mode decides, also where that has not changed yet.
    ARM3R_INLINE Vec3<T> force_on_tip() const {
        const bool by_mode = felt_ == ContactFelt::by_mode;
        Mask pressed = in_.depth > T(0.0) && (by_mode ? contact_.touching() : !contact_.embedded());
        if (!by_mode && plant_.wall.has_outline) pressed = pressed && inside_outline(plant_.wall, in_) >= T(0.0);
        if (!in_any_lane(pressed)) return zero_vector<T>();
        return only_where(pressed, contact_force(plant_.wall, wall_, contact_.law(), in_, Clamping::clamped)).on_tip;
    }

    // ---- performance

    ARM3R_INLINE LaneInstant<T> instant() const { return {t_, p_, wall_, in_, tau_}; }
    ARM3R_INLINE void begin_segment() {
        const T& force_phase = sampled_.is_on() ? sampled_.controller_state().force_phase : rhs_.force_phase;
        performance_.begin(instant(), contact_.touching(), force_phase);
    }

    // Whether a sample within a step needs the wall: for the force, or for the normal of a plate that turns, along which a
    // force law has no path error.
    ARM3R_INLINE bool samples_wall() const {
        return plant_.has_wall && (performance_.tracked().force || plant_.wall.rotation != Rotation::none);
    }

    // J: of each held torque, in a step from y0 to y1.
    ARM3R_INLINE static Vec3<T> work_of_held(const Vec3<T>& tau, const Y& y0, const Y& y1) {
        return {tau[0] * (y1[0] - y0[0]), tau[1] * (y1[1] - y0[1]), tau[2] * (y1[2] - y0[2])};
    }

    // The next instant after t at which the reference that metrics compare with has another formula, whether these are
    // wanted or not: steps end there.
    double next_metric_knot(int lane, double t) const {
        const Controller<double>& law = setups_[lane]->controller();
        return tracks_force(law.type) || tracks_path(law.type) ? next_knot(law.reference, t) : infinite;
    }

    // The step of one lane in doubles, as a function of theta; it ends at t1, and the torque of a sampled controller is
    // that of the step.
    template <class Visit>
    void visit_step(int lane, const DenseOutput& dense, double t1, Visit visit) const {
        const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
        const Setup* setup = setups_[lane];
        std::optional<Setup> of_estimate;
        if (asks_estimator(plant_.controller)) {
            setup = &of_estimate.emplace(*setup);
            of_estimate->plant.controller.gains.assumed_stiffness = get(plant_.controller.gains.assumed_stiffness);
        }
        const Vec3<T>& tau = performance_.torque_at_start();
        const Vec3<double> held{get(tau[0]), get(tau[1]), get(tau[2])};
        const ContinuousInputs inputs = this->inputs(lane);
        const double phase = sampled_.is_on() ? get(performance_.force_phase()) : inputs.force_phase;
        visit(StepView{*setup, dense, mode(lane) == ContactMode::contact, inputs.contact, phase,
                       plant_.holds_torque ? &held : nullptr, slightly_before(t1)});
    }

    template <class Steps>
    static DenseOutput dense_output(const Steps& steps, int lane) {
        DenseOutput dense;
        steps.fill_dense_output(lane, dense);
        return dense;
    }

    // Refines the segment up to t1 in the lanes in which it is unresolved; `steps` has the dense output of the step, and
    // the theta at which it ends.
    template <class Steps, std::size_t n>
    [[gnu::noinline]] void refine_segment(const Steps& steps, const Rule<n>& rule, const Mask& unresolved,
                                          const T& t1) {
        for (int lane = 0; lane < lanes; ++lane)
            if (Lanes<T>::is(unresolved, lane))
                visit_step(lane, dense_output(steps, lane), Lanes<T>::get(t1, lane), [&](StepView view) {
                    view.pressed = performance_.was_touching(lane) && mode(lane) != ContactMode::separated;
                    performance_.refine(lane, rule, view, steps.theta(lane));
                });
    }

    ARM3R_INLINE T stored(const Indentation<T>& in) const {
        if (!plant_.acts_on_arm) return T(0.0);
        const Contact<T>& law = contact_.law();
        const Mask pressed = (contact_.touching() || contact_.separated()) && in.depth > T(0.0);
        if (is_spring(law.law)) return select(pressed, T(0.5 * law.stiffness[0] * in.depth * in.depth), T(0.0));
        return select(pressed, T(normal_force_law(law, in).stored + stored_tangential(law, in)), T(0.0));
    }

    // ---- after a step

    // Moves to `t1`, `y1` where `moved`.
    ARM3R_INLINE void accept(const Mask& moved, const T& t1, const Y& y1) {
        if (in_all_lanes(moved)) return accept_all(t1, y1);
        for (std::size_t i = 0; i < N; ++i) y_[i] = select(moved, y1[i], y_[i]);
        drop_tiny_rates(y_);
        t_ = select(moved, t1, t_);
        accepted_ = accepted_ + select(moved, T(1.0), T(0.0));
    }
    ARM3R_INLINE void accept_all(const T& t1, const Y& y1) {
        y_ = y1;
        drop_tiny_rates(y_);
        t_ = t1;
        accepted_ = accepted_ + 1.0;
    }

    ARM3R_INLINE static void drop_tiny_rates(Y& y) {
        for (std::size_t i = 3; i < motion_size; ++i) y[i] = without_tiny_rate(y[i]);
    }

    template <Terms terms = Terms::any>
    ARM3R_INLINE static Mask is_finite(const Y& y) {
        T sum = y[0];
        for (std::size_t i = 1; i < (terms == Terms::common ? common_moving : N); ++i) sum = sum + y[i];
        return sum * 0.0 == T(0.0);
    }

    ARM3R_INLINE void update_energy_balance() { balance_.update(Energies<T>{kinetic_, potential_, stored(in_)}, y_); }

    ARM3R_INLINE void check_lanes(bool may_end_budget = true) {
        Mask bad = is_out_of_range(y_);
        if (may_be_ill_conditioned_) bad = bad || !is_well_conditioned(plant_.arm, p_);
        if (may_end_budget) bad = bad || (accepted_ >= max_steps_ && t_ < stop_);
        bad = bad && active_;
        if (in_any_lane(bad)) fail_lanes(bad);
    }

    // ---- contact

    // Adds the contact from a to b of the step that began at t0.
    void add_contact(int lane, const Polynomial<double>& depth, double t0, double a, double b) {
        contact_.add(lane, setups_[lane]->plant.contact, depth, {t0, h(lane), a, b});
    }
    void change_mode(int lane, const ContactChange& change);

    const Setup& setup(int lane) const { return *setups_[lane]; }
    Indentation<double> indentation_of(int lane) const;

    // Evaluates the derivative again after change_mode().
    void reevaluate();

    // The change to `next` at theta in the step, which is at t seconds, with the values of the signals there.
    ContactChange change_of(int lane, const ContactSignals<double>& signals, double theta, double t,
                            ContactMode next) const {
        const Indentation<double> in{value(signals.depth, theta),   0, value(signals.across1, theta),
                                     value(signals.across2, theta), 0, 0};
        return change_at(setups_[lane]->plant, in, theta, t, mode(lane), next);
    }

    // The change of a lane at theta, at t seconds, where the tip meets the face or leaves it.
    ContactChange change_to_other(int lane, const Indentation<double>& in, double theta, double t) const {
        const Plant<double>& plant = setups_[lane]->plant;
        const bool within =
            !plant.wall.has_outline || (abs(in.across1) <= plant.wall.half1 && abs(in.across2) <= plant.wall.half2);
        const ContactMode met = within ? ContactMode::contact : ContactMode::embedded;
        return change_at(plant, in, theta, t, mode(lane), mode(lane) == ContactMode::free ? met : ContactMode::free);
    }

    void fail_lanes(const Mask& bad);

    Plant<T>
        // its contact is the one that acts on the motion, unless the contact mode says where that acts: without stiffness
        // in embedded lanes, and, where only contact is felt, in free ones
        plant_;
    RightHandSide<T, T> rhs_;
    bool has_common_terms_;
    ContactFelt felt_;
    bool needs_derivative_ = true, may_be_ill_conditioned_;
    bool keeps_dense_output_ = false;

    bool is_controlled_;
    SampledController<T> sampled_;
    LaneContact<T> contact_;
    EnergyBalance<T> balance_;
    LanePerformance<T> performance_;

    T next_knot_{infinite};                       // s, of the reference, for the metrics
    T t_{0.0}, h_{0.0}, stop_{0.0}, slack_{0.0};  // slack: the tolerance with which an instant counts as reached, s
    Y y_{}, f_{};
    Pose<T> p_;
    WallState<T> wall_ = no_wall<T>();
    Indentation<T> in_{};
    Vec3<T> tau_ = zero_vector<T>();   // N m, applied
    T kinetic_{0.0}, potential_{0.0};  // J; potential_: of the pose

    Mask active_ = false, started_ = false;
    T accepted_{0.0}, rejected_{0.0}, evaluations_{0.0}, max_steps_{0.0};

    std::array<bool, lanes> is_new_{};  // loaded since the last start

private:
    bool at_stop(int lane) const { return !(Lanes<T>::get(t_, lane) < Lanes<T>::get(stop_, lane)); }
    void start_lane(int lane);
    void start_memory();
    void update_inputs(int lane);
    void set_mode(int lane, ContactMode mode);
    double force_of(int lane) const;  // N, normal, in contact
    bool would_pull(int lane) const;
    void set_running(int lane, bool running);

    Setup rest_;  // a run of no duration, at rest: in empty lanes
    std::array<const Setup*, lanes> setups_{};
    std::array<bool, lanes> running_{};
    bool any_running_ = false;
    std::array<arm3r_outcome, lanes> outcome_{};
    bool failed_ = false;
    std::function<void(int, const ContactChange&)> on_change_;
};

}  // namespace arm3r
