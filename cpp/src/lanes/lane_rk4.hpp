#pragma once
// Runs in lanes by RK4 (5.1). Steps are not split: each stage decides about contact, and contact changes are located
// afterwards on the cubic through the depths and their rates at both ends of the step. If a formula of time jumps at
// the end of a step, the step uses the values before the jump (5.8).

#include <utility>

#include "lanes/lane_run.hpp"

namespace arm3r {

template <class T, std::size_t N = state_size>
class LaneRk4 : public LaneRun<T, N> {
    using Base = LaneRun<T, N>;
    using Mask = typename Base::Mask;
    using Y = typename Base::Y;

public:
    explicit LaneRk4(const Setup& any_lane) : Base(any_lane), start_(this->t_) {
        if (this->plant_.acts_on_arm || senses_wall(this->plant_)) this->rhs_.force_mode = ContactForceMode::each_stage;
    }

    void load_lane(int lane, const Setup& setup) {
        Base::load_lane(lane, setup);
        Lanes<T>::set(start_, lane, setup.start);
        Lanes<T>::set(step_, lane, setup.solver.step);
        Lanes<T>::set(this->slack_, lane, 1e-6 * setup.solver.step);
        Lanes<T>::set(next_jump_, lane, next_jump(setup, setup.start));
        if (this->has_common_terms_)
            Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { this->rhs_.update_common_numbers(); });
    }

    void clear_lane(int lane) {
        Base::clear_lane(lane);
        Lanes<T>::set(start_, lane, this->t(lane));
        Lanes<T>::set(step_, lane, 0);  // a step does not move it
    }

    ARM3R_INLINE void start_steps() {
        Base::start_steps();
        count_whole_steps();
        is_whole_ = false;
    }
    // A whole step is not the last one of any lane.
    ARM3R_INLINE bool any_ended() const { return is_whole_ ? this->has_failed() : Base::any_ended(); }

    // How many lane runs with the same batch key a group steps together: a step is one chain of operations, and the
    // processor works on both at once.
    static constexpr int together = N == state_size && Base::lanes > 1 ? 2 : 1;

    ARM3R_INLINE static void step_by_stages(LaneRk4* const* runs, int count) {
        if (runs[0]->has_common_step()) step_of<Terms::common>(runs, count);
        else step_of<Terms::any>(runs, count);
    }
    ARM3R_INLINE bool take_step() {
        begin_step();
        moved_ = has_common_step() ? move<Terms::common>() : move<Terms::any>();
        return true;
    }
    ARM3R_INLINE void finish_step() {
        has_common_step() ? complete_step<Terms::common>(moved_) : complete_step<Terms::any>(moved_);
    }
    // The start of the last step, and the derivatives at both ends: a single run needs them for its dense output.
    double t0(int lane) const { return Lanes<T>::get(t0_, lane); }
    FullState y0(int lane) const { return Base::state_of(y0_, lane); }
    FullState f0(int lane) const { return Base::state_of(f0_, lane); }
    // The dense output of the last step, as the metrics see it.
    void fill_dense_output(int lane, DenseOutput& dense) const {
        dense.assign(hermite(t0(lane), this->h(lane), y0(lane), f0(lane), this->y(lane),
                             Base::state_of(derivative_at_end(), lane)));
    }
    double theta(int) const { return 1; }  // its end
    // Whether a formula may have jumped at the end of the last step, and the derivative there before the jump.
    bool may_jump_at_end(int lane) const {
        return (has_jump_ && Lanes<T>::is(jumps_, lane)) || (any_was_due_ && Lanes<T>::is(was_due_, lane));
    }
    FullState f1(int lane) {
        if (!may_jump_at_end(lane)) return Base::state_of(this->f_, lane);
        if (!std::exchange(has_evaluated_before_jump_, true))
            Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { f1_evaluated_ = evaluated_before_jump(); });
        return Base::state_of(f1_evaluated_, lane);
    }

