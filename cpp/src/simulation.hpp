#pragma once
// A run: a pure function of its parameters, ending in exactly one outcome.

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "arm3r/arm3r.h"
#include "row_memory.hpp"

namespace arm3r {

struct Event {
    enum Type { make, brk } type;
    double t;                          // s
    std::array<double, 3> q, qd, tip;  // rad, rad/s, m; in the arm's convention
};

struct Steps {
    std::int64_t accepted = 0, rejected = 0, evaluations = 0;
};

// The numbers of a run (summary.hpp). Joint vectors in the arm's convention.
struct Metrics {
    arm3r_outcome outcome = ARM3R_RUN_OK;
    double t_end = 0;                                                 // s, the time reached
    double contacts = 0;                                              // makes so far
    double first_contact = std::numeric_limits<double>::quiet_NaN();  // s
    double first_release = std::numeric_limits<double>::quiet_NaN();  // s
    double contact_time = 0;                                          // s
    double peak_force = 0;       // N, largest normal contact force, on the dense trajectory
    double final_force = 0;      // N, normal
    double impulse = 0;          // N s, of the normal force
    double ledger_residual = 0;  // J, largest at the end of a step
    std::array<double, 3> q{}, qd{}, tip{};
    std::array<double, 3> books{};  // J: work of the actuators, work of the wall, dissipated energy
    Steps steps;
};

// Columns lie one after the other in one block: column i is data[i*capacity .. i*capacity + rows).
struct Run : Metrics {
    std::string message;               // why, when the outcome is not ok; "" else
    std::vector<std::size_t> columns;  // indices into column_table() (columns.hpp), in order
    std::size_t rows = 0, capacity = 0;
    RowMemory data;
    std::vector<Event> events;
    std::vector<std::string> warnings;
    double energy_residual_max = 0;  // J, over steps and rows
    double elapsed_s = 0;            // wall clock

    std::span<const double> column(std::size_t i) const { return {data.get() + i * capacity, rows}; }
};

struct RunOptions {
    const volatile std::int32_t* stop = nullptr;
    arm3r_progress progress = nullptr;
    void* user = nullptr;
    double time_limit = 0;                           // s; 0: none
    const std::atomic<bool>* should_stop = nullptr;  // as stop, for threads of our own
    bool rows = true;                                // false: no rows, no warnings, the metrics alone
};

// params: a valid flat parameter array (schema.hpp). Throws Error when it is not, or when the run is too large.
Run simulate(std::span<const double> params, const RunOptions& options);

}  // namespace arm3r
