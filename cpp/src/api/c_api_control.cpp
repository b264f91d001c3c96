// The part of the C interface with the caller's own controller: a law as a callback, and a simulation that the caller
// steps.

#include <atomic>
#include <cmath>
#include <memory>

#include "api/c_api.hpp"
#include "base/number_text.hpp"
#include "batch/law_adapter.hpp"
#include "batch/simulation.hpp"
#include "control/controller_view.hpp"
#include "lanes/single_run.hpp"
#include "run/interactive_run.hpp"
#include "schema/schema.hpp"
#include "setup/setup.hpp"
#include "validate/validate.hpp"

using namespace arm3r;

namespace {

Run run_with_law(std::span<const double> params, const Setup& setup, arm3r_law function, void* user,
                 RunOptions options) {
    refuse_other_controllers(params);
    LawAdapter law(function, user, setup);
    options.user_law = law.user_law();
    return simulate(setup, options);
}

}  // namespace

int32_t arm3r_params_control(const double* params, size_t count, arm3r_law law, void* user,
                             const arm3r_run_options* options, arm3r_run** run) {
    return guard([&] {
        need(reinterpret_cast<const void*>(law), "law");
        need(run, "run");
        refuse_trust(options);
        auto handle = std::make_unique<arm3r_run>();
        const std::span<const double> numbers = params_in(params, count);
        handle->run = run_with_law(numbers, valid_setup(numbers), law, user, options_in(options));
        *run = handle.release();
    });
}

int32_t arm3r_scenario_control(const arm3r_scenario* scenario, arm3r_law law, void* user,
                               const arm3r_run_options* options, arm3r_run** run) {
    return guard([&] {
        need(scenario, "scenario");
        need(reinterpret_cast<const void*>(law), "law");
        need(run, "run");
        refuse_trust(options);
        const Resolved& resolved = scenario->resolved();
        RunOptions chosen = options_in(options);
        chosen.kept = columns_in(resolved.checks);
        auto handle = std::make_unique<arm3r_run>();
        handle->run = with_locations(scenario->scenario,
                                     [&] { return run_with_law(resolved.params, resolved.setup, law, user, chosen); });
        describe(*handle, resolved, scenario->yaml());
        *run = handle.release();
    });
}

// ---- a simulation that the caller steps

struct arm3r_simulation {
    std::shared_ptr<const Resolved> resolved;
    std::shared_ptr<const std::string> yaml;
    std::shared_ptr<const LawView> view;
    std::unique_ptr<InteractiveRun> run;
    arm3r_law_state last{};  // as seen at the last sample that got a torque
    mutable std::atomic_flag busy{};

    arm3r_simulation() { last.struct_size = sizeof last; }
};

namespace {

class SimulationLock {
public:
    explicit SimulationLock(const arm3r_simulation* simulation)
        : flag_((need(simulation, "simulation"), simulation->busy)) {
        if (flag_.test_and_set()) throw Error(ARM3R_E_BUSY, "the simulation is in use by another call");
    }
    ~SimulationLock() { flag_.clear(); }
    SimulationLock(const SimulationLock&) = delete;
    SimulationLock& operator=(const SimulationLock&) = delete;

private:
    std::atomic_flag& flag_;
};

struct CallersTorque {
    const LawView& view;
    arm3r_law_state& state;
    Vec3<double> tau{0, 0, 0};

    static int call(void* self, double tick, const GroundTruth& truth, const Measurement<double>& sensed,
                    const ControllerState<double>& controller_state, Vec3<double>& tau) {
        CallersTorque& caller = *static_cast<CallersTorque*>(self);
        caller.view.fill_state(tick, truth, sensed, controller_state, caller.state);
        tau = caller.tau;
        return 0;
    }
};

arm3r_law_state present_state(const arm3r_simulation& simulation) {
    arm3r_law_state state = simulation.last;
    if (simulation.run->is_over()) return state;
    CallersTorque nothing{*simulation.view, state};
    simulation.run->preview({CallersTorque::call, &nothing});
    return state;
}

void check_torque(const double* tau) {
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(tau[i]) <= max_torque))
            throw Error(ARM3R_E_VALUE, {{.code = "argument.value",
                                         .path = "tau[" + std::to_string(i) + "]",
                                         .message = "not a torque that can be applied",
                                         .got = shortest(tau[i]),
                                         .allowed = "finite, at most 1e12 N m either way"}});
}