protected:
    // ---- a step from values that are given

    // A signal over the step: the cubic through its values and rates at both ends, by its Bernstein coefficients.
    struct Cubic {
        T first, second, third, fourth;

        ARM3R_INLINE Cubic(const T& y0, const T& d0, const T& y1, const T& d1)
            : first(y0), second(y0 + (1.0 / 3) * d0), third(y1 - (1.0 / 3) * d1), fourth(y1) {}
        ARM3R_INLINE T low() const { return min(min(first, second), min(third, fourth)); }
        ARM3R_INLINE T high() const { return max(max(first, second), max(third, fourth)); }
        ARM3R_INLINE T mean() const { return 0.25 * ((first + fourth) + (second + third)); }
    };

    // The works of the torques are summed as the quadratures are.
    ARM3R_INLINE bool sums_work() const { return this->performance_.sums_work() && !this->plant_.holds_torque; }

    ARM3R_INLINE static Vec3<T> power_of(const Vec3<T>& tau, const Y& y) {
        return cwise_product(tau, Vec3<T>(y[3], y[4], y[5]));
    }

    // The state h seconds after y at t, with the derivative f0 there, of a lane run that steps alone: its stages stay in
    // registers, and the code holds a long derivative once.
    template <Terms terms>
    ARM3R_INLINE Y stepped_alone(const T& t, const Y& y, const Y& f0, const T& h, Vec3<T>& work) const {
        int stage = 1;
        const bool sums = sums_work();
        const auto derivative = [&](const T& now, const Y& at, Y& rates) ARM3R_INLINE_LAMBDA {
            Vec3<T> tau;
            this->rhs_.template derivative_at<terms>(now, at, rates, tau);
            ++stage;
            if (sums) work = plus(work, scaled(T(stage < 4 ? 2.0 : 1.0), power_of(tau, at)));
        };
        if constexpr (N != state_size) return rk4_step_in_a_loop(derivative, t, y, f0, h);
        else return rk4_step_of_first<terms == Terms::common ? common_moving : N>(derivative, t, y, f0, h);
    }
    // J: of each torque, from the sum of its powers over the stages, or of what is held.
    ARM3R_INLINE Vec3<T> work_in_step(const Vec3<T>& tau, const Y& y0, const Y& y1, const T& h,
                                      const Vec3<T>& sum) const {
        return sums_work() ? scaled(T(h / 6.0), sum) : Base::work_of_held(tau, y0, y1);
    }

    // Whether the contact may change in a step of h seconds from a to b, which ends at t1, the depth may have its greatest
    // value of the run within it, or the first contact ceases to be transient.
    ARM3R_INLINE Mask may_be_eventful(const Cubic& depth, const Indentation<T>& a, const Indentation<T>& b, const T& h,
                                      const T& t1, bool is_elastic) const {
        const auto& contact = this->contact_;
        Mask eventful = contact.may_cross(depth.low(), depth.high());
        if (!contact.any_touching()) return eventful;
        eventful = eventful || contact.ends_transient(t1);
        if (is_elastic) eventful = eventful || contact.may_peak(depth.high(), depth.fourth);
        if (this->plant_.wall.has_outline) eventful = eventful || (contact.touching() && is_near_edge(a, b, h));
        return eventful;
    }

    ARM3R_INLINE Mask is_near_edge(const Indentation<T>& a, const Indentation<T>& b, const T& h) const {
        const T third = (1.0 / 3) * h;  // the cubic's Bernstein coefficients lie within these sizes
        const T across1 = max(abs(a.across1), abs(b.across1)) + third * max(abs(a.slip1), abs(b.slip1));
        const T across2 = max(abs(a.across2), abs(b.across2)) + third * max(abs(a.slip2), abs(b.slip2));
        return across1 >= this->plant_.wall.half1 || across2 >= this->plant_.wall.half2;
    }

    T start_{0.0}, step_{0.0};
    // A step is whole if in no lane the run, its budget or a formula of time ends with it: then it is not tested for them.
    int whole_steps_ = 0;

