#pragma once
// Runs of one structure side by side in the lanes of a thread; each method is built in a file of its own.

#include "batch/worker.hpp"

namespace arm3r {

// Integrates a run and the following runs with the same key in two lanes or more (lane_group_template.hpp): by RK4 on its grid, by
// Taylor series, or by steps that end at events. `controlled`: with the memory of a continuous controller in the state.
void run_lanes_rk4(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_rk4_controlled(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_taylor(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_to_events(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_to_events_controlled(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);

}  // namespace arm3r