void apply_until_next_sample(arm3r_simulation& simulation, const double* tau) {
    check_pointer(tau, "tau");
    check_torque(tau);
    if (simulation.run->is_over())
        throw Error(ARM3R_E_OVER, "the simulation is over at t = " + shortest(simulation.last.t) + " s");
    CallersTorque caller{*simulation.view, simulation.last, simulation.view->torque(tau)};
    simulation.run->set_user_law({CallersTorque::call, &caller});
    simulation.run->advance();
}

std::unique_ptr<arm3r_simulation> copied(const arm3r_simulation& from) {
    auto copy = std::make_unique<arm3r_simulation>();
    copy->resolved = from.resolved;
    copy->yaml = from.yaml;
    copy->view = from.view;
    copy->run = from.run->copy();
    copy->last = from.last;
    return copy;
}

}  // namespace

int32_t arm3r_simulation_create(const arm3r_scenario* scenario, arm3r_simulation** simulation) {
    return guard([&] {
        need(scenario, "scenario");
        need(simulation, "simulation");
        auto handle = std::make_unique<arm3r_simulation>();
        handle->resolved = std::make_shared<Resolved>(scenario->resolved());
        handle->yaml = std::make_shared<std::string>(scenario->yaml());
        with_locations(scenario->scenario, [&] {
            refuse_other_controllers(handle->resolved->params);
            const Setup& setup = handle->resolved->setup;
            handle->view = std::make_shared<LawView>(setup);
            handle->run = start_interactive_run(setup, {.kept = columns_in(handle->resolved->checks)});
        });
        *simulation = handle.release();
    });
}

void arm3r_simulation_free(arm3r_simulation* simulation) { delete simulation; }

int32_t arm3r_simulation_is_over(const arm3r_simulation* simulation, int32_t* is_over) {
    return guard([&] {
        const SimulationLock lock(simulation);
        need(is_over, "is_over");
        *is_over = simulation->run->is_over();
    });
}

int32_t arm3r_simulation_state(const arm3r_simulation* simulation, arm3r_law_state* state) {
    return guard([&] {
        const SimulationLock lock(simulation);
        need(state, "state");
        *state = present_state(*simulation);
    });
}

int32_t arm3r_simulation_step(arm3r_simulation* simulation, const double* tau) {
    return guard([&] {
        const SimulationLock lock(simulation);
        apply_until_next_sample(*simulation, tau);
    });
}

int32_t arm3r_simulation_advance(arm3r_simulation* simulation, const double* tau, arm3r_law_state* state,
                                 int32_t* is_over) {
    return guard([&] {
        const SimulationLock lock(simulation);
        need(state, "state");
        need(is_over, "is_over");
        apply_until_next_sample(*simulation, tau);
        *state = present_state(*simulation);
        *is_over = simulation->run->is_over();
    });
}

int32_t arm3r_simulation_copy(const arm3r_simulation* simulation, arm3r_simulation** copy) {
    return guard([&] {
        const SimulationLock lock(simulation);
        need(copy, "copy");
        *copy = copied(*simulation).release();
    });
}

int32_t arm3r_simulation_restore(arm3r_simulation* simulation, const arm3r_simulation* from) {
    return guard([&] {
        const SimulationLock lock(simulation);
        need(from, "from");
        if (from == simulation) return;
        const SimulationLock other(from);
        if (*from->yaml != *simulation->yaml) throw Error(ARM3R_E_VALUE, "`from` is a simulation of another scenario");
        simulation->run = from->run->copy();
        simulation->last = from->last;
    });
}

int32_t arm3r_simulation_run(const arm3r_simulation* simulation, arm3r_run** run) {
    return guard([&] {
        const SimulationLock lock(simulation);
        need(run, "run");
        auto handle = std::make_unique<arm3r_run>();
        handle->run = simulation->run->snapshot();
        describe(*handle, *simulation->resolved, simulation->yaml->c_str());
        *run = handle.release();
    });
}
