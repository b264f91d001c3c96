#pragma once
// What a run leaves: its numbers, rows, events and messages; and what it may be asked.

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arm3r/arm3r.h"
#include "base/column_memory.hpp"
#include "control/user_law.hpp"
#include "schema/columns.hpp"

namespace arm3r {

struct Event {
    enum Type { make, brk } type;
    double t;                          // s
    std::array<double, 3> q, qd, tip;  // rad, rad/s, m; in the arm's convention
};

// Where det J of a law's model passes 0, though the law inverts J.
struct SingularPassage {
    double t;                 // s
    std::array<double, 3> q;  // rad, in the arm's convention
};

struct Steps {
    std::int64_t accepted = 0, rejected = 0, evaluations = 0;
};

// The numbers of a run (metrics.hpp). Joint vectors in the arm's convention.
struct Metrics {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    arm3r_outcome outcome = ARM3R_RUN_OK;
    double t_end = 0;                  // s, the time reached
    double contacts = 0;               // makes so far
    double first_contact = unknown;    // s
    double first_release = unknown;    // s
    double contact_time = 0;           // s
    double peak_force = 0;             // N, largest normal contact force, on the dense trajectory
    double peak_force_time = unknown;  // s, when that was
    double first_peak = unknown;       // N, largest normal force of the first contact while it is transient
    double first_peak_time = unknown;  // s, when that was
    double final_force = 0;            // N, normal
    double impulse = 0;                // N s, of the normal force
    double ledger_residual = 0;        // J, largest at the end of a step
    std::array<double, 3> q{}, qd{}, tip{};
    double work_of_actuators = 0, work_of_wall = 0, dissipated = 0;  // J
    std::array<double, 4> dissipated_parts{};                        // J: in joints, contact, friction, at edges
    Steps steps;
    // Metrics of the controller (performance.hpp); NaN where they do not apply.
    double force_error_rms = unknown, force_error_peak = unknown, overshoot = unknown;  // N
    double settling_time = unknown;                                                     // s
    double path_error_rms = unknown, path_error_max = unknown;                          // m
    double saturation_share = 0;
    std::array<double, 3> work{};                                                                   // J, of each torque
    double stiffness_estimate = unknown, stiffness_sigma = unknown, wall_speed_estimate = unknown;  // N/m, N/m, m/s
    double stiff_steps = 0;  // accepted steps of the stiff method
};

// What the end of a run tells beside its metrics, in the arm's convention.
struct EndValues {
    std::array<double, 3> qdd, tau, f_on_wall;  // rad/s^2, N m, N
    double depth, beside;                       // m: of the tip behind the face of the wall, and beside the plate
};

struct Run : Metrics, RowTable {
    std::string message;  // why, when the outcome is not ok; "" else
    std::vector<Event> events;
    std::vector<std::string> warnings;
    std::string method;                    // the method of the scenario
    std::string choices;                   // of method auto: which method it used when, and why
    std::array<double, 3> torque_limit{};  // N m; may be inf
    double energy_residual_max = 0;        // J, over steps and rows
    double elapsed_s = 0;                  // wall clock
    bool has_wall = false;
    bool has_user_law = false;                        // the scenario does not determine what the law does
    std::optional<SingularPassage> singular_passage;  // the first one, also between rows; looked for if a run judges
    std::optional<EndValues> at_end;                  // none where the motion is not finite, or there are no rows
    // Observations in the rows; s, and < 0: never.
    double link_behind_wall_since = -1;  // of a link other than at its tip
    double out_of_reach_since = -1;      // of the point that an inner joint loop follows
    double out_of_reach_by = 0;          // m, at most
};

struct RunOptions {
    const volatile std::int32_t* stop = nullptr;
    arm3r_progress progress = nullptr;
    void* user = nullptr;
    double time_limit = 0;                           // s; 0: none
    const std::atomic<bool>* should_stop = nullptr;  // as stop, for threads of our own
    UserLaw user_law = {};
    bool rows = true;     // false: no rows, no warnings, the metrics alone
    bool judges = true;   // false: no warnings, and nothing is said about the rows
    ColumnSet kept = {};  // columns that are kept beside those of the log, where the run has them
};

}  // namespace arm3r
