#pragma once
// Runs that march by RK4 (5.1). Steps are never split: contact is decided at each stage, and located afterwards on the
// cubic through the depths and their rates at both ends of the step. Where a formula of time jumps on the end of a step,
// the step before sees the values before it (5.8).

#include "lanes/lane_run.hpp"
#include "setup/time_instants.hpp"

namespace arm3r {

template <class T, std::size_t N = state_size>
class FixedMarch : public March<T, N> {
    using Base = March<T, N>;
    using Mask = typename Base::Mask;
    using Y = typename Base::Y;

public:
    explicit FixedMarch(const Setup& any_lane) : Base(any_lane) {
        if (this->plant_.acts_on_arm || senses_wall(this->plant_)) this->rhs_.touch = Touch::each_stage;
    }

    void put(int lane, const Setup& setup) {
        Base::put(lane, setup);
        Lanes<T>::set(start_, lane, setup.start);
        Lanes<T>::set(step_, lane, setup.solver.step);
        Lanes<T>::set(this->slack_, lane, 1e-6 * setup.solver.step);
        Lanes<T>::set(next_jump_, lane, next_jump(setup, setup.start));
    }

    // changed(lane, change) is told of each change of contact, before it is made.
    template <class Changed>
    ARM3R_INLINE void step(Changed changed) {
        t0_ = this->t_;
        if (Base::lanes == 1 || this->is_scored_) {
            y0_ = this->y_;
            f0_ = this->f_;
        }
        if (this->is_scored_) Apart<T>::run([this]() ARM3R_INLINE_LAMBDA { this->begin_passage(); });
        before_ = this->in_;
        const T aim = min(this->stop_, T(start_ + (this->accepted_ + 1.0) * step_));
        const Mask is_last = aim >= this->stop_ - 1e-9 * step_;
        const T t1 = select(is_last, this->stop_, aim);
        this->h_ = select(is_last, T(this->stop_ - t0_), step_);
        has_jump_ = any(next_jump_ <= t1);
        if (has_jump_) see_before(t1);
        const Y y1 = stepped();
        const Mask finite = Base::is_finite(y1), moved = finite && this->alive_;
        this->accept(moved, t1, y1);
        this->evaluations_ = this->evaluations_ + 4.0;
        if (any(!finite && this->alive_)) diverge(finite);
        if constexpr (Base::lanes == 1) remember_end();
        if (has_jump_) this->rhs_.latest = T(infinite);
        this->observe();
        special_ = false;
        if (this->plant_.has_wall) watch(moved, changed);
        this->close_books();
        if (this->is_scored_)
            this->holds_torque() && !this->looks_.motion() ? score(trapezoid, moved) : score(simpson, moved);
        this->judge_lanes();
    }

    // The last step's begin, and derivatives at both ends: what an interpolant of a single run needs.
    double t0(int lane) const { return Lanes<T>::get(t0_, lane); }
    FullState y0(int lane) const { return Base::state_of(y0_, lane); }
    FullState f0(int lane) const { return Base::state_of(f0_, lane); }
    // Whether something may have jumped on the end of the last step, and the derivative there as the step saw it.
    bool turns() const { return has_jump_ || was_due_; }
    FullState f1()
        requires std::same_as<T, double>
    {
        if (!turns()) return Base::state_of(this->f_, 0);
        Y f1{};
        swap_before();
        this->rhs_(this->t_, this->y_, f1);
        swap_before();
        return Base::state_of(f1, 0);
    }

private:
    ARM3R_INLINE Y stepped() const {
        if constexpr (N == state_size) return rk4_step(this->rhs_, t0_, this->y_, this->f_, this->h_);
        else return rk4_step_in_a_loop(this->rhs_, t0_, this->y_, this->f_, this->h_);
    }

    // The jumps up to the end of the step: those that lie on it are not yet seen.
    [[gnu::noinline]] void see_before(const T& t1) {
        for (int lane = 0; lane < Base::lanes; ++lane) {
            const double end = Lanes<T>::get(t1, lane);
            double jump = Lanes<T>::get(next_jump_, lane);
            if (jump > end) continue;
            for (; jump < end; jump = next_jump(this->setup(lane), jump)) {
            }
            if (jump == end) Lanes<T>::set(this->rhs_.latest, lane, just_before(end));
            Lanes<T>::set(next_jump_, lane, next_jump(this->setup(lane), end));
        }
    }

