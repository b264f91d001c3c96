#pragma once
// The energy books of a run, and what they say about it; docs/model.md (4.9).

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "record/row.hpp"
#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// J, over a run so far: the largest flow, the largest stock, and the largest residual; and the largest force of the wall
// times the arm's reach, of which the rounding of a place makes an energy.
struct Flows {
    double exchanged = 0, held = 0, residual = 0, leverage = 0;
};

inline double leverage(const Plant<double>& plant, double peak_force) {
    return plant.acts_on_arm ? peak_force * (plant.arm.link2.length + plant.arm.link3.length) : 0;
}

// What the residual may be at the end, and whether more is the run's outcome or only a warning.
double balance_limit(const Solver& solver, const Flows& flows);
bool is_strict(const Solver& solver);

// Why the balance does not close, or nothing.
std::optional<std::string> balance_complaint(const Solver& solver, const Flows& flows);

class Ledger {
public:
    Ledger() = default;
    Ledger(const Plant<double>& plant, double t, const FullState& y, Mode mode);

    double energy_at_start() const { return start_.sum(); }  // J

    // After each step: note what the balance leaves over, and the largest flows.
    void close(const Plant<double>& plant, double t, const FullState& y, Mode mode);

    const Flows& flows() const { return flows_; }

private:
    Energies start_{};
    Flows flows_;
};

// A residual that is not a number is the largest of all.
inline void note_residual(double& largest, double residual) {
    const double size = std::isnan(residual) ? std::numeric_limits<double>::infinity() : std::abs(residual);
    largest = std::max(largest, size);
}

}  // namespace arm3r
