#pragma once
// The time up to which the joint angles of a run are right; docs/model.md (9.6).

#include <optional>
#include <string>

#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

inline constexpr double trusted_error = 1e-6;  // rad

struct Horizon {
    double t;             // s: the last row before the error exceeds trusted_error, or can no longer be told
    bool is_end;          // it never does
    double end_error;     // rad, at the last row at which it can be told
    double end_error_at;  // s, when that is
    double growth;        // until t, of a small change of the start
    std::string cause;    // why it cannot be told up to the last row; "" where it can
};

// The columns that horizon_of() reads of a run.
ColumnSet states_in_log();

// Simulates the setup three times more, more exactly. Not with a law of the user's. Nothing where one of these runs is cut
// short by the caller or a limit, or the run does not log its joint angles and rates.
std::optional<Horizon> horizon_of(const Setup& setup, const Run& run, const RunOptions& options);

}  // namespace arm3r
