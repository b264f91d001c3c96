#pragma once
// Runs that march by RK4 (5.1). Steps are never split: contact is decided at each stage, and located afterwards on the
// cubic through the depths and their rates at both ends of the step.

#include "march.hpp"

namespace arm3r {

template <class T>
class FixedMarch : public March<T> {
    using Base = March<T>;
    using Mask = typename Base::Mask;

public:
    explicit FixedMarch(const Setup& any_lane) : Base(any_lane) {
        if (this->plant_.acts_on_arm) this->rhs_.touch = Touch::each_stage;
    }

    void put(int lane, const Setup& setup) {
        Base::put(lane, setup);
        Lanes<T>::set(step_, lane, setup.solver.step);
    }

    // changed(lane, change) is told of each change of contact, before it is made.
    template <class Changed>
    ARM3R_INLINE void step(Changed changed) {
        t0_ = this->t_;
        y0_ = this->y_;
        f0_ = this->f_;
        const Indentation<T> before = this->in_;
        const T aim = min(this->stop_, T((this->accepted_ + 1.0) * step_));
        const Mask is_last = aim >= this->stop_ - 1e-9 * step_;
        this->h_ = select(is_last, T(this->stop_ - t0_), step_);
        const State<T, state_size> y1 = rk4_step(this->rhs_, t0_, y0_, f0_, this->h_);
        const Mask finite = Base::is_finite(y1), moved = finite && this->alive_;
        this->accept(moved, select(is_last, this->stop_, aim), y1);
        this->evaluations_ = this->evaluations_ + 4.0;
        if (any(!finite && this->alive_)) diverge(finite);
        this->observe();
        if (this->plant_.has_wall) watch(before, moved, changed);
        this->close_books();
        this->judge_lanes();
    }

    // The last step's begin, and derivatives at both ends: what an interpolant needs.
    double t0(int lane) const { return Lanes<T>::get(t0_, lane); }
    FullState y0(int lane) const { return Base::state_of(y0_, lane); }
    FullState f0(int lane) const { return Base::state_of(f0_, lane); }
    FullState f(int lane) const { return Base::state_of(this->f_, lane); }

private:
    [[gnu::noinline]] void diverge(const Mask& finite) {
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (this->is_running(lane) && !Lanes<T>::is(finite, lane)) this->stop_lane(lane, ARM3R_RUN_DIVERGED);
    }

    template <class Changed>
    ARM3R_INLINE void watch(const Indentation<T>& before, const Mask& moved, Changed& changed) {
        const Indentation<T>& after = this->in_;
        const T& h = this->h_;
        signals_.depth = hermite_cubic(before.depth, T(h * before.rate), after.depth, T(h * after.rate));
        if (this->plant_.wall.has_outline) {
            signals_.across1 = hermite_cubic(before.across1, T(h * before.slip1), after.across1, T(h * after.slip1));
            signals_.across2 = hermite_cubic(before.across2, T(h * before.slip2), after.across2, T(h * after.slip2));
        }
        Mask special =
            this->eventful(signals_, [](const Polynomial<T>& p) ARM3R_INLINE_LAMBDA { return range_of_cubic(p); });
        if (this->any_touching_) {
            special =
                special || (this->touching_ && range_of_cubic(signals_.depth).high > max(this->deepest_, after.depth));
            const Mask plainly = this->touching_ && !special && moved;
            this->deepest_ = select(plainly, max(this->deepest_, after.depth), this->deepest_);
            const T mean = signals_.depth.c[0] + 0.5 * signals_.depth.c[1] + (1.0 / 3) * signals_.depth.c[2] +
                           0.25 * signals_.depth.c[3];
            this->depth_time_ = this->depth_time_ + select(plainly, T(h * mean), T(0.0));
        }
        special = special && moved;
        if (any(special)) settle(special, changed);
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

    template <class Changed>
    bool settle_lane(int lane, Changed& changed) {
        const Wall<double>& wall = this->setup(lane).plant.wall;
        const double h = this->h(lane), t0 = Lanes<T>::get(t0_, lane);
        const double resolution = event_resolution(this->t(lane), h);
        ContactSignals<double> signals;
        signals.depth = Base::polynomial_of(signals_.depth, lane);
        signals.across1 = Base::polynomial_of(signals_.across1, lane);
        signals.across2 = Base::polynomial_of(signals_.across2, lane);
        double from = 0;
        bool anew = false;
        while (const auto crossing = next_crossing(wall, signals, from, this->mode(lane), resolution)) {
            this->pass(lane, signals.depth, from, crossing->theta);
            from = crossing->theta;
            const double depth = value(signals.depth, from);
            const Change change{from, t0 + from * h, this->stored_at(lane, depth), this->mode(lane), crossing->next};
            changed(lane, change);
            this->change_mode(lane, change);
            anew = true;
            if (this->outcome(lane) != ARM3R_RUN_OK || from >= 1) break;
        }
        this->pass(lane, signals.depth, from, 1.0);
        return anew;
    }

    T step_{1.0}, t0_{0.0};
    State<T, state_size> y0_{}, f0_{};
    ContactSignals<T> signals_{};
};

}  // namespace arm3r
