#include "lanes/single_run.hpp"

namespace arm3r {
namespace {

SingleRunMethod method_of(const Setup& setup) {
    if (setup.solver.method == SolverMethod::taylor) return single_run_by_taylor();
    const bool remembers = has_memory(setup.plant);
    if (setup.solver.is_on_grid()) return remembers ? single_run_on_grid_with_memory() : single_run_on_grid();
    return remembers ? single_run_to_events_with_memory() : single_run_to_events();
}

}  // namespace

Run run_alone(const Setup& setup, const RunOptions& options) { return method_of(setup).run(setup, options); }

std::unique_ptr<InteractiveRun> start_interactive_run(const Setup& setup, const RunOptions& options) {
    return method_of(setup).start(setup, options);
}

}  // namespace arm3r
