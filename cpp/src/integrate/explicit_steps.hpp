#pragma once
// Steps of explicit methods with their error and their dense output, in every lane: of Dormand and Prince, and of one
// length by the classical method; docs/model.md (5.1), (5.2).

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/plant.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// What error estimates are compared with, in every lane.
template <class T>
struct Tolerance {
    T rtol{0.0}, atol{0.0};

    void load_lane(int lane, const Solver& solver) {
        Lanes<T>::set(rtol, lane, solver.rtol);
        Lanes<T>::set(atol, lane, solver.atol);
    }
    ARM3R_INLINE T of(const T& size) const { return atol + rtol * size; }
};

// What the error of a step is judged by, in every lane: the tolerance, and the work of the wall.
template <class T, std::size_t N>
class StepError {
public:
    using Mask = typename Lanes<T>::Mask;
    using Y = State<T, N>;

    StepError(const Plant<T>& plant, const RightHandSide<T, T>& rhs) : plant_(plant), rhs_(rhs) {}

    Tolerance<T> tolerance;

    void load_lane(int lane, const Solver& solver) {
        tolerance.load_lane(lane, solver);
        Lanes<T>::set(most_work_, lane, 0);
    }
    // Of an equal setup: what it refers to stays.
    StepError& operator=(const StepError& other) {
        tolerance = other.tolerance, most_work_ = other.most_work_;
        return *this;
    }
    // The step to y is accepted.
    ARM3R_INLINE void include(const Y& y) { most_work_ = max(most_work_, abs(y[work_of_wall])); }

    // Dissipation in the contact acts on no state: only the error of the quadratures themselves shows how accurate they
    // are.
    ARM3R_INLINE Mask has_contact_heat() const {
        const Contact<T>& contact = plant_.contact;
        const bool may_heat = plant_.acts_on_arm && rhs_.force_mode == ContactForceMode::pressed &&
                              (is_damped(contact.law) || contact.has_friction);
        return may_heat ? rhs_.touching : Mask(false);
    }

    // A law that cancels the force of a moving wall leaves the arm to its own motion, or at rest. That has no error to
    // choose the steps by, and only the work of the wall has one. In units of the tolerance of the largest work so far.
    // error_of(i): the estimate of component i.
    template <class ErrorOf>
    ARM3R_INLINE T with_work_of_wall(const T& error, const Y& y, const Y& y1, ErrorOf error_of) const {
        if (!plant_.acts_on_arm || rhs_.force_mode != ContactForceMode::pressed) return error;
        const Mask shows_no_work = may_cancel_force(plant_.controller.type) && plant_.controller.cancels_force
                                       ? Mask(true)
                                       : is_quiet(y, y1, error_of);
        const Mask counts = rhs_.touching && !rhs_.separated && shows_no_work;
        if (!in_any_lane(counts)) return error;
        const T most = max(max(most_work_, abs(y[work_of_wall])), abs(y1[work_of_wall]));
        return select(counts, max(error, T(error_of(work_of_wall) / tolerance.of(most))), error);
    }

private:
    // Whether the error of the motion is far below the tolerance or mere rounding, and does not determine the step.
    template <class ErrorOf>
    ARM3R_INLINE Mask is_quiet(const Y& y, const Y& y1, ErrorOf error_of) const {
        constexpr double quiet_motion = 1e-2, rounding_of_motion = 1e-14;  // of the tolerance; rad, rad/s
        Mask moves = false;
        for (std::size_t i = 0; i < N; i = i + 1 == motion_size ? state_size : i + 1) {
            const T size = max(abs(y[i]), abs(y1[i]));
            moves = moves || error_of(i) > quiet_motion * tolerance.of(size) + rounding_of_motion;
        }
        return !moves;
    }

    const Plant<T>& plant_;
    const RightHandSide<T, T>& rhs_;
    T most_work_{0.0};  // J, of the wall, either way
};

// The derivative with which a step of an explicit method starts, and its count of evaluations.
template <class T, std::size_t N>
class StepStart {
public:
    using Mask = typename Lanes<T>::Mask;
    using Y = State<T, N>;

    // Adds to `evaluations` whenever it evaluates f.
    StepStart(RightHandSide<T, T>& rhs, T& evaluations) : rhs_(rhs), evaluations_(evaluations) {}
    // Of an equal run: what it refers to stays.
    StepStart& operator=(const StepStart& other) {
        f0_ = other.f0_;
        return *this;
    }

