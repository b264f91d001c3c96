#include "batch/simulation.hpp"

#include "base/error.hpp"
#include "lanes/single_run.hpp"
#include "schema/schema.hpp"

namespace arm3r {

void refuse_missing_law() {
    throw Error(
        ARM3R_E_SCENARIO,
        {{.code = "scenario.needs_law",
          .path = "controller.type",
          .message = "this controller is a function of your own, and there is none here",
          .got = "user",
          .hint = "in Python scenario.run(controller=f), in C arm3r_scenario_control; or choose another type"}});
}

void refuse_other_controllers(std::span<const double> params) {
    if (choice_of(params, "controller.type") == "user") return;
    throw Error(ARM3R_E_SCENARIO, {{.code = "scenario.other_choice",
                                    .path = "controller.type",
                                    .message = "a law of your own takes the place of no other controller",
                                    .got = choice_of(params, "controller.type"),
                                    .allowed = "user"}});
}

Run simulate(const Setup& setup, const RunOptions& options) {
    if (setup.controller().type == ControllerType::user && !options.user_law.function) refuse_missing_law();
    return run_alone(setup, options);
}

}  // namespace arm3r
