#pragma once
// Runs in lanes by Taylor series (5.5): each lane has its own step, which ends where its contact changes.

#include "integrate/taylor.hpp"
#include "lanes/lane_run.hpp"

namespace arm3r {

template <class T>
class LaneTaylor : public LaneRun<T> {
    using Base = LaneRun<T>;
    using Mask = typename Base::Mask;
    using Y = typename Base::Y;

public:
    explicit LaneTaylor(const Setup& any_lane)
        : Base(any_lane, ContactFelt::in_contact),
          order_(batch_key_of(any_lane).order),
          free_kernel_(kernel_of(any_lane.plant, false)),
          pressed_kernel_(kernel_of(any_lane.plant, true)) {
        this->needs_derivative_ = false;
    }

    void load_lane(int lane, const Setup& setup) {
        Base::load_lane(lane, setup);
        Lanes<T>::set(tol_, lane, setup.solver.tol);
        Lanes<T>::set(max_step_, lane, setup.solver.max_step);
        Lanes<T>::set(this->slack_, lane, setup.clock_rounding());
    }

    static constexpr int together = 1;  // lane runs that a group steps together

    ARM3R_INLINE bool take_step() {
        t0_ = this->t_;
        if (this->performance_.samples()) this->begin_segment();
        const bool pressed = this->plant_.acts_on_arm && this->contact_.any_touching();
        expand(pressed ? pressed_kernel_ : free_kernel_, this->plant_, t0_, this->y_, this->p_, order_, series_);
        T wanted = min(step_of(series_, tol_), max_step_);
        if (this->plant_.arm.has_dry_friction) slow_before_friction(wanted);
        const T until = min(this->next_instant(), this->next_knot_), rest = until - t0_;
        is_last_ = wanted >= rest;
        this->h_ = select(is_last_, rest, wanted);
        const Mask finite = is_finite(series_), stalls = !is_last_ && this->h_ < min_step(t0_);
        const Mask moved = this->active_ && finite && !stalls;
        if (in_any_lane(this->active_ && !moved)) stop_failed_lanes(finite, stalls);

        crosses_ = false;
        theta_ = T(1.0);
        if (this->plant_.has_wall) detect_contact(moved);
        T h = this->h_, t1 = select(is_last_, until, T(t0_ + h));
        if (crosses_) {
            h = select(theta_ < T(1.0), T(theta_ * h), h);
            t1 = select(theta_ < T(1.0), T(t0_ + h), t1);
        }
        const Y y1 = state_after(series_, h);
        if (this->performance_.sums_work()) add_work(moved, y1, h);
        this->accept(moved, t1, y1);
        this->evaluations_ = this->evaluations_ + select(moved, T(double(order_)), T(0.0));
        this->locate_tip();
        moved_ = moved, moved_by_ = h;
        return true;
    }
    ARM3R_INLINE void finish_step() {
        this->sample_and_derive();
        if (crosses_) apply_changes();
        if (in_any_lane(this->next_knot_ <= this->t_)) pass_knots();
        this->update_energy_balance();
        if (this->performance_.samples()) add_performance(moved_, moved_by_);
        this->check_lanes();
    }
    // The dense output of the last step.
    void fill_dense_output(int lane, DenseOutput& dense) const {
        dense.t0 = Lanes<T>::get(t0_, lane);
        dense.h = this->h(lane);
        dense.order = order_;
        dense.size = state_size;
        for (int i = 0; i <= order_; ++i)
            for (std::size_t j = 0; j < state_size; ++j) dense.c[i][j] = Lanes<T>::get(series_.c[i][j], lane);
    }
    double theta(int lane) const { return Lanes<T>::get(theta_, lane); }
    // Whether a sample may have changed the torque at the end of the last step.
    bool may_jump_at_end(int lane) const { return this->is_controlled_ && Lanes<T>::is(is_last_, lane); }

private:
    enum Signal : std::size_t { depth = state_size, across1, across2, work1 };

    ARM3R_INLINE static T min_step(const T& t) {
        return 16 * std::numeric_limits<double>::epsilon() * max(abs(t), T(1e-3));
    }

