#pragma once
// Steps with their error and their dense output, in every lane: by the method of Dormand and Prince, of one length by the
// classical method, by one for stiff equations, or by an automatic choice; docs/model.md (5.1), (5.2), (5.6), (5.7).

#include <memory>
#include <string>

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/ode/rodas.hpp"
#include "arm3r/plant.hpp"
#include "integrate/lane_jacobian.hpp"
#include "integrate/method_choice.hpp"
#include "integrate/motion_jacobian.hpp"
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

// In every lane: by the explicit methods, by the stiff one, or by an automatic choice.
template <class T, std::size_t N>
class StepMethod : public StepStart<T, N> {
    using Start = StepStart<T, N>;

public:
    using typename Start::Mask, typename Start::Y;

    StepMethod(const Setup& setup, const Plant<T>& plant, RightHandSide<T, T>& rhs, T& evaluations)
        : Start(rhs, evaluations), method_(setup.solver.method), plant_(plant), judge_(plant, rhs) {
        if (!setup.solver.is_explicit()) stiff_ = std::make_unique<Stiff>();
    }
    // Of an equal run: what it refers to stays.
    StepMethod& operator=(const StepMethod& other) {
        Start::operator=(other);
        judge_ = other.judge_, explicit_ = other.explicit_;
        if (stiff_) stiff_->state = other.stiff_->state;
        return *this;
    }

    void load_lane(int lane, const Setup& setup) {
        judge_.load_lane(lane, setup.solver);
        if (!stiff_) return;
        stiff_->jacobian.load_lane(lane, setup.plant);
        StiffState& state = stiff_->state;
        Lanes<T>::mark(state.is_stiff, lane, method_ == SolverMethod::rodas4);
        Lanes<T>::mark(state.has_jacobian, lane, false);
        state.step.memory = N - state_size;
        state.choice[lane] = {}, state.steps[lane] = 0;
    }
    bool chooses_length() const { return method_ != SolverMethod::rk4; }
    const Tolerance<T>& tolerance() const { return judge_.tolerance; }
    ARM3R_INLINE Mask is_stiff() const { return stiff_ ? stiff_->state.is_stiff : Mask(false); }

    // Evaluates f at (t, y), where the next step starts, `here`, and its Jacobian where the step is stiff.
    ARM3R_INLINE void set_start(const Mask& here, const T& t, const Y& y) {
        if (!stiff_) return Start::set_start(here, t, y);
        Start::set_start(here && !stiff_->state.is_stiff, t, y);
        find_jacobians(here && stiff_->state.is_stiff, t, y);
    }

    // Tries a step `here`. Returns the error in units of its tolerance, infinite where the step fails; 0 of a step of one
    // length, which has no estimate.
    ARM3R_INLINE T attempt(const Mask& here, const T& t, const Y& y, const T& h) {
        const Mask is_stiff = this->is_stiff();
        if (!in_any_lane(here && is_stiff)) return attempt_explicit(here, t, y, h);
        T error = T(infinite);
        if (in_any_lane(here && !is_stiff)) error = attempt_explicit(here && !is_stiff, t, y, h);
        T of_stiff;
        Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { of_stiff = attempt_stiff(here && is_stiff, t, y, h); });
        return select(is_stiff, of_stiff, error);
    }
    ARM3R_INLINE Y end() const {
        if (!stiff_) return explicit_.y1;
        Y y;
        for (std::size_t i = 0; i < N; ++i) y[i] = select(is_stiff(), stiff_->state.step.y1[i], explicit_.y1[i]);
        return y;
    }
    ARM3R_INLINE Interpolant<T, N> dense_output(const T& t, const Y& y, const T& h) const {
        if (!chooses_length()) return hermite(t, h, y, this->f0_, explicit_.y1, explicit_.f1);
        if (!in_any_lane(is_stiff())) return explicit_.interpolant(t, y, h);
        Interpolant<T, N> dense = stiff_->state.step.interpolant(t, y, h);
        if (in_all_lanes(is_stiff())) return dense;
        const Interpolant<T, N> other = explicit_.interpolant(t, y, h);
        for (std::size_t j = 0; j < dense.c.size(); ++j)
            for (std::size_t i = 0; i < N; ++i) dense.c[j][i] = select(is_stiff(), dense.c[j][i], other.c[j][i]);
        return dense;
    }
    // The dense output of RODAS4 and a cubic have one order less than the end of their step, which the works need.
    ARM3R_INLINE Mask repeats_to_event() const { return is_stiff() || !chooses_length(); }
    ARM3R_INLINE T factor(const T& error) const {
        if (!stiff_) return step_factor(error);
        return select(is_stiff(), StiffStep::step_factor(error), step_factor(error));
    }

    // Accepts the step to (t, y) where `moved`; where it `continues`, the next step starts there without a restart. Then
    // the method may be changed.
    ARM3R_INLINE void accept(const Mask& moved, const Mask& continues, const T& t, const Y& y, const T& h) {
        judge_.include(y);
        if (!stiff_) return start_next(moved, continues, t, y);
        const Mask was_stiff = is_stiff();
        T h_lambda(0.0);
        if (method_ == SolverMethod::automatic)
            Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { h_lambda = explicit_.stiffness(); });
        end_stiff_steps(moved, t, h, h_lambda);
        start_next(moved, continues && !(was_stiff || is_stiff()), t, y);
    }

    double stiff_steps(int lane) const { return stiff_ ? stiff_->state.steps[lane] : 0; }
    std::string choices(int lane) const {  // of auto: which method it used when, and why
        return method_ == SolverMethod::automatic ? stiff_->state.choice[lane].text() : "";
    }

