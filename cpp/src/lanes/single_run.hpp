#pragma once
// Single runs by the methods that march in lanes (lane_run.hpp): to their end, or from sample to sample.

#include "run/interactive_run.hpp"
#include "setup/setup.hpp"

namespace arm3r {

Run run_alone(const Setup& setup, const RunOptions& options);

std::unique_ptr<InteractiveRun> start_interactive_run(const Setup& setup, const RunOptions& options);

// How a single run is made by a method.
struct SingleRunMethod {
    Run (*run)(const Setup& setup, const RunOptions& options);
    std::unique_ptr<InteractiveRun> (*start)(const Setup& setup, const RunOptions& options);
};
// With the memory of a continuous controller in the state, or without one.
SingleRunMethod single_run_to_events();
SingleRunMethod single_run_to_events_with_memory();
SingleRunMethod single_run_on_grid();
SingleRunMethod single_run_on_grid_with_memory();
SingleRunMethod single_run_by_taylor();

}  // namespace arm3r