    // Far from rest dry friction is nearly constant, and no coefficient shows how suddenly it reverses where a joint
    // stops. So no step may change a rate by more than half of it plus the friction velocity (5.5).
    ARM3R_INLINE void slow_before_friction(T& h) const {
        constexpr int halvings = 64;
        for (int n = 0; n < halvings; ++n) {
            Mask is_long = false;
            for (std::size_t i = 3; i < motion_size; ++i) {
                T power(1.0), change(0.0);
                for (int k = 1; k <= order_; ++k) {
                    power = power * h;
                    change = change + abs(series_.c[k][i]) * power;
                }
                is_long = is_long || change > 0.5 * abs(series_.c[0][i]) + this->plant_.arm.friction_velocity;
            }
            if (!in_any_lane(is_long)) return;
            h = select(is_long, T(0.5 * h), h);
        }
    }

    [[gnu::noinline]] void stop_failed_lanes(const Mask& finite, const Mask& stalls) {
        for (int lane = 0; lane < Base::lanes; ++lane) {
            if (!this->is_running(lane)) continue;
            if (!Lanes<T>::is(finite, lane)) this->stop_lane(lane, ARM3R_RUN_DIVERGED);
            else if (Lanes<T>::is(stalls, lane)) this->stop_lane(lane, ARM3R_RUN_STEP_COLLAPSE);
        }
    }

    // ---- contact

    ARM3R_INLINE void detect_contact(const Mask& moved) {
        Polynomial<T> over_step{order_, {}};
        T power(1.0), low(0.0), high(0.0), end(0.0), mean(0.0);
        for (int i = 0; i <= order_; ++i, power = power * this->h_) {
            const T term = series_.c[i][depth] * power;
            over_step.c[i] = term;
            low = low + (i == 0 ? term : min(term, T(0.0)));
            high = high + (i == 0 ? term : max(term, T(0.0)));
            end = end + term;
            mean = mean + reciprocals[i + 1] * term;
        }
        auto& contact = this->contact_;
        Mask eventful = moved && is_eventful(low, high, high, end), alone = false;
        Coefficients<T> b;
        if (in_any_lane(eventful)) {
            b = bernstein(over_step);
            eventful = eventful && is_eventful_by_bernstein(b);
        }
        if (contact.any_touching()) {
            alone = moved && contact.ends_transient(T(t0_ + this->h_));
            if (this->plant_.wall.has_outline) alone = alone || (moved && contact.touching() && is_near_edge());
            const Mask uneventful = contact.touching() && !eventful && !alone && moved;
            contact.add_elastic(uneventful, end, mean, this->h_, T(t0_ + this->h_));
        }
        eventful = eventful && !alone;
        if (in_any_lane(eventful))
            Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { resolve_once(eventful, over_step, b, high); });
        eventful = eventful || alone;
        if (in_any_lane(eventful)) resolve_contacts(eventful);
    }

    // Whether a depth between low and high, which is below `before_end` except at its end, may change the contact or
    // its maximum.
    ARM3R_INLINE Mask is_eventful(const T& low, const T& high, const T& before_end, const T& end) const {
        return this->contact_.may_cross(low, high) || this->contact_.may_peak(before_end, end);
    }

    // The same with the sharper bounds of the Bernstein coefficients.
    ARM3R_INLINE Mask is_eventful_by_bernstein(const Coefficients<T>& b) const {
        T low = min(b[0], b[order_]), before_end = b[0];
        for (int i = 1; i < order_; ++i) {
            low = min(low, b[i]);
            before_end = max(before_end, b[i]);
        }
        return is_eventful(low, max(before_end, b[order_]), before_end, b[order_]);
    }

    ARM3R_INLINE Mask is_near_edge() const {
        return max_abs_of(across1) >= this->plant_.wall.half1 || max_abs_of(across2) >= this->plant_.wall.half2;
    }

    ARM3R_INLINE T max_abs_of(Signal signal) const {
        T power(1.0), most = abs(series_.c[0][signal]);
        for (int i = 1; i <= order_; ++i) {
            power = power * this->h_;
            most = most + abs(series_.c[i][signal]) * power;
        }
        return most;
    }

    // What the depth does in a step of each lane.
    struct DepthEvents {
        Mask crosses;  // It crosses zero once, where g does: g is the depth then, with the other sign for a free tip.
        Mask turns;    // It has one maximum, where g crosses zero: g is its rate then.
        Mask has_maximum;  // The largest depth of the run lies in the step: at an end, or where the depth turns.
        Mask is_simple;    // Nothing but these happens in the step.
        Polynomial<T> g;
        T guess, resolution;  // of the zero crossing of g, as theta
    };