private:
    ARM3R_INLINE bool has_common_step() const { return N == state_size && this->has_common_terms_; }

    template <Terms terms>
    ARM3R_INLINE static void step_of(LaneRk4* const* runs, int count) {
        for (int i = 0; i < count; ++i) runs[i]->begin_step();
        for (int i = 0; i < count; ++i) runs[i]->template next_stage<terms, 0>();
        for (int i = 0; i < count; ++i) runs[i]->template next_stage<terms, 1>();
        for (int i = 0; i < count; ++i) runs[i]->template next_stage<terms, 2>();
        for (int i = 0; i < count; ++i) {
            const Mask moved = runs[i]->template move<terms>();
            runs[i]->template complete_step<terms>(moved);
        }
    }

    ARM3R_INLINE void begin_step() {
        t0_ = this->t_;
        has_evaluated_before_jump_ = false;
        if (keeps_ends()) {
            y0_ = this->y_;
            f0_ = this->f_;
        }
        if (this->performance_.samples()) this->begin_segment();
        before_ = this->in_;
        t1_ = start_ + (this->accepted_ + 1.0) * step_;
        this->h_ = step_;
        is_whole_ = whole_steps_ > 0;
        if (is_whole_) --whole_steps_, forget_jumps();
        else limit_step();
        if (sums_work()) work_ = power_of(this->tau_, this->y_);
    }

    // The step ends with the run, or at a jump.
    ARM3R_INLINE void limit_step() {
        t1_ = min(this->stop_, t1_);
        const Mask is_last = t1_ >= this->stop_ - 1e-9 * step_;
        t1_ = select(is_last, this->stop_, t1_);
        this->h_ = select(is_last, T(this->stop_ - t0_), step_);
        jumps_ = next_jump_ <= t1_;
        has_jump_ = in_any_lane(jumps_);
        if (has_jump_) apply_jumps(t1_);
    }

    ARM3R_INLINE void forget_jumps() {
        if (has_jump_) jumps_ = has_jump_ = false;
    }

    // Counts the steps after this one that are surely whole.
    void count_whole_steps() {
        double count = std::numeric_limits<int>::max();
        for (int lane = 0; lane < Base::lanes; ++lane) {
            if (!this->is_running(lane)) continue;
            const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
            const double until = std::min(get(this->stop_), get(next_jump_));
            const double left = get(this->max_steps_) - get(this->accepted_);
            count = std::min({count, (until - this->t(lane)) / get(step_) - 2, left - 2});
        }
        whole_steps_ = int(std::max(count, 0.0));
    }

    // Stage n + 2 of 4, from the derivative of the one before; that of the first is known.
    template <Terms terms, int n>
    ARM3R_INLINE void next_stage() {
        const Y& before = n == 0 ? this->f_ : stages_[n == 0 ? 0 : n - 1];
        const T offset = n < 2 ? T(0.5 * this->h_) : this->h_;
        Y at;
        for (std::size_t i = 0; i < motion_size; ++i) at[i] = this->y_[i] + offset * before[i];
        Vec3<T> tau;
        this->rhs_.template derivative_at<terms>(t0_ + offset, at, stages_[n], tau);
        if (sums_work()) work_ = plus(work_, scaled(T(n < 2 ? 2.0 : 1.0), power_of(tau, at)));
    }

    // The state after the step (5.1).
    template <Terms terms>
    ARM3R_INLINE Y stepped() {
        const auto end = [this]<std::size_t moving>() ARM3R_INLINE_LAMBDA {
            return rk4_end<moving>(this->y_, this->f_, stages_[0], stages_[1], stages_[2], this->h_);
        };
        if constexpr (terms == Terms::any) return end.template operator()<N>();
        else if (this->rhs_.does_work()) return end.template operator()<common_moving>();
        else return end.template operator()<motion_size>();
    }
    // Moves to the end of the step, before the sample there. Returns the lanes that have moved.
    template <Terms terms>
    ARM3R_INLINE Mask move() {
        Y y1;
        if constexpr (together > 1) y1 = stepped<terms>();
        else y1 = stepped_alone<terms>(t0_, this->y_, this->f_, this->h_, work_);
        if (this->performance_.sums_work()) work_ = work_in_step(this->tau_, this->y_, y1, this->h_, work_);
        const Mask finite = Base::template is_finite<terms>(y1);
        const bool all_finite = in_all_lanes(finite);
        const Mask moved = all_finite ? this->active_ : finite && this->active_;
        if (this->performance_.sums_work()) this->performance_.add_work(work_, moved);
        // An empty lane is at the end of its run, where a step does not move it.
        if (all_finite) this->accept_all(t1_, y1);
        else this->accept(moved, t1_, y1), stop_diverged_lanes(finite);
        this->evaluations_ = this->evaluations_ + 4.0;
        if (keeps_ends()) store_end();
        if (has_jump_) this->rhs_.latest = T(infinite);
        this->template locate_tip<terms>();
        return moved;
    }

    // The sample, and what the step means for contact and metrics.
    template <Terms terms>
    ARM3R_INLINE void complete_step(const Mask& moved) {
        this->template sample_and_derive<terms>();
        if (this->performance_.samples() && any_jumps_at_end())
            Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { derive_before_jump(jumps_); });
        eventful_ = false;
        if (this->plant_.has_wall) detect_contact<terms>(moved);
        this->update_energy_balance();
        if (this->performance_.samples()) add_performance<terms>(moved && !eventful_, jumps_);
        this->check_lanes(!is_whole_);
    }

    // Applies the jumps up to the end of the step; a jump exactly at the end is left to the next step.
    [[gnu::noinline]] void apply_jumps(const T& t1) {
        for (int lane = 0; lane < Base::lanes; ++lane) {
            const double end = Lanes<T>::get(t1, lane);
            double jump = Lanes<T>::get(next_jump_, lane);
            if (jump > end) continue;
            for (; jump < end; jump = next_jump(this->setup(lane), jump)) {
            }
            if (jump == end) Lanes<T>::set(this->rhs_.latest, lane, just_before(end));
            Lanes<T>::set(next_jump_, lane, next_jump(this->setup(lane), end));
        }
        count_whole_steps();
    }

    // Stores the torque and the law of the step before a sample or an estimate changes them.
    ARM3R_INLINE void store_end() {
        was_due_ = this->is_controlled_ && this->is_due();
        any_was_due_ = in_any_lane(was_due_);
        torque_before_ = this->plant_.held_torque;
        assumed_before_ = this->plant_.controller.gains.assumed_stiffness;
        latest_before_ = this->rhs_.latest;
    }
    void swap_before() {
        std::swap(this->plant_.held_torque, torque_before_);
        std::swap(this->plant_.controller.gains.assumed_stiffness, assumed_before_);
        std::swap(this->rhs_.latest, latest_before_);
    }
    ARM3R_INLINE Y evaluated_before_jump() {
        Y f1{};
        swap_before();
        this->rhs_(this->t_, this->y_, f1);
        swap_before();
        return f1;
    }
    // The derivative at the end of the step, for the metrics: before a formula of time jumps, or a sample changes the
    // torque and with it the acceleration by M^-1 (tau_after - tau_before).
    ARM3R_INLINE void derive_before_jump(const Mask& jumps) {
        f1_before_ = this->f_;
        if (any_was_due_) {
            const Vec3<T> o = zero_vector<T>(), change = minus(this->plant_.held_torque, torque_before_);
            const Vec3<T> qdd = joint_acceleration(this->plant_.arm, this->p_, o, change, o);
            for (int i = 0; i < 3; ++i) f1_before_[3 + i] = f1_before_[3 + i] - select(was_due_, qdd[i], T(0.0));
        }
        if (!has_jump_) return;
        const Y before = evaluated_before_jump();
        for (std::size_t i = 0; i < N; ++i) f1_before_[i] = select(jumps, before[i], f1_before_[i]);
    }
    ARM3R_INLINE const Y& derivative_at_end() const { return any_jumps_at_end() ? f1_before_ : this->f_; }
    bool any_jumps_at_end() const { return has_jump_ || any_was_due_; }
    bool keeps_ends() const { return Base::lanes == 1 || this->keeps_dense_output_ || this->performance_.samples(); }

    [[gnu::noinline]] void stop_diverged_lanes(const Mask& finite) {
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (this->is_running(lane) && !Lanes<T>::is(finite, lane)) this->stop_lane(lane, ARM3R_RUN_DIVERGED);
    }

    template <Terms terms>
    ARM3R_INLINE void detect_contact(const Mask& moved) {
        const T& h = this->h_;
        const Cubic depth(before_.depth, T(h * before_.rate), this->in_.depth, T(h * this->in_.rate));
        auto& contact = this->contact_;
        const bool is_elastic = terms == Terms::common || contact.is_elastic();
        const Mask eventful = may_be_eventful(depth, before_, this->in_, h, this->t_, is_elastic);
        if (contact.any_touching()) {
            const Mask uneventful = contact.touching() && !eventful && moved;
            if (is_elastic) contact.add_elastic(uneventful, depth.fourth, depth.mean(), h, this->t_);
            else Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { add_damped(uneventful); });
        }
        eventful_ = eventful && moved;
        if (in_any_lane(eventful_)) resolve_contacts(eventful_);
    }

    ARM3R_INLINE void add_damped(const Mask& uneventful) {
        const T& h = this->h_;
        this->contact_.add_damped(
            uneventful, hermite_cubic(before_.depth, T(h * before_.rate), this->in_.depth, T(h * this->in_.rate)), t0_,
            h, this->t_);
    }

    [[gnu::noinline]] void resolve_contacts(const Mask& eventful) {
        bool is_stale = false;
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (this->is_running(lane) && Lanes<T>::is(eventful, lane) && resolve_lane(lane)) {
                Lanes<T>::set(this->evaluations_, lane, Lanes<T>::get(this->evaluations_, lane) + 1);
                is_stale = true;
            }
        if (is_stale) this->reevaluate();
    }

    ContactSignals<double> signals_of(int lane) const {
        const Indentation<T>&a = before_, &b = this->in_;
        const double h = this->h(lane);
        const auto cubic = [&](const T& y0, const T& d0, const T& y1, const T& d1) {
            const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
            return hermite_cubic(get(y0), h * get(d0), get(y1), h * get(d1));
        };
        return {cubic(a.depth, a.rate, b.depth, b.rate), cubic(a.across1, a.slip1, b.across1, b.slip1),
                cubic(a.across2, a.slip2, b.across2, b.slip2)};
    }

    bool resolve_lane(int lane) {
        const Wall<double>& wall = this->setup(lane).plant.wall;
        const double h = this->h(lane), t0 = Lanes<T>::get(t0_, lane);
        const double resolution = event_resolution(this->t(lane), h);
        const ContactSignals<double> signals = signals_of(lane);
        DenseOutput dense;
        if (this->performance_.samples()) fill_dense_output(lane, dense);
        double from = 0;
        bool is_stale = false;
        while (const auto crossing = next_crossing(wall, signals, from, this->mode(lane), resolution)) {
            this->add_contact(lane, signals.depth, t0, from, crossing->theta);
            if (this->performance_.samples()) add_lane_performance(lane, dense, from, crossing->theta);
            from = crossing->theta;
            const ContactChange change = this->change_of(lane, signals, from, t0 + from * h, crossing->next);
            this->change_mode(lane, change);
            is_stale = true;
            if (this->outcome(lane) != ARM3R_RUN_OK || from >= 1) break;
        }
        this->add_contact(lane, signals.depth, t0, from, 1.0);
        if (this->performance_.samples() && from < 1) add_lane_performance(lane, dense, from, 1.0);
        return is_stale;
    }

    // ---- performance

    // Handles the lanes alone in which the reference has a knot within the step, and takes them out of `whole`.
    [[gnu::noinline]] void split_at_knots(Mask& whole) {
        for (int lane = 0; lane < Base::lanes; ++lane) {
            const double knot = Lanes<T>::get(this->next_knot_, lane), end = this->t(lane);
            if (!(knot <= end)) continue;
            Lanes<T>::set(this->next_knot_, lane, this->next_metric_knot(lane, end));
            if (!(knot < slightly_before(end)) || !Lanes<T>::is(whole, lane)) continue;
            add_lane_performance(lane, this->dense_output(*this, lane), 0, 1);
            Lanes<T>::mark(whole, lane, false);
        }
    }

    // The step as one segment in the lanes in which the contact has not changed.
    template <Terms terms>
    ARM3R_INLINE void add_performance(Mask whole, const Mask& jumps) {
        this->performance_.continue_motion(whole && !jumps && this->next_knot_ > this->t_);
        if (in_any_lane(this->next_knot_ <= this->t_)) split_at_knots(whole);
        if (this->plant_.holds_torque && !this->performance_.tracked().motion()) return end_segment<trapezoid>(whole);
        Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { sample_midpoint<terms>(); });
        end_segment<simpson>(whole);
    }

    template <const auto& rule>
    ARM3R_INLINE void end_segment(const Mask& whole) {
        Mask unresolved = false;
        this->performance_.template end<rule>(this->instant(), this->h_, whole, unresolved);
        if (in_any_lane(unresolved)) this->refine_segment(*this, rule, unresolved, this->t_);
    }

    // A part of the step, in the lane's present contact mode, from knot to knot of the reference.
    void add_lane_performance(int lane, const DenseOutput& dense, double a, double b) {
        this->visit_step(lane, dense, this->t(lane), [&](StepView view) {
            const double latest = view.latest, end = slightly_before(dense.t0 + b * dense.h);
            double knot = this->next_metric_knot(lane, dense.t0 + a * dense.h);
            for (; knot < end; knot = this->next_metric_knot(lane, knot)) {
                const double theta = (knot - dense.t0) / dense.h;
                view.latest = slightly_before(knot);
                this->performance_.add(lane, simpson, view, a, theta);
                view.earliest = knot, a = theta;
            }
            view.latest = latest;
            this->performance_.add(lane, simpson, view, a, b);
        });
    }

    // The midpoint lies on the cubic through both ends. With common terms nothing of the wall turns, and the force needs no
    // more than the depth.
    template <Terms terms>
    ARM3R_INLINE void sample_midpoint() {
        const T &h = this->h_, t = t0_ + 0.5 * h;
        const Y& f1 = derivative_at_end();
        Y y;
        [[maybe_unused]] Y rates;
        for (std::size_t i = 0; i < N; ++i) y[i] = 0.5 * (y0_[i] + this->y_[i]) + (0.125 * h) * (f0_[i] - f1[i]);
        const Pose<T> p = this->rhs_.pose_near(y);
        const Vec3<T> q(y[0], y[1], y[2]), qd(y[3], y[4], y[5]);
        WallState<T> wall = no_wall<T>();
        Indentation<T> in{};
        if (this->samples_wall() || (N != state_size && this->plant_.has_wall)) {
            if constexpr (terms == Terms::common) {
                wall = even_wall_at(this->plant_.wall, t);
                in.depth = indentation_at_rest(this->plant_.wall, wall, tip_position(this->plant_.arm, p)).depth;
            } else {
                wall = wall_at(this->plant_.wall, t);
                in = tip_indentation(this->plant_, wall, p, qd);
            }
        }
        Vec3<T> tau;
        if (this->performance_.tracked().limits && !this->plant_.holds_torque) {
            if constexpr (N == state_size) tau = torque_without_memory(this->plant_, q, p);
            else this->rhs_.derivative(t, wall, p, in, y, rates, tau);
        }
        this->performance_.sample(1, {t, p, wall, in, tau});
    }

    Mask eventful_ = false;  // lanes whose contact may have changed in the step

    T t0_{0.0}, t1_{0.0}, next_jump_{infinite};
    bool is_whole_ = false;
    bool has_jump_ = false;
    Mask jumps_ = false;
    std::array<Y, 3> stages_{};  // the derivatives of the second, third and fourth
    Mask was_due_ = false;
    bool any_was_due_ = false;
    Y y0_{}, f0_{}, f1_before_{};
    Vec3<T> torque_before_, work_;  // N m; J, of each torque in the step
    T assumed_before_{0.0}, latest_before_{infinite};
    Indentation<T> before_{};
    Mask moved_ = false;  // in the last step
    Y f1_evaluated_{};
    bool has_evaluated_before_jump_ = false;
};

}  // namespace arm3r