private:
    using StiffStep = Rodas4<T, N, motion_size, quadrature_count, quadrature_parts>;
    static constexpr int lanes = Lanes<T>::count;

    // All of the stiff method that changes from step to step; a copy continues as the original would.
    struct StiffState {
        StiffStep step;
        typename StiffStep::Jacobians jacobians{};
        Mask is_stiff = false, has_jacobian = false;
        std::array<MethodChoice, lanes> choice{};
        std::array<double, lanes> steps{};
    };
    struct Stiff {
        std::conditional_t<N == state_size, MotionJacobian<T>, LaneJacobians<T>> jacobian;
        StiffState state;
    };

    ARM3R_INLINE T attempt_explicit(const Mask& here, const T& t, const Y& y, const T& h) {
        T error(0.0);
        if (chooses_length()) {
            this->count(here, 6);
            explicit_.step(outlined<T>(this->rhs_), t, y, this->f0_, h);
            const Tolerance<T>& tolerance = judge_.tolerance;
            error = explicit_.error(y, h, tolerance.rtol, tolerance.atol, judge_.has_contact_heat());
            const auto error_of = [&](std::size_t i) ARM3R_INLINE_LAMBDA { return explicit_.error_of(i, h); };
            error = judge_.with_work_of_wall(error, y, explicit_.y1, error_of);
        } else {
            this->count(here, 4);
            take_rk4_step(outlined<T>(this->rhs_), t, y, this->f0_, h, explicit_);
        }
        return select(Start::is_finite(explicit_.y1, explicit_.f1), error, T(infinite));
    }

    ARM3R_INLINE T attempt_stiff(const Mask& here, const T& t, const Y& y, const T& h) {
        StiffState& state = stiff_->state;
        find_jacobians(here && !state.has_jacobian, t, y);
        this->count(here, rodas4::stages - 1);
        const Mask good = state.step.step(outlined<T>(this->rhs_), here, state.jacobians, t, y, this->f0_, h);
        const Tolerance<T>& tolerance = judge_.tolerance;
        const T error = state.step.error(y, tolerance.rtol, tolerance.atol, judge_.has_contact_heat());
        const auto error_of = [&](std::size_t i) ARM3R_INLINE_LAMBDA { return state.step.error_of(i); };
        return select(good, judge_.with_work_of_wall(error, y, state.step.y1, error_of), T(infinite));
    }

    ARM3R_INLINE void find_jacobians(const Mask& here, const T& t, const Y& y) {
        if (!in_any_lane(here)) return;
        this->rhs_.begin_step(y);
        this->count(here, 1);
        stiff_->jacobian.find(here, this->rhs_, plant_.held_torque, t, y, this->f0_, stiff_->state.jacobians);
        stiff_->state.has_jacobian = stiff_->state.has_jacobian || here;
    }

    ARM3R_INLINE void start_next(const Mask& moved, const Mask& continues, const T& t, const Y& y) {
        for (std::size_t i = 0; i < N; ++i) this->f0_[i] = select(continues, explicit_.f1[i], this->f0_[i]);
        set_start(moved && !continues, t, y);
    }

    [[gnu::noinline]] void end_stiff_steps(const Mask& moved, const T& t, const T& h, const T& h_lambda) {
        StiffState& state = stiff_->state;
        for (int lane = 0; lane < lanes; ++lane) {
            if (!Lanes<T>::is(moved, lane)) continue;
            const bool is_stiff = Lanes<T>::is(state.is_stiff, lane);
            state.steps[lane] += is_stiff;
            Lanes<T>::mark(state.has_jacobian, lane, false);
            if (method_ != SolverMethod::automatic) continue;
            const double measure = is_stiff ? Lanes<T>::get(h, lane) * fastest_answer(state.jacobians[lane])
                                            : Lanes<T>::get(h_lambda, lane);
            if (state.choice[lane].changes(is_stiff, Lanes<T>::get(t, lane), measure))
                Lanes<T>::mark(state.is_stiff, lane, !is_stiff);
        }
    }

    const SolverMethod method_;
    const Plant<T>& plant_;
    StepError<T, N> judge_;
    Dopri5<T, N, motion_size, quadrature_count, quadrature_parts> explicit_;
    std::unique_ptr<Stiff> stiff_;
};

}  // namespace arm3r