    // What the step saw, before a sample changes the torque or an estimate the law.
    ARM3R_INLINE void remember_end() {
        was_due_ = this->is_controlled_ && any(this->is_due());
        torque_before_ = this->plant_.controller.torque;
        assumed_before_ = this->plant_.controller.gains.assumed_stiffness;
        latest_before_ = this->rhs_.latest;
    }
    void swap_before() {
        std::swap(this->plant_.controller.torque, torque_before_);
        std::swap(this->plant_.controller.gains.assumed_stiffness, assumed_before_);
        std::swap(this->rhs_.latest, latest_before_);
    }

    [[gnu::noinline]] void diverge(const Mask& finite) {
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (this->is_running(lane) && !Lanes<T>::is(finite, lane)) this->stop_lane(lane, ARM3R_RUN_DIVERGED);
    }

    // A signal over the step: the cubic through its values and rates at both ends, by its Bernstein coefficients.
    struct Cubic {
        T first, second, third, fourth;

        ARM3R_INLINE Cubic(const T& y0, const T& d0, const T& y1, const T& d1)
            : first(y0), second(y0 + (1.0 / 3) * d0), third(y1 - (1.0 / 3) * d1), fourth(y1) {}
        ARM3R_INLINE T low() const { return min(min(first, second), min(third, fourth)); }
        ARM3R_INLINE T high() const { return max(max(first, second), max(third, fourth)); }
        ARM3R_INLINE T mean() const { return 0.25 * ((first + fourth) + (second + third)); }
    };

    template <class Changed>
    ARM3R_INLINE void watch(const Mask& moved, Changed& changed) {
        const T &h = this->h_, o(0.0);
        const Cubic depth(before_.depth, T(h * before_.rate), this->in_.depth, T(h * this->in_.rate));
        Mask special = Base::select_mask(this->touching_ || this->embedded_, depth.low() <= o, depth.high() > o);
        if (this->any_touching_) {
            if (this->is_elastic_)
                special = special || (this->touching_ && depth.high() > max(this->deepest_, depth.fourth));
            if (this->plant_.wall.has_outline) special = special || (this->touching_ && comes_near_edge());
            const Mask plainly = this->touching_ && !special && moved;
            if (this->is_elastic_) {
                this->reach(plainly, depth.fourth, this->t_, this->deepest_);
                this->depth_time_ = this->depth_time_ + select(plainly, T(h * depth.mean()), o);
            } else {
                measure_damped(plainly);
            }
        }
        special_ = special && moved;
        if (any(special_)) settle(special_, changed);
    }

    // The force of a damped contact over the step; where it may turn within, one lane at a time.
    ARM3R_INLINE void measure_damped(const Mask& plainly) {
        const T &h = this->h_, o(0.0);
        const Polynomial<T> depth =
            hermite_cubic(before_.depth, T(h * before_.rate), this->in_.depth, T(h * this->in_.rate));
        const std::array<T, 5> force = Base::forces(this->plant_.contact, depth, h, o, T(1.0));
        const Mask turns = plainly && range_of(through_five(force)).high > max(this->peak_, force[4]);
        const Mask rises = plainly && !turns;
        this->reach(rises, force[4], this->t_, this->peak_);
        this->impulse_ = this->impulse_ + select(rises, T(h * mean_of_five(force)), o);
        if (!any(turns)) return;
        for (int lane = 0; lane < Base::lanes; ++lane) {
            if (!Lanes<T>::is(turns, lane)) continue;
            std::array<double, 5> alone;
            for (int i = 0; i < 5; ++i) alone[i] = Lanes<T>::get(force[i], lane);
            this->pass_damped(lane, alone, Lanes<T>::get(t0_, lane), this->h(lane));
        }
    }

    ARM3R_INLINE Mask comes_near_edge() const {
        const Indentation<T>&a = before_, &b = this->in_;
        const T& h = this->h_;
        const Cubic across1(a.across1, T(h * a.slip1), b.across1, T(h * b.slip1));
        const Cubic across2(a.across2, T(h * a.slip2), b.across2, T(h * b.slip2));
        const Wall<T>& wall = this->plant_.wall;
        return max(across1.high(), T(-across1.low())) >= wall.half1 ||
               max(across2.high(), T(-across2.low())) >= wall.half2;
    }

