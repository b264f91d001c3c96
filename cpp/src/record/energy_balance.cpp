#include "record/energy_balance.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"

namespace arm3r {
namespace {

constexpr double max_strict_tolerance = 1e-6;

double stored_energy(const Energies& energies) {
    return std::abs(energies.kinetic) + std::abs(energies.potential) + std::abs(energies.contact);
}

// The tolerance of the solver; a fixed step promises none.
double tolerance(const Solver& solver) {
    switch (solver.method) {
        case Solver::rk4: return max_strict_tolerance;
        case Solver::taylor: return solver.tol;
        default: return solver.rtol;
    }
}

}  // namespace

double balance_limit(const Solver& solver, const EnergyTotals& totals) {
    return 100 * tolerance(solver) * totals.throughput + 1e-12 * totals.stored + 0x1p-46 * totals.force_times_reach;
}

bool is_strict(const Solver& solver) {
    return solver.method != Solver::rk4 && tolerance(solver) <= max_strict_tolerance;
}

std::optional<std::string> balance_error(const Solver& solver, const EnergyTotals& totals) {
    const double limit = balance_limit(solver, totals);
    if (totals.residual <= limit) return std::nullopt;
    return "the energy balance does not close: " + shortest(totals.residual) + " J are left over, the limit is " +
           shortest(limit) + " J";
}

EnergyBalance::EnergyBalance(const Plant<double>& plant, double t, const FullState& y, ContactMode mode)
    : start_(energies(plant, t, y, mode)), totals_{0, stored_energy(start_), 0} {}

void EnergyBalance::update(const Plant<double>& plant, double t, const FullState& y, ContactMode mode) {
    const Energies now = energies(plant, t, y, mode);
    include_residual(totals_.residual, energy_residual(y, now.sum(), start_.sum()));
    totals_.throughput = std::max({totals_.throughput, std::abs(y[work_of_actuators]), std::abs(y[work_of_wall]),
                                   std::abs(y[dissipated]), now.kinetic, std::abs(now.potential - start_.potential)});
    totals_.stored = std::max(totals_.stored, stored_energy(now));
}

}  // namespace arm3r
