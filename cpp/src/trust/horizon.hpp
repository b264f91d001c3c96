#pragma once
// The time up to which the joint angles of a run are right; docs/model.md (9.6).

#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

inline constexpr double trusted_error = 1e-6;  // rad

struct Horizon {
    double t;          // s: the last row before the error exceeds trusted_error
    bool is_end;       // it never does
    double end_error;  // rad, at the last row
    double growth;     // until t, of a small change of the start
};

// Simulates the setup three times more, as exact as the run and more. Not with a law of the user's.
Horizon horizon_of(const Setup& setup, const Run& run, const RunOptions& options);

}  // namespace arm3r
