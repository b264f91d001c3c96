#pragma once
// Steps of one length by the classical method (5.1), with a cubic through both ends as dense output, for runs whose steps
// end at events too. The names are those of ExplicitSteps.

#include "integrate/explicit_steps.hpp"

namespace arm3r {

template <class T, std::size_t N>
class FixedSteps : public StepStart<T, N> {
    using Start = StepStart<T, N>;

public:
    using typename Start::Mask, typename Start::Y;
    static constexpr bool chooses_length = false;

    FixedSteps(const Setup&, const Plant<T>&, RightHandSide<T, T>& rhs, T& evaluations) : Start(rhs, evaluations) {}
    void load_lane(int, const Solver&) {}

    // Returns 0, or infinity where the step has no finite end: there is no estimate of the error.
    ARM3R_INLINE T attempt(const Mask& here, const T& t, const Y& y, const T& h) {
        this->count(here, 4);
        const auto f = outlined<T>(this->rhs_);
        y1_ = rk4_step_in_a_loop(f, t, y, this->f0_, h);
        f(t + h, y1_, f1_);
        return select(Start::is_finite(y1_, f1_), T(0.0), T(infinite));
    }
    ARM3R_INLINE const Y& end() const { return y1_; }
    ARM3R_INLINE Interpolant<T, N> dense_output(const T& t, const Y& y, const T& h) const {
        return hermite(t, h, y, this->f0_, y1_, f1_);
    }
    ARM3R_INLINE bool repeats_to_event() const { return true; }

    ARM3R_INLINE void accept(const Mask& moved, const Mask& continues, const T& t, const Y& y, const T&) {
        this->start_next(moved, continues, t, y, f1_);
    }

private:
    Y y1_{}, f1_{};
};

}  // namespace arm3r