    template <class Changed>
    [[gnu::noinline]] void settle(const Mask& special, Changed& changed) {
        bool anew = false;
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (this->is_running(lane) && Lanes<T>::is(special, lane) && settle_lane(lane, changed)) {
                Lanes<T>::set(this->evaluations_, lane, Lanes<T>::get(this->evaluations_, lane) + 1);
                anew = true;
            }
        if (anew) this->evaluate_anew();
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

    template <class Changed>
    bool settle_lane(int lane, Changed& changed) {
        const Wall<double>& wall = this->setup(lane).plant.wall;
        const double h = this->h(lane), t0 = Lanes<T>::get(t0_, lane);
        const double resolution = event_resolution(this->t(lane), h);
        const ContactSignals<double> signals = signals_of(lane);
        Inside inside;
        if (this->is_scored_) inside = inside_of(lane);
        double from = 0;
        bool anew = false;
        while (const auto crossing = next_crossing(wall, signals, from, this->mode(lane), resolution)) {
            this->pass(lane, signals.depth, t0, from, crossing->theta);
            if (this->is_scored_) this->score_alone(lane, simpson, inside, from, crossing->theta);
            from = crossing->theta;
            const Change change = this->change_of(lane, signals, from, t0 + from * h, crossing->next);
            changed(lane, change);
            this->change_mode(lane, change);
            anew = true;
            if (this->outcome(lane) != ARM3R_RUN_OK || from >= 1) break;
        }
        this->pass(lane, signals.depth, t0, from, 1.0);
        if (this->is_scored_ && from < 1) this->score_alone(lane, simpson, inside, from, 1.0);
        return anew;
    }

    // ---- the score

    Inside inside_of(int lane) const {
        Inside inside;
        inside.take(
            hermite(t0(lane), this->h(lane), y0(lane), f0(lane), this->y(lane), Base::state_of(this->f_, lane)));
        return inside;
    }

    // The step as one passage, but where contact has changed in it.
    template <std::size_t n>
    ARM3R_INLINE void score(const Rule<n>& rule, const Mask& moved) {
        Mask closer = false;
        Apart<T>::run([&]() ARM3R_INLINE_LAMBDA {
            if (n == simpson.place.size()) see_middle();
            this->end_passage(rule, this->h_);
            closer = add_passage(this->looks_, rule, Mask(moved && !special_), this->passage_, this->tally_);
        });
        if (any(closer)) look_closer(rule, closer);
    }

    template <std::size_t n>
    [[gnu::noinline]] void look_closer(const Rule<n>& rule, const Mask& closer) {
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (Lanes<T>::is(closer, lane)) this->score_closely(lane, rule, inside_of(lane), 1.0);
    }

    // On the cubic through both ends.
    ARM3R_INLINE void see_middle() {
        const T &h = this->h_, t = t0_ + 0.5 * h;
        Y y;
        [[maybe_unused]] Y rates;
        for (std::size_t i = 0; i < N; ++i) y[i] = 0.5 * (y0_[i] + this->y_[i]) + (0.125 * h) * (f0_[i] - this->f_[i]);
        const Pose<T> p = this->rhs_.pose_near(y);
        const Vec3<T> q(y[0], y[1], y[2]), qd(y[3], y[4], y[5]);
        WallState<T> wall = no_wall<T>();
        Indentation<T> in{};
        if (this->plant_.has_wall) {
            wall = wall_at(this->plant_.wall, t);
            in = tip_indentation(this->plant_, wall, p, qd);
        }
        Vec3<T> tau;
        if constexpr (N == state_size) tau = this->torque_without_memory(q, p);
        else this->rhs_.derivative(t, wall, p, in, y, rates, tau);
        this->see(t, p, wall, in, tau, qd, this->passage_.sights[1]);
    }

    Mask special_ = false;  // where contact may have changed in the step
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    T start_{0.0}, step_{1.0}, t0_{0.0}, next_jump_{infinite};
    bool has_jump_ = false, was_due_ = false;
    Y y0_{}, f0_{};
    Vec3<T> torque_before_;
    T assumed_before_{0.0}, latest_before_{infinite};
    Indentation<T> before_{};
};

}  // namespace arm3r
