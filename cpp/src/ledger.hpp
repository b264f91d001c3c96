#pragma once
// The energy books of a run, and what they say about it; docs/model.md (4.9).

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "sample.hpp"
#include "setup.hpp"
#include "simulation.hpp"

namespace arm3r {

// J, over a run so far: the largest flow, the largest stock, and the largest residual.
struct Flows {
    double exchanged = 0, held = 0, residual = 0;
};

// What the residual may be at the end, and whether more is the run's outcome or only a warning.
double balance_limit(const Solver& solver, const Flows& flows);
bool is_strict(const Solver& solver);

// Why the balance does not close, or nothing.
std::optional<std::string> balance_complaint(const Solver& solver, const Flows& flows);

class Ledger {
public:
    Ledger(const Setup& setup, const FullState& y, Mode mode);
    // As far as another one of the same setup.
    Ledger(const Setup& setup, const Ledger& other) : setup_(setup), start_(other.start_), flows_(other.flows_) {}

    double energy_at_start() const { return start_.sum(); }  // J

    // After each step: note what the balance leaves over, and the largest flows.
    void close(double t, const FullState& y, Mode mode);

    const Flows& flows() const { return flows_; }

private:
    const Setup& setup_;
    Energies start_;
    Flows flows_;
};

// A residual that is not a number is the largest of all.
inline void note_residual(double& largest, double residual) {
    const double size = std::isnan(residual) ? std::numeric_limits<double>::infinity() : std::abs(residual);
    largest = std::max(largest, size);
}

}  // namespace arm3r
