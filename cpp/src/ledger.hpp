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

class Ledger {
public:
    Ledger(const Setup& setup, const FullState& y, Mode mode);

    double energy_at_start() const { return start_.sum(); }  // J

    // After each step: note in `run` what the balance leaves over, and remember the largest flows.
    void close(double t, const FullState& y, Mode mode, Run& run);

    // At the end: why the balance does not close, or nothing.
    std::optional<std::string> complaint(const Run& run) const;

    // Whether a complaint is the run's outcome or only a warning.
    bool is_strict() const;

private:
    double tolerance() const;

    const Setup& setup_;
    Energies start_;
    double exchanged_ = 0, held_ = 0;  // J, the largest flow and the largest stock of the run
};

// A residual that is not a number is the largest of all.
inline void note_residual(double& largest, double residual) {
    const double size = std::isnan(residual) ? std::numeric_limits<double>::infinity() : std::abs(residual);
    largest = std::max(largest, size);
}

}  // namespace arm3r
