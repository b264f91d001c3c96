#include "record/energy_balance.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"

namespace arm3r {
namespace {

constexpr double loosest_strict_tolerance = 1e-6;

double stock(const Energies& energies) {
    return std::abs(energies.kinetic) + std::abs(energies.potential) + std::abs(energies.contact);
}

// The accuracy that the solver was asked for; a fixed step promises none.
double tolerance(const Solver& solver) {
    switch (solver.method) {
        case Solver::rk4: return loosest_strict_tolerance;
        case Solver::taylor: return solver.tol;
        default: return solver.rtol;
    }
}

}  // namespace

double balance_limit(const Solver& solver, const Flows& flows) {
    return 100 * tolerance(solver) * flows.exchanged + 1e-12 * flows.held + 0x1p-46 * flows.leverage;
}

bool is_strict(const Solver& solver) {
    return solver.method != Solver::rk4 && tolerance(solver) <= loosest_strict_tolerance;
}

std::optional<std::string> balance_complaint(const Solver& solver, const Flows& flows) {
    const double limit = balance_limit(solver, flows);
    if (flows.residual <= limit) return std::nullopt;
    return "the energy balance does not close: " + shortest(flows.residual) + " J are left over, the limit is " +
           shortest(limit) + " J";
}

Ledger::Ledger(const Plant<double>& plant, double t, const FullState& y, Mode mode)
    : start_(energies(plant, t, y, mode)), flows_{0, stock(start_), 0} {}

void Ledger::close(const Plant<double>& plant, double t, const FullState& y, Mode mode) {
    const Energies now = energies(plant, t, y, mode);
    note_residual(flows_.residual, energy_residual(y, now.sum(), start_.sum()));
    flows_.exchanged = std::max({flows_.exchanged, std::abs(y[work_of_actuators]), std::abs(y[work_of_wall]),
                                 std::abs(y[dissipated]), now.kinetic, std::abs(now.potential - start_.potential)});
    flows_.held = std::max(flows_.held, stock(now));
}

}  // namespace arm3r
