#pragma once
// Runs of one structure side by side in the lanes of a thread; each method is built in a file of its own.

#include "batch/worker.hpp"

namespace arm3r {

// Integrates a run and the following runs with the same key in lanes (lane_group.hpp): by RK4, on its grid or with steps
// that end at events, by Taylor series, by Dormand and Prince. `controlled`: with the memory of a continuous controller in
// the state.
void run_lanes_rk4(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_rk4_controlled(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_located(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_located_controlled(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_taylor(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_dopri5(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);
void run_lanes_dopri5_controlled(int lanes, BatchWorker& worker, const Setup& first, std::size_t run);

}  // namespace arm3r
