#pragma once
// Steps of a single run by the explicit methods, by one for stiff equations, or by an automatic choice; docs/model.md (5.1),
// (5.2), (5.6), (5.7). The names are those of ExplicitSteps.

#include <string>

#include "arm3r/ode/rodas.hpp"
#include "control/compiled_laws.hpp"
#include "integrate/explicit_steps.hpp"

namespace arm3r {

// N is state_size, or full_size where a controller remembers something.
template <std::size_t N>
class Stepper {
public:
    using Y = State<double, N>;

    Stepper(const Setup& setup, const Plant<double>& plant, RightHandSide<double, double>& rhs, double& evaluations);
    void load_lane(int, const Solver& solver);
    // Of an equal setup: what it refers to stays.
    Stepper& operator=(const Stepper& other) {
        judge_ = other.judge_, state_ = other.state_;
        return *this;
    }
    bool chooses_length() const { return method_ != SolverMethod::rk4; }
    const Tolerance<double>& tolerance() const { return judge_.tolerance; }

    void set_start(bool here, double t, const Y& y);
    const Y& f0() const { return state_.f0; }
    void evaluate(bool, double t, const Y& y, Y& dy) {
        evaluations_ += 1;
        outlined<double>(rhs_)(t, y, dy);
    }

    double attempt(bool, double t, const Y& y, double h);
    const Y& end() const { return state_.is_stiff ? state_.by_stiff.y1 : state_.by_explicit.y1; }
    Interpolant<double, N> dense_output(double t, const Y& y, double h) const {
        if (!chooses_length()) return hermite(t, h, y, state_.f0, state_.by_explicit.y1, state_.by_explicit.f1);
        return state_.is_stiff ? state_.by_stiff.interpolant(t, y, h) : state_.by_explicit.interpolant(t, y, h);
    }
    // The dense output of RODAS4 and a cubic have one order less than the end of their step, which the works need.
    bool repeats_to_event() const { return state_.is_stiff || !chooses_length(); }
    double factor(double error) const { return state_.is_stiff ? Stiff::step_factor(error) : step_factor(error); }
    // Where a step continues, the method may be changed.
    void accept(bool, bool continues, double t, const Y& y, double h);

    bool is_stiff() const { return state_.is_stiff; }
    std::int64_t stiff_steps() const { return state_.stiff_steps; }
    std::string choices() const;  // of auto: which method it used when, and why

private:
    using Explicit = Dopri5<double, N, motion_size, quadrature_count, quadrature_parts>;
    using Stiff = Rodas4<N, motion_size, quadrature_count, quadrature_parts>;
    using D = Dual<derivatives_per_pass>;

    double error_of(std::size_t i, double h) const {
        return state_.is_stiff ? state_.by_stiff.error_of(i) : state_.by_explicit.error_of(i, h);
    }
    void set_inputs_of_duals();
    void select_method(double t, double h);

    struct Choice {
        double t, measure;  // s, h lambda
        bool is_stiff;
    };
    static constexpr std::size_t max_listed_choices = 8;

    // All that changes from step to step; a copy continues as the original would.
    struct StepperState {
        Explicit by_explicit;
        Stiff by_stiff;
        Linearization<N> linearization;
        bool has_linearization = false;
        Y f0{};
        bool is_stiff = false;
        int signs = 0, doubts = 0;  // consecutive signs for the other method, and against it
        std::array<Choice, max_listed_choices> choices{};
        std::size_t choice_count = 0;
        std::int64_t stiff_steps = 0;
    };

    const SolverMethod method_;
    RightHandSide<double, double>& rhs_;
    double& evaluations_;
    RightHandSide<double, D> rhs_of_duals_;
    StepError<double, N> judge_;
    StepperState state_;
};

// The steps of runs in lanes, and of one alone, which alone can be stiff.
template <class T, std::size_t N>
using StepMethod = std::conditional_t<Lanes<T>::count == 1, Stepper<N>, ExplicitSteps<T, N>>;

}  // namespace arm3r
