#include "integrate/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/noinline.hpp"
#include "base/number_text.hpp"

namespace arm3r {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double accuracy_limit = 1.2;  // of h lambda: beyond it the explicit method is held down by its stability
constexpr int enough_signs = 40, enough_doubts = 6;
constexpr double quiet_motion = 1e-2, rounding_of_motion = 1e-14;  // of the tolerance; rad, rad/s

template <std::size_t N>
bool is_finite(const State<double, N>& y) {
    return std::all_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); });
}

// How fast the equations may answer, 1/s: from the rates' dependence on rates, and on places by its root.
template <std::size_t N>
double fastest_answer(const Linearization<N>& slopes) {
    double by_rate = 0, by_place = 0;
    for (std::size_t i = 3; i < N; i = i + 1 == motion_size ? state_size : i + 1) {
        double rate = 0, place = 0;
        for (std::size_t j = 0; j < N; j = j + 1 == motion_size ? state_size : j + 1)
            (j < 3 ? place : rate) += std::abs(slopes.by_state[i][j]);
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
    now_.is_stiff = setup.solver.method == Solver::rodas4;
    now_.by_stiff.memory = N - state_size;
}

template <std::size_t N>
void Stepper<N>::set(Touch touch, double contact, double force_phase, double latest) {
    rhs_.touch = rhs_of_duals_.touch = touch;
    rhs_.contact = contact;
    rhs_.force_phase = force_phase;
    rhs_.latest = latest;
    rhs_of_duals_.contact = D(contact);
    rhs_of_duals_.force_phase = D(force_phase);
    rhs_of_duals_.latest = D(latest);
}

template <std::size_t N>
void Stepper<N>::begin(double t, const Y& y) {
    rhs_.begin_step(y);
    now_.has_slopes = now_.is_stiff;
    now_.evaluations += 1;
    if (now_.is_stiff)
        linearize<motion_size, ledger_size, slopes_at_once>(rhs_of_duals_, t, y, now_.by_stiff.memory, now_.f0,
                                                            now_.slopes);
    else called<double>(rhs_)(t, y, now_.f0);
}

// Heat of the contact goes by no state: only the books themselves tell how well they are kept.
template <std::size_t N>
bool Stepper<N>::counts_heat() const {
    const Contact<double>& contact = setup_.plant.contact;
    return setup_.plant.acts_on_arm && rhs_.touch != Touch::none && (is_damped(contact.law) || contact.has_friction);
}

// Whether the error of the motion, far below the tolerance or mere rounding, says nothing of the step.
template <std::size_t N>
bool Stepper<N>::is_quiet(const Y& y, double h) const {
    const Solver& solver = setup_.solver;
    for (std::size_t i = 0; i < N; i = i + 1 == motion_size ? state_size : i + 1) {
        const double size = std::max(std::abs(y[i]), std::abs(end()[i]));
        if (error_of(i, h) > quiet_motion * (solver.atol + solver.rtol * size) + rounding_of_motion) return false;
    }
    return true;
}

// A law that cancels the force of a moving wall leaves the arm at rest: its motion has no error by which the steps could be
// chosen, and the work of the wall is then all that has one. In units of the tolerance of the largest work so far.
template <std::size_t N>
double Stepper<N>::with_work_of_wall(double error, const Y& y, double h) const {
    if (!setup_.plant.acts_on_arm || rhs_.touch != Touch::pressed || !is_quiet(y, h)) return error;
    const double most = std::max({now_.most_work_of_wall, std::abs(y[work_of_wall]), std::abs(end()[work_of_wall])});
    return std::max(error, error_of(work_of_wall, h) / (setup_.solver.atol + setup_.solver.rtol * most));
}

template <std::size_t N>
double Stepper<N>::attempt(double t, const Y& y, double h) {
    const Solver& solver = setup_.solver;
    bool has_end;
    if (now_.is_stiff) {
        if (!now_.has_slopes) begin(t, y);
        now_.evaluations += rodas4::stages - 1;
        has_end = now_.by_stiff.step(called<double>(rhs_), now_.slopes, t, y, now_.f0, h);
    } else {
        now_.evaluations += 6;
        now_.by_explicit.step(called<double>(rhs_), t, y, now_.f0, h);
        has_end = is_finite(now_.by_explicit.y1) && is_finite(now_.by_explicit.f1);
    }
    if (!has_end) return infinite;
    const double error = now_.is_stiff ? now_.by_stiff.error(y, solver.rtol, solver.atol, counts_heat())
                                       : now_.by_explicit.error(y, h, solver.rtol, solver.atol, counts_heat());
    return with_work_of_wall(error, y, h);
}

template <std::size_t N>
void Stepper<N>::interpolate(double t, const Y& y, double h, Inside& inside) const {
    inside.take(now_.is_stiff ? now_.by_stiff.interpolant(t, y, h) : now_.by_explicit.interpolant(t, y, h));
}

template <std::size_t N>
void Stepper<N>::accept(double t, const Y& y, double h, bool goes_on) {
    now_.stiff_steps += now_.is_stiff;
    now_.most_work_of_wall = std::max(now_.most_work_of_wall, std::abs(y[work_of_wall]));
    const bool was_stiff = now_.is_stiff;
    if (setup_.solver.method == Solver::automatic) judge_stiffness(t, h);
    if (goes_on && !was_stiff && !now_.is_stiff) {
        now_.f0 = now_.by_explicit.f1;
        rhs_.begin_step(y);
    } else {
        begin(t, y);
    }
}

// Towards the stiff method where stability holds the step down many times, back where the explicit one would go as far.
template <std::size_t N>
void Stepper<N>::judge_stiffness(double t, double h) {
    const double measure = now_.is_stiff ? h * fastest_answer(now_.slopes) : now_.by_explicit.stiffness();
    if (now_.is_stiff ? measure < accuracy_limit : measure > accuracy_limit) {
        now_.doubts = 0;
        if (++now_.signs < enough_signs) return;
        now_.is_stiff = !now_.is_stiff;
        if (now_.choice_count < most_told) now_.choices[now_.choice_count] = {t, measure, now_.is_stiff};
        now_.choice_count += 1;
        now_.signs = 0;
    } else if (++now_.doubts == enough_doubts) {
        now_.signs = 0;
    }
}

template <std::size_t N>
std::string Stepper<N>::choices() const {
    if (setup_.solver.method != Solver::automatic) return "";
    if (now_.choice_count == 0) return "dopri5 throughout: h*lambda did not stay above 1.2";
    std::string told;
    for (std::size_t i = 0; i < std::min(now_.choice_count, most_told); ++i) {
        const Choice& choice = now_.choices[i];
        told += (i == 0 ? "" : "; ") + std::string(choice.is_stiff ? "rodas4" : "dopri5") +
                " from t = " + shortest(choice.t) + " s on: h*lambda stood " + (choice.is_stiff ? "above" : "below") +
                " 1.2 in 40 steps, at last at " + shortest(nearest_integer(100 * choice.measure) / 100);
    }
    if (now_.choice_count > most_told)
        told += "; and " + std::to_string(now_.choice_count - most_told) + " changes more";
    return told;
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
