#include "integrate/stepper.hpp"

#include <algorithm>
#include <cmath>

#include "arm3r/numbers/widths.hpp"
#include "base/number_text.hpp"

namespace arm3r {
namespace {

constexpr double accuracy_limit = 1.2;  // of h lambda: above it stability limits the step of the explicit method
constexpr int enough_signs = 40, enough_doubts = 6;

template <std::size_t N>
bool is_finite(const State<double, N>& y) {
    return std::all_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); });
}

// The fastest rate of the equations, 1/s: from df/dy of the velocities, and from the square root of that of the
// positions.
template <std::size_t N>
double fastest_answer(const Linearization<N>& linearization) {
    double by_rate = 0, by_place = 0;
    for (std::size_t i = 3; i < N; i = i + 1 == motion_size ? state_size : i + 1) {
        double rate = 0, place = 0;
        for (std::size_t j = 0; j < N; j = j + 1 == motion_size ? state_size : j + 1)
            (j < 3 ? place : rate) += std::abs(linearization.df_dy[i][j]);
        by_rate = std::max(by_rate, rate);
        by_place = std::max(by_place, place);
    }
    return by_rate + std::sqrt(by_place);
}

}  // namespace

template <std::size_t N>
Stepper<N>::Stepper(const Setup& setup, const Plant<double>& plant, RightHandSide<double, double>& rhs,
                    double& evaluations)
    : method_(setup.solver.method), rhs_(rhs), evaluations_(evaluations), rhs_of_duals_(plant), judge_(plant, rhs) {
    rhs_of_duals_.law_function = compiled_law<double, D>();
}

template <std::size_t N>
void Stepper<N>::load_lane(int, const Solver& solver) {
    judge_.load_lane(0, solver);
    state_ = {};
    state_.is_stiff = method_ == SolverMethod::rodas4;
    state_.by_stiff.memory = N - state_size;
}

// Contact and inputs of a continuous controller are those of the other right-hand side.
template <std::size_t N>
void Stepper<N>::set_inputs_of_duals() {
    rhs_of_duals_.force_mode = rhs_.force_mode;
    rhs_of_duals_.touching = rhs_.touching;
    rhs_of_duals_.separated = rhs_.separated;
    rhs_of_duals_.contact = D(rhs_.contact);
    rhs_of_duals_.force_phase = D(rhs_.force_phase);
    rhs_of_duals_.latest = D(rhs_.latest);
}

template <std::size_t N>
void Stepper<N>::set_start(bool here, double t, const Y& y) {
    rhs_.begin_step(y);
    if (!here) return;
    state_.has_linearization = state_.is_stiff;
    evaluations_ += 1;
    if (state_.is_stiff) {
        set_inputs_of_duals();
        linearize<motion_size, quadrature_count, derivatives_per_pass>(rhs_of_duals_, t, y, state_.by_stiff.memory,
                                                                       state_.f0, state_.linearization);
    } else {
        outlined<double>(rhs_)(t, y, state_.f0);
    }
}

template <std::size_t N>
double Stepper<N>::attempt(bool, double t, const Y& y, double h) {
    const Tolerance<double>& tolerance = judge_.tolerance;
    bool has_end;
    if (state_.is_stiff) {
        if (!state_.has_linearization) set_start(true, t, y);
        evaluations_ += rodas4::stages - 1;
        has_end = state_.by_stiff.step(outlined<double>(rhs_), state_.linearization, t, y, state_.f0, h);
    } else {
        evaluations_ += chooses_length() ? 6 : 4;
        if (chooses_length()) state_.by_explicit.step(outlined<double>(rhs_), t, y, state_.f0, h);
        else take_rk4_step(outlined<double>(rhs_), t, y, state_.f0, h, state_.by_explicit);
        has_end = is_finite(state_.by_explicit.y1) && is_finite(state_.by_explicit.f1);
    }
    if (!has_end) return infinite;
    if (!chooses_length()) return 0;
    const bool heat = judge_.has_contact_heat();
    const double error = state_.is_stiff ? state_.by_stiff.error(y, tolerance.rtol, tolerance.atol, heat)
                                         : state_.by_explicit.error(y, h, tolerance.rtol, tolerance.atol, heat);
    return judge_.with_work_of_wall(error, y, end(), [&](std::size_t i) { return error_of(i, h); });
}

template <std::size_t N>
void Stepper<N>::accept(bool, bool continues, double t, const Y& y, double h) {
    state_.stiff_steps += state_.is_stiff;
    judge_.include(y);
    const bool was_stiff = state_.is_stiff;
    if (method_ == SolverMethod::automatic) select_method(t, h);
    const bool is_first_known = continues && !was_stiff && !state_.is_stiff;
    if (is_first_known) state_.f0 = state_.by_explicit.f1;
    set_start(!is_first_known, t, y);
}

// Changes to the stiff method after many steps that stability limits, and back when steps of the explicit method would
// be as long.
template <std::size_t N>
void Stepper<N>::select_method(double t, double h) {
    const double measure = state_.is_stiff ? h * fastest_answer(state_.linearization) : state_.by_explicit.stiffness();
    if (state_.is_stiff ? measure < accuracy_limit : measure > accuracy_limit) {
        state_.doubts = 0;
        if (++state_.signs < enough_signs) return;
        state_.is_stiff = !state_.is_stiff;
        if (state_.choice_count < max_listed_choices)
            state_.choices[state_.choice_count] = {t, measure, state_.is_stiff};
        state_.choice_count += 1;
        state_.signs = 0;
    } else if (++state_.doubts == enough_doubts) {
        state_.signs = 0;
    }
}

template <std::size_t N>
std::string Stepper<N>::choices() const {
    if (method_ != SolverMethod::automatic) return "";
    if (state_.choice_count == 0) return "dopri5 throughout: h*lambda did not stay above 1.2";
    std::string text;
    for (std::size_t i = 0; i < std::min(state_.choice_count, max_listed_choices); ++i) {
        const Choice& choice = state_.choices[i];
        text += (i == 0 ? "" : "; ") + std::string(choice.is_stiff ? "rodas4" : "dopri5") +
                " from t = " + shortest(choice.t) + " s on: h*lambda stood " + (choice.is_stiff ? "above" : "below") +
                " 1.2 in 40 steps, at last at " + shortest(nearest_integer(100 * choice.measure) / 100);
    }
    if (state_.choice_count > max_listed_choices)
        text += "; and " + std::to_string(state_.choice_count - max_listed_choices) + " changes more";
    return text;
}

template class Stepper<state_size>;
template class Stepper<full_size>;

}  // namespace arm3r
