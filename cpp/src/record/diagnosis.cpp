#include "record/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "setup/make_controller.hpp"

namespace arm3r {
namespace {

constexpr int changes_per_block = 4;
constexpr double least_swing = 1;    // of the largest torque: it turned back by half its size
constexpr double least_growth = 10;  // from the first block that swung to the last one
constexpr double close_to_singular = 1e-3;

double rounded(double x) { return nearest_integer(1000 * x) / 1000; }

double determinant(const Arm<double>& arm, const Vec3<double>& q) {  // of J, m^3 (2.8)
    const Pose<double> p = pose(q);
    return arm.link2.length * arm.link3.length * (p.S2 * p.C23 - p.C2 * p.S23) * radius(arm, p);
}

// No pose has a larger one.
double largest_determinant(const Arm<double>& arm) {
    const double a2 = arm.link2.length, a3 = arm.link3.length;
    return a2 * a3 * (a2 + a3);
}

}  // namespace

const char* accuracy_advice(const Solver& solver) {
    switch (solver.method) {
        case Solver::rk4: return "take a smaller solver.step";
        case Solver::taylor: return "tighten solver.tol, or limit solver.max_step";
        default: return "tighten solver.rtol, or limit solver.max_step";
    }
}

void TorqueSwings::add(double t, const Vec3<double>& tau) {
    if (block_.changes == 0) block_ = {.first = last_, .way = {0, 0, 0}, .begin = t, .largest = 0, .changes = 0};
    for (int i = 0; i < 3; ++i) {
        block_.way[i] += std::abs(tau[i] - last_[i]);
        block_.largest = std::max(block_.largest, std::abs(tau[i]));
    }
    last_ = tau;
    if (++block_.changes == changes_per_block) close(t);
}

void TorqueSwings::close(double t) {
    double swing = 0;
    for (int i = 0; i < 3; ++i) swing += block_.way[i] - std::abs(last_[i] - block_.first[i]);
    block_.changes = 0;
    if (!(swing > least_swing * block_.largest)) {
        since_ = -1;
        return;
    }
    if (since_ < 0) {
        since_ = block_.begin;
        first_swing_ = swing;
    }
    until_ = t;
    last_swing_ = swing;
}

std::optional<std::string> TorqueSwings::complaint(double period) const {
    if (since_ < 0 || !(last_swing_ > least_growth * first_swing_)) return std::nullopt;
    const double samples = std::max(1.0, (until_ - since_) / period - changes_per_block);
    const double growth = exp(log(last_swing_ / first_swing_) / samples);
    return "the sampled loop is unstable: from t = " + shortest(since_) + " s on the torque swings to and fro, and " +
           shortest(rounded(growth)) +
           " times as far from sample to sample; take a higher sampling.rate, less delay, or lower gains";
}

std::optional<std::string> singular_pose(const Setup& setup, const Run& run, const Vec3<double>& q) {
    if (!inverts_jacobian(setup.law())) return std::nullopt;
    const Arm<double>& model = setup.law().model;
    double closest = determinant(model, q), before = closest, when = run.t_end;
    bool passes = false;
    for (std::size_t row = run.rows; row-- > 0 && !passes;) {
        const auto angle = [&](std::size_t joint) { return run.column(joint)[row]; };  // the columns begin with t and q
        const Vec3<double> there(angle(1), angle(2), angle(3));
        const double here = determinant(model, setup.simscape ? flipped(there) : there);
        passes = (here < 0) != (before < 0);
        if (passes || std::abs(here) < std::abs(closest)) {
            closest = here;
            when = run.column(0)[row];
        }
        before = here;
    }
    const double share = std::abs(closest) / largest_determinant(model);
    if (!passes && !(share < close_to_singular)) return std::nullopt;
    return "the law inverts the Jacobian, and the arm " + std::string(passes ? "passed" : "came close to") +
           " a singular pose at t = " + shortest(when) + " s, where det J = " + shortest(closest) + " m^3 is " +
           shortest(share) + " of the largest; keep the arm bent, or use a law without an inverse, such as stiffness";
}

}  // namespace arm3r
