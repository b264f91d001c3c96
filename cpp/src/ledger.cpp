#include "ledger.hpp"

#include <algorithm>
#include <cmath>

#include "numbers.hpp"

namespace arm3r {
namespace {

constexpr double loosest_strict_tolerance = 1e-6;

double stock(const Energies& energies) {
    return std::abs(energies.kinetic) + std::abs(energies.potential) + std::abs(energies.contact);
}

}  // namespace

Ledger::Ledger(const Setup& setup, const FullState& y, Mode mode)
    : setup_(setup), start_(energies(setup.plant, 0.0, y, mode)), held_(stock(start_)) {}

void Ledger::close(double t, const FullState& y, Mode mode, Run& run) {
    const Energies now = energies(setup_.plant, t, y, mode);
    note_residual(run.ledger_residual, energy_residual(y, now.sum(), start_.sum()));
    exchanged_ = std::max({exchanged_, std::abs(y[6]), std::abs(y[7]), std::abs(y[8]), now.kinetic,
                           std::abs(now.potential - start_.potential)});
    held_ = std::max(held_, stock(now));
}

double Ledger::tolerance() const {
    return setup_.solver.method == Solver::dopri5 ? setup_.solver.rtol : loosest_strict_tolerance;
}

bool Ledger::is_strict() const {
    return setup_.solver.method == Solver::dopri5 && setup_.solver.rtol <= loosest_strict_tolerance;
}

std::optional<std::string> Ledger::complaint(const Run& run) const {
    const double limit = 100 * tolerance() * exchanged_ + 1e-12 * held_;
    if (run.ledger_residual <= limit) return std::nullopt;
    const char* const advice =
        setup_.solver.method == Solver::dopri5 ? "tighten solver.rtol" : "take a smaller solver.step";
    return "the energy balance does not close: " + shortest(run.ledger_residual) +
           " J are left over, the limit is " + shortest(limit) + " J; " + advice;
}

}  // namespace arm3r
