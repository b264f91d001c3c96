#include "record/energy_balance.hpp"

#include <limits>

#include "base/number_text.hpp"

namespace arm3r {
namespace {

constexpr double max_strict_tolerance = 1e-6;

// The tolerance of the solver, of angles about 1 rad; a fixed step promises none.
double tolerance(const Solver& solver) {
    switch (solver.method) {
        case SolverMethod::rk4: return max_strict_tolerance;
        case SolverMethod::taylor: return solver.tol;
        default: return std::max(solver.rtol, solver.atol);
    }
}

}  // namespace

double balance_limit(const Solver& solver, const EnergyTotals& totals) {
    const double of_step = tolerance(solver) * totals.throughput + totals.inertia * solver.atol * solver.atol;
    const double of_rounding = (1e-12 + std::numeric_limits<double>::epsilon() * totals.steps) * totals.scale;
    return (100 + totals.errors) * of_step + of_rounding + 0x1p-46 * totals.force_times_reach;
}

bool is_strict(const Solver& solver) {
    return solver.method != SolverMethod::rk4 && tolerance(solver) <= max_strict_tolerance;
}

std::optional<std::string> balance_error(const Solver& solver, const EnergyTotals& totals) {
    const double limit = balance_limit(solver, totals);
    if (totals.residual <= limit) return std::nullopt;
    return "the energy balance does not close: " + shortest(totals.residual) + " J are left over, the limit is " +
           shortest(limit) + " J";
}

}  // namespace arm3r
