#pragma once
// Steps of one length by the classical method (5.1), with a cubic through both ends as dense output, for runs whose steps
// end at events too. The names are those of ExplicitSteps.

#include "integrate/explicit_steps.hpp"

namespace arm3r {

template <class T, std::size_t N>
class FixedSteps {
public:
    using Mask = typename Lanes<T>::Mask;
    using Y = State<T, N>;
    static constexpr bool chooses_length = false;

    FixedSteps(const Setup&, const Plant<T>&, RightHandSide<T, T>& rhs, T& evaluations)
        : rhs_(rhs), evaluations_(evaluations) {}
    // Of an equal setup: what it refers to stays.
    FixedSteps& operator=(const FixedSteps& other) {
        f0_ = other.f0_, y1_ = other.y1_, f1_ = other.f1_;
        return *this;
    }

    void load_lane(int, const Solver&) {}

    ARM3R_INLINE void set_start(const Mask& here, const T& t, const Y& y) {
        rhs_.begin_step(y);
        if (!in_any_lane(here)) return;
        count(here, 1);
        Y f;
        outlined<T>(rhs_)(t, y, f);
        for (std::size_t i = 0; i < N; ++i) f0_[i] = select(here, f[i], f0_[i]);
    }

    // Returns 0, or infinity where the step has no finite end: there is no estimate of the error.
    ARM3R_INLINE T attempt(const Mask& here, const T& t, const Y& y, const T& h) {
        count(here, 4);
        const auto f = outlined<T>(rhs_);
        y1_ = rk4_step_in_a_loop(f, t, y, f0_, h);
        f(t + h, y1_, f1_);
        Mask is_finite = true;
        for (std::size_t i = 0; i < N; ++i) is_finite = is_finite && y1_[i] * 0.0 == T(0.0) && f1_[i] * 0.0 == T(0.0);
        return select(is_finite, T(0.0), T(infinite));
    }
    ARM3R_INLINE const Y& end() const { return y1_; }
    ARM3R_INLINE Interpolant<T, N> dense_output(const T& t, const Y& y, const T& h) const {
        return hermite(t, h, y, f0_, y1_, f1_);
    }
    // The dense output has one order less than the end of a step: a step that ends at an event is taken again.
    ARM3R_INLINE bool repeats_to_event() const { return true; }

    ARM3R_INLINE void accept(const Mask& moved, const Mask& continues, const T& t, const Y& y, const T&) {
        for (std::size_t i = 0; i < N; ++i) f0_[i] = select(continues, f1_[i], f0_[i]);
        set_start(moved && !continues, t, y);
    }

private:
    ARM3R_INLINE void count(const Mask& here, double more) {
        evaluations_ = evaluations_ + select(here, T(more), T(0.0));
    }

    RightHandSide<T, T>& rhs_;
    T& evaluations_;
    Y f0_{}, y1_{}, f1_{};
};

}  // namespace arm3r