    ARM3R_INLINE DepthEvents depth_events(const Mask& eventful, const Polynomial<T>& p, const Coefficients<T>& b,
                                          const T& high) const {
        using namespace zero_crossing;
        const auto& contact = this->contact_;
        const Mask touching = contact.touching() && eventful;
        const Mask free = eventful && !contact.touching() && !contact.embedded();
        const T sign = select(free, T(-1.0), T(1.0));
        Coefficients<T> distance;
        for (int i = 0; i <= order_; ++i) distance[i] = sign * b[i];
        const Falls<T> ends = falls_of(distance, order_, rounding(p));
        const Mask deeper = touching && high > contact.max_depth();

        const Polynomial<T> rate = derivative(p);
        const Falls<T> peaks = falls_of(bernstein(rate), rate.degree, rounding(rate));
        const Mask may_turn = deeper && ends.none && rate.c[0] >= T(0.0);

        DepthEvents e;
        e.crosses = ends.one && (free || (touching && !deeper));
        e.turns = may_turn && peaks.one;
        e.has_maximum = may_turn && (peaks.one || peaks.none);
        e.is_simple = e.crosses || (ends.none && (free || e.has_maximum || (touching && !deeper)));
        e.g.degree = order_;
        for (int i = 0; i <= order_; ++i) e.g.c[i] = select(e.turns, i < order_ ? rate.c[i] : T(0.0), T(sign * p.c[i]));
        e.guess = select(e.turns, peaks.guess, ends.guess);
        const T finest = event_resolution(T(t0_ + this->h_), this->h_);
        e.resolution = attainable(T(select(e.turns, T(turning_resolution), finest)));
        return e;
    }

    // Contact in the lanes in which the depth p, with the Bernstein coefficients b and of at most `high`, crosses zero
    // once or has one maximum: in all of them at once, with the same bits as resolve_lane(). Takes them out of
    // `eventful`.
    ARM3R_INLINE void resolve_once(Mask& eventful, const Polynomial<T>& p, const Coefficients<T>& b, const T& high) {
        const DepthEvents e = depth_events(eventful, p, b, high);
        const zero_crossing::Bracket<T> step{T(0.0), T(1.0), e.guess};
        const T place = zero_crossing::refine_root(e.g, step, e.resolution, e.crosses || e.turns);
        if (this->contact_.any_touching()) add_depths(e, p, place);
        if (in_any_lane(e.crosses)) change_once(e.crosses, p, place);
        eventful = eventful && !e.is_simple;
    }

    // Adds the contact of these lanes, until it ends at `place` or to the end of the step.
    ARM3R_INLINE void add_depths(const DepthEvents& e, const Polynomial<T>& p, const T& place) {
        const T zero(0.0), one(1.0), until = select(e.crosses, place, one);
        T most = p.c[0], theta = zero;
        const auto include = [&](const Mask& here, const T& at) ARM3R_INLINE_LAMBDA {
            const T depth = value(p, at);
            const Mask is_deeper = here && depth > most;
            theta = select(is_deeper, at, theta);
            most = select(is_deeper, depth, most);
        };
        include(e.has_maximum, one);
        include(e.turns, place);
        this->contact_.add_part(this->contact_.touching() && e.is_simple, e.has_maximum, most,
                                T(t0_ + this->h_ * theta), T(this->h_ * integral(p, zero, until)));
    }

    // The changes of contact at theta, after which the tip is free where it was not.
    ARM3R_INLINE void change_once(const Mask& changes, const Polynomial<T>& p, const T& theta) {
        const T after = theta * this->h_, depths = value(p, theta);
        const T place1 = value(series_, across1, after), place2 = value(series_, across2, after);
        theta_ = select(changes, theta, theta_);
        crosses_ = true;
        for (int lane = 0; lane < Base::lanes; ++lane) {
            if (!Lanes<T>::is(changes, lane)) continue;
            const auto get = [lane](const T& x) { return Lanes<T>::get(x, lane); };
            const Indentation<double> in{get(depths), 0, get(place1), get(place2), 0, 0};
            pending_changes_[lane] = {true, this->change_to_other(lane, in, get(theta), get(T(t0_ + this->h_)))};
        }
    }

