#pragma once
// The energy balance of a run and its evaluation; docs/model.md (4.9).

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "record/row.hpp"
#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// J, maxima over the run so far: the energy throughput, the stored energy, and the residual; and the largest wall force
// times the length of the arm, by which a rounding error of the position becomes an energy.
struct EnergyTotals {
    double throughput = 0, stored = 0, residual = 0, force_times_reach = 0;
};

inline double force_times_reach(const Plant<double>& plant, double peak_force) {
    return plant.acts_on_arm ? peak_force * (plant.arm.link2.length + plant.arm.link3.length) : 0;
}

// The limit of the residual at the end, and whether a larger one is an outcome of the run or only a warning.
double balance_limit(const Solver& solver, const EnergyTotals& totals);
bool is_strict(const Solver& solver);

// The message if the balance is not closed, or nothing.
std::optional<std::string> balance_error(const Solver& solver, const EnergyTotals& totals);

class EnergyBalance {
public:
    EnergyBalance() = default;
    EnergyBalance(const Plant<double>& plant, double t, const FullState& y, ContactMode mode);

    double energy_at_start() const { return start_.sum(); }  // J

    // Updates the residual and the totals after each step.
    void update(const Plant<double>& plant, double t, const FullState& y, ContactMode mode);

    const EnergyTotals& totals() const { return totals_; }

private:
    Energies start_{};
    EnergyTotals totals_;
};

// A residual that is NaN counts as infinite.
inline void include_residual(double& largest, double residual) {
    const double size = std::isnan(residual) ? std::numeric_limits<double>::infinity() : std::abs(residual);
    largest = std::max(largest, size);
}

}  // namespace arm3r