    // Evaluates f at (t, y), where the next step starts, `here`.
    ARM3R_INLINE void set_start(const Mask& here, const T& t, const Y& y) {
        rhs_.begin_step(y);
        if (!in_any_lane(here)) return;
        Y f;
        evaluate(here, t, y, f);
        for (std::size_t i = 0; i < N; ++i) f0_[i] = select(here, f[i], f0_[i]);
    }
    ARM3R_INLINE const Y& f0() const { return f0_; }
    ARM3R_INLINE void evaluate(const Mask& here, const T& t, const Y& y, Y& dy) {
        count(here, 1);
        outlined<T>(rhs_)(t, y, dy);
    }

protected:
    ARM3R_INLINE void count(const Mask& here, double more) {
        evaluations_ = evaluations_ + select(here, T(more), T(0.0));
    }
    ARM3R_INLINE static Mask is_finite(const Y& y, const Y& f) {
        Mask is_finite = true;
        for (std::size_t i = 0; i < N; ++i) is_finite = is_finite && y[i] * 0.0 == T(0.0) && f[i] * 0.0 == T(0.0);
        return is_finite;
    }
    // The next step starts at (t, y): where it `continues`, with the derivative f1 that is known there.
    ARM3R_INLINE void start_next(const Mask& moved, const Mask& continues, const T& t, const Y& y, const Y& f1) {
        for (std::size_t i = 0; i < N; ++i) f0_[i] = select(continues, f1[i], f0_[i]);
        set_start(moved && !continues, t, y);
    }

    RightHandSide<T, T>& rhs_;
    T& evaluations_;
    Y f0_{};
};

// A step of one length by the classical method, kept as one of Dormand and Prince.
template <class F, class T, class Step, class Y>
ARM3R_INLINE void take_rk4_step(const F& f, const T& t, const Y& y, const Y& f0, const T& h, Step& step) {
    step.y1 = rk4_step_in_a_loop(f, t, y, f0, h);
    f(t + h, step.y1, step.f1);
}

template <class T, std::size_t N>
class ExplicitSteps : public StepStart<T, N> {
    using Start = StepStart<T, N>;

public:
    using typename Start::Mask, typename Start::Y;

    ExplicitSteps(const Setup& setup, const Plant<T>& plant, RightHandSide<T, T>& rhs, T& evaluations)
        : Start(rhs, evaluations), chooses_length_(setup.solver.method != SolverMethod::rk4), judge_(plant, rhs) {}

    void load_lane(int lane, const Solver& solver) { judge_.load_lane(lane, solver); }
    bool chooses_length() const { return chooses_length_; }
    const Tolerance<T>& tolerance() const { return judge_.tolerance; }

    // Tries a step `here`. Returns the error in units of its tolerance, infinite where the step fails; 0 of a step of one
    // length, which has no estimate.
    ARM3R_INLINE T attempt(const Mask& here, const T& t, const Y& y, const T& h) {
        T error(0.0);
        if (chooses_length_) {
            this->count(here, 6);
            step_.step(outlined<T>(this->rhs_), t, y, this->f0_, h);
            const Tolerance<T>& tolerance = judge_.tolerance;
            error = step_.error(y, h, tolerance.rtol, tolerance.atol, judge_.has_contact_heat());
            const auto error_of = [&](std::size_t i) ARM3R_INLINE_LAMBDA { return step_.error_of(i, h); };
            error = judge_.with_work_of_wall(error, y, step_.y1, error_of);
        } else {
            this->count(here, 4);
            take_rk4_step(outlined<T>(this->rhs_), t, y, this->f0_, h, step_);
        }
        return select(Start::is_finite(step_.y1, step_.f1), error, T(infinite));
    }
    ARM3R_INLINE const Y& end() const { return step_.y1; }
    ARM3R_INLINE Interpolant<T, N> dense_output(const T& t, const Y& y, const T& h) const {
        return chooses_length_ ? step_.interpolant(t, y, h) : hermite(t, h, y, this->f0_, step_.y1, step_.f1);
    }
    // A cubic has one order less than the end of its step, which the works need.
    ARM3R_INLINE bool repeats_to_event() const { return !chooses_length_; }
    ARM3R_INLINE T factor(const T& error) const { return step_factor(error); }

    // Accepts the step to (t, y) where `moved`; where it `continues`, the next step starts there without a restart.
    ARM3R_INLINE void accept(const Mask& moved, const Mask& continues, const T& t, const Y& y, const T&) {
        judge_.include(y);
        this->start_next(moved, continues, t, y, step_.f1);
    }

private:
    const bool chooses_length_;
    StepError<T, N> judge_;
    Dopri5<T, N, motion_size, quadrature_count, quadrature_parts> step_;
};

}  // namespace arm3r
