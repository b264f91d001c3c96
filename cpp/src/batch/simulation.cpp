#include "batch/simulation.hpp"

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "lanes/single_lane_run.hpp"
#include "run/adaptive_run.hpp"
#include "schema/param_access.hpp"
#include "schema/schema.hpp"
#include "validate/validate.hpp"

namespace arm3r {

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
