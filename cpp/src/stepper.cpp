#include "stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apart.hpp"
#include "numbers.hpp"

namespace arm3r {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double accuracy_limit = 1.2;  // of h lambda: beyond it the explicit method is held down by its stability
constexpr int enough_signs = 40, enough_doubts = 6;

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
Stepper<N>::Stepper(const Setup& setup)
    : setup_(setup), rhs_(setup.plant), rhs_of_duals_(setup.plant), is_stiff_(setup.solver.method == Solver::rodas4) {
    rhs_.law_function = compiled_law<double, double>();
    rhs_of_duals_.law_function = compiled_law<double, D>();
    stiff_.memory = N - state_size;
}

template <std::size_t N>
Stepper<N>::Stepper(const Setup& setup, const Stepper& other) : Stepper(setup) {
    explicit_ = other.explicit_;
    stiff_ = other.stiff_;
    slopes_ = other.slopes_;
    has_slopes_ = other.has_slopes_;
    f0_ = other.f0_;
    is_stiff_ = other.is_stiff_;
    signs_ = other.signs_;
    doubts_ = other.doubts_;
    evaluations_ = other.evaluations_;
    stiff_steps_ = other.stiff_steps_;
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
    has_slopes_ = is_stiff_;
    evaluations_ += 1;
    if (is_stiff_)
        linearize<motion_size, ledger_size, slopes_at_once>(rhs_of_duals_, t, y, stiff_.memory, f0_, slopes_);
    else called<double>(rhs_)(t, y, f0_);
}

// Heat of the contact goes by no state: only the books themselves tell how well they are kept.
template <std::size_t N>
bool Stepper<N>::counts_heat() const {
    const Contact<double>& contact = setup_.plant.contact;
    return setup_.plant.acts_on_arm && rhs_.touch != Touch::none && (is_damped(contact.law) || contact.has_friction);
}

template <std::size_t N>
double Stepper<N>::attempt(double t, const Y& y, double h) {
    const Solver& solver = setup_.solver;
    if (is_stiff_) {
        if (!has_slopes_) begin(t, y);
        evaluations_ += rodas4::stages - 1;
        return stiff_.step(called<double>(rhs_), slopes_, t, y, f0_, h)
                   ? stiff_.error(y, solver.rtol, solver.atol, counts_heat())
                   : infinite;
    }
    evaluations_ += 6;
    explicit_.step(called<double>(rhs_), t, y, f0_, h);
    const bool has_end = is_finite(explicit_.y1) && is_finite(explicit_.f1);
    return has_end ? explicit_.error(y, h, solver.rtol, solver.atol, counts_heat()) : infinite;
}

template <std::size_t N>
void Stepper<N>::interpolate(double t, const Y& y, double h, Inside& inside) const {
    inside.take(is_stiff_ ? stiff_.interpolant(t, y, h) : explicit_.interpolant(t, y, h));
}

template <std::size_t N>
void Stepper<N>::accept(double t, const Y& y, double h, bool goes_on) {
    stiff_steps_ += is_stiff_;
    const bool was_stiff = is_stiff_;
    if (setup_.solver.method == Solver::automatic) judge_stiffness(t, h);
    if (goes_on && !was_stiff && !is_stiff_) {
        f0_ = explicit_.f1;
        rhs_.begin_step(y);
    } else {
        begin(t, y);
    }
}

// Towards the stiff method where stability holds the step down many times, back where the explicit one would go as far.
template <std::size_t N>
void Stepper<N>::judge_stiffness(double t, double h) {
    const double measure = is_stiff_ ? h * fastest_answer(slopes_) : explicit_.stiffness();
    if (is_stiff_ ? measure < accuracy_limit : measure > accuracy_limit) {
        doubts_ = 0;
        if (++signs_ < enough_signs) return;
        is_stiff_ = !is_stiff_;
        if (choice_count_ < most_told) choices_[choice_count_] = {t, measure, is_stiff_};
        choice_count_ += 1;
        signs_ = 0;
    } else if (++doubts_ == enough_doubts) {
        signs_ = 0;
    }
}

template <std::size_t N>
std::string Stepper<N>::choices() const {
    if (setup_.solver.method != Solver::automatic) return "";
    if (choice_count_ == 0) return "dopri5 throughout: h*lambda did not stay above 1.2";
    std::string told;
    for (std::size_t i = 0; i < std::min(choice_count_, most_told); ++i) {
        const Choice& choice = choices_[i];
        told += (i == 0 ? "" : "; ") + std::string(choice.is_stiff ? "rodas4" : "dopri5") +
                " from t = " + shortest(choice.t) + " s on: h*lambda stood " + (choice.is_stiff ? "above" : "below") +
                " 1.2 in 40 steps, at last at " + shortest(nearest_integer(100 * choice.measure) / 100);
    }
    if (choice_count_ > most_told) told += "; and " + std::to_string(choice_count_ - most_told) + " changes more";
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
