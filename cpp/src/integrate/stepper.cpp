#include "integrate/stepper.hpp"
#include "arm3r/numbers/widths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.hpp"

namespace arm3r {
namespace {

constexpr double accuracy_limit = 1.2;  // of h lambda: above it stability limits the step of the explicit method
constexpr int enough_signs = 40, enough_doubts = 6;
constexpr double quiet_motion = 1e-2, rounding_of_motion = 1e-14;  // of the tolerance; rad, rad/s

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
Stepper<N>::Stepper(const Setup& setup) : setup_(setup), rhs_(setup.plant), rhs_of_duals_(setup.plant) {
    rhs_.law_function = compiled_law<double, double>();
    rhs_of_duals_.law_function = compiled_law<double, D>();
    state_.is_stiff = setup.solver.method == SolverMethod::rodas4;
    state_.by_stiff.memory = N - state_size;
}

template <std::size_t N>
void Stepper<N>::set(ContactForceMode force_mode, double contact, double force_phase, double latest) {
    rhs_.force_mode = rhs_of_duals_.force_mode = force_mode;
    rhs_.contact = contact;
    rhs_.force_phase = force_phase;
    rhs_.latest = latest;
    rhs_of_duals_.contact = D(contact);
    rhs_of_duals_.force_phase = D(force_phase);
    rhs_of_duals_.latest = D(latest);
}

template <std::size_t N>
void Stepper<N>::set_start(double t, const Y& y) {
    rhs_.begin_step(y);
    state_.has_linearization = state_.is_stiff;
    state_.evaluations += 1;
    if (state_.is_stiff)
        linearize<motion_size, quadrature_count, derivatives_per_pass>(rhs_of_duals_, t, y, state_.by_stiff.memory,
                                                                       state_.f0, state_.linearization);
    else outlined<double>(rhs_)(t, y, state_.f0);
}

// Dissipation in the contact acts on no state: only the error of the quadratures themselves shows how accurate they
// are.
template <std::size_t N>
bool Stepper<N>::has_contact_heat() const {
    const Contact<double>& contact = setup_.plant.contact;
    return setup_.plant.acts_on_arm && rhs_.force_mode != ContactForceMode::none &&
           (is_damped(contact.law) || contact.has_friction);
}

// Whether the error of the motion is far below the tolerance or mere rounding, and does not determine the step.
template <std::size_t N>
bool Stepper<N>::is_quiet(const Y& y, double h) const {
    const Solver& solver = setup_.solver;
    for (std::size_t i = 0; i < N; i = i + 1 == motion_size ? state_size : i + 1) {
        const double size = std::max(std::abs(y[i]), std::abs(end()[i]));
        if (error_of(i, h) > quiet_motion * (solver.atol + solver.rtol * size) + rounding_of_motion) return false;
    }
    return true;
}

// A law that cancels the force of a moving wall leaves the arm at rest. Its motion has no error to choose the steps by,
// and only the work of the wall has one. In units of the tolerance of the largest work so far.
template <std::size_t N>
double Stepper<N>::with_work_of_wall(double error, const Y& y, double h) const {
    if (!setup_.plant.acts_on_arm || rhs_.force_mode != ContactForceMode::pressed || !is_quiet(y, h)) return error;
    const double most = std::max({state_.max_work_of_wall, std::abs(y[work_of_wall]), std::abs(end()[work_of_wall])});
    return std::max(error, error_of(work_of_wall, h) / (setup_.solver.atol + setup_.solver.rtol * most));
}

template <std::size_t N>
double Stepper<N>::attempt(double t, const Y& y, double h) {
    const Solver& solver = setup_.solver;
    bool has_end;
    if (state_.is_stiff) {
        if (!state_.has_linearization) set_start(t, y);
        state_.evaluations += rodas4::stages - 1;
        has_end = state_.by_stiff.step(outlined<double>(rhs_), state_.linearization, t, y, state_.f0, h);
    } else {
        state_.evaluations += 6;
        state_.by_explicit.step(outlined<double>(rhs_), t, y, state_.f0, h);
        has_end = is_finite(state_.by_explicit.y1) && is_finite(state_.by_explicit.f1);
    }
    if (!has_end) return infinite;
    const double error = state_.is_stiff ? state_.by_stiff.error(y, solver.rtol, solver.atol, has_contact_heat())
                                         : state_.by_explicit.error(y, h, solver.rtol, solver.atol, has_contact_heat());
    return with_work_of_wall(error, y, h);
}

template <std::size_t N>
void Stepper<N>::interpolate(double t, const Y& y, double h, DenseOutput& dense) const {
    dense.assign(state_.is_stiff ? state_.by_stiff.interpolant(t, y, h) : state_.by_explicit.interpolant(t, y, h));
}

template <std::size_t N>
void Stepper<N>::accept(double t, const Y& y, double h, bool continues) {
    state_.stiff_steps += state_.is_stiff;
    state_.max_work_of_wall = std::max(state_.max_work_of_wall, std::abs(y[work_of_wall]));
    const bool was_stiff = state_.is_stiff;
    if (setup_.solver.method == SolverMethod::automatic) select_method(t, h);
    if (continues && !was_stiff && !state_.is_stiff) {
        state_.f0 = state_.by_explicit.f1;
        rhs_.begin_step(y);
    } else {
        set_start(t, y);
    }
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
    if (setup_.solver.method != SolverMethod::automatic) return "";
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

template <std::size_t N>
Vec3<double> Stepper<N>::torque(double t, const WallState<double>& wall, const Pose<double>& p,
                                const Vec3<double>& f_on_tip, const Y& y) const {
    Y rates{};
    return rhs_.torque(t, wall, p, Vec3<double>(y[0], y[1], y[2]), Vec3<double>(y[3], y[4], y[5]), f_on_tip, y, rates);
}

template class Stepper<state_size>;
template class Stepper<full_size>;

}  // namespace arm3r
