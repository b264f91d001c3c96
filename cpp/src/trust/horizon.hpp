#pragma once
// The time up to which the joint angles of a run are right; docs/model.md (9.6).

#include <optional>

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

// Simulates the setup three times more, more exactly. Not with a law of the user's. Nothing where one of these runs is cut
// short by the caller or a limit, or the run does not log its joint angles and rates.
// The columns that horizon_of() reads of a run.
ColumnSet states_in_log();

std::optional<Horizon> horizon_of(const Setup& setup, const Run& run, const RunOptions& options);

}  // namespace arm3r