    [[gnu::noinline]] void resolve_contacts(const Mask& eventful) {
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (this->is_running(lane) && Lanes<T>::is(eventful, lane)) resolve_lane(lane);
    }

    void resolve_lane(int lane) {
        ContactSignals<double> signals{polynomial(lane, depth), {}, {}};
        if (depends_on_place(this->setup(lane).plant))
            signals.across1 = polynomial(lane, across1), signals.across2 = polynomial(lane, across2);
        const double h = this->h(lane), t0 = Lanes<T>::get(t0_, lane), t = t0 + h;
        const auto crossing =
            next_crossing(this->setup(lane).plant.wall, signals, 0, this->mode(lane), event_resolution(t, h));
        this->add_contact(lane, signals.depth, t0, 0, crossing ? crossing->theta : 1);
        if (!crossing) return;
        crosses_ = true;
        Lanes<T>::set(theta_, lane, crossing->theta);
        pending_changes_[lane] = {true, this->change_of(lane, signals, crossing->theta, t, crossing->next)};
    }

    Polynomial<double> polynomial(int lane, Signal signal) const {
        Polynomial<double> p{order_, {}};
        double power = 1;
        for (int i = 0; i <= order_; ++i, power *= this->h(lane))
            p.c[i] = Lanes<T>::get(series_.c[i][signal], lane) * power;
        return p;
    }

    [[gnu::noinline]] void apply_changes() {
        for (int lane = 0; lane < Base::lanes; ++lane) {
            auto& [is_due, change] = pending_changes_[lane];
            if (!is_due) continue;
            is_due = false;
            change.t = this->t(lane);
            this->change_mode(lane, change);
        }
    }

    // ---- performance: a step is a segment of h seconds, which ends where contact changes

    ARM3R_INLINE void add_work(const Mask& moved, const Y& y1, const T& h) {
        Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
            Vec3<T> work;
            if (this->plant_.holds_torque) work = Base::work_of_held(this->tau_, this->y_, y1);
            else
                for (int i = 0; i < 3; ++i) work[i] = value(series_, work1 + i, h);
            this->performance_.add_work(work, moved);
        });
    }

    ARM3R_INLINE void add_performance(const Mask& moved, const T& h) {
        this->performance_.tracked().motion() ? end_segment<lobatto>(moved, h) : end_segment<trapezoid>(moved, h);
    }

    template <const auto& rule>
    ARM3R_INLINE void end_segment(const Mask& moved, const T& h) {
        Mask unresolved = false;
        for (std::size_t j = 1; j + 1 < rule.node.size(); ++j)
            Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { sample_at(T(rule.node[j] * h), j); });
        this->performance_.template end<rule>(this->instant(), h, moved, unresolved);
        if (in_any_lane(unresolved)) this->refine_segment(*this, rule, unresolved, this->t_);
    }

    ARM3R_INLINE void sample_at(const T& seconds, std::size_t j) {
        Vec3<T> q, qd;
        for (std::size_t i = 0; i < 3; ++i) q[i] = value(series_, i, seconds), qd[i] = value(series_, 3 + i, seconds);
        const T t = t0_ + seconds;
        const Pose<T> p = pose(q);
        WallState<T> wall = no_wall<T>();
        Indentation<T> in{};
        if (this->samples_wall()) {
            wall = wall_at(this->plant_.wall, t);
            in = tip_indentation(this->plant_, wall, p, qd);
        }
        this->performance_.sample(j, {t, p, wall, in, this->performance_.torque_at_start()});
    }

    [[gnu::noinline]] void pass_knots() {
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (Lanes<T>::get(this->next_knot_, lane) <= this->t(lane))
                Lanes<T>::set(this->next_knot_, lane, this->next_metric_knot(lane, this->t(lane)));
    }

    struct PendingChange {
        bool is_due = false;
        ContactChange change{};
    };

    int order_;
    Kernel free_kernel_, pressed_kernel_;
    T tol_{1e-9}, max_step_{1.0}, t0_{0.0}, theta_{1.0};
    Mask is_last_ = false;
    bool crosses_ = false;
    std::array<PendingChange, Base::lanes> pending_changes_{};
    Expansion<T> series_;
    Mask moved_ = false;  // by the last step
    T moved_by_{0.0};     // s
};

}  // namespace arm3r
