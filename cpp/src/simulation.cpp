#include "simulation.hpp"

#include "at.hpp"
#include "error.hpp"
#include "numbers.hpp"
#include "runs.hpp"
#include "schema.hpp"

namespace arm3r {

std::string steps_used_up(double t) {
    return "solver.max_steps is used up at t = " + shortest(t) +
           " s; stiff friction or contact, or a tolerance too tight?";
}

std::string event_storm(double t) { return "more than 4096 contact events, the last at t = " + shortest(t) + " s"; }

Run simulate(std::span<const double> params, const RunOptions& options) {
    std::vector<Problem> problems = validate(params);
    if (!problems.empty()) throw Error(ARM3R_E_SCENARIO, std::move(problems));
    return is<"solver.method", "dopri5">(params) ? run_adaptively(params, options) : run_marching(params, options);
}

}  // namespace arm3r
