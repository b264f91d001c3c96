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

void refuse_missing_law() {
    throw Error(
        ARM3R_E_SCENARIO,
        {{.code = "scenario.needs_law",
          .path = "controller.type",
          .message = "this controller is a function of your own, and there is none here",
          .got = "user",
          .allowed = "",
          .hint = "in Python scenario.run(controller=f), in C arm3r_scenario_control; or choose another type"}});
}

Run simulate(std::span<const double> params, const RunOptions& options) {
    std::vector<Problem> problems = validate(params);
    if (!problems.empty()) throw Error(ARM3R_E_SCENARIO, std::move(problems));
    if (is<"controller.type", "user">(params) && !options.user_law.function) refuse_missing_law();
    const bool marches = is<"solver.method", "rk4">(params) || is<"solver.method", "taylor">(params);
    return marches ? run_marching(params, options) : run_adaptively(params, options);
}

}  // namespace arm3r
