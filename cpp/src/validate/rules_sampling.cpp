// The rules of samples, sensors, observer and an external force.

#include "base/number_text.hpp"
#include "setup/make_controller.hpp"
#include "validate/rules.hpp"

namespace arm3r {
namespace {

// A section that needs a controller that computes.
template <Name section>
void need_computing(std::span<const double> params, ProblemList& problem_list) {
    if (at<section>(params) == 0 || key_exists(known_key(section), params)) return;
    problem_list.add([&] {
        return Problem{.code = "scenario.other_choice",
                       .path = std::string(section),
                       .message = "controller.type " + choice_of(params, "controller.type") +
                                  " computes nothing and reads nothing",
                       .hint = "take the section out, or choose a controller"};
    });
}

// A feature that exists with sampling only.
void need_samples(bool has_it, const char* path, const char* what, ProblemList& problem_list) {
    if (!has_it) return;
    problem_list.add([&] {
        return Problem{.code = "scenario.needs_sampling",
                       .path = path,
                       .message = std::string(what) + " exists sample by sample only",
                       .got = "a controller that computes continuously",
                       .hint = "add a sampling section, such as `sampling: {rate: 1000}`"};
    });
}

void check_digital(const Setup& setup, ProblemList& problem_list) {
    if (setup.digital.sampling.on) return;
    const Controller<double>& controller = setup.controller();
    need_samples(controller.type == ControllerType::virtual_wall && controller.controls_passivity,
                 "controller.passivity_control", "the energy that sampling creates", problem_list);
    need_samples(setup.observes() && setup.digital.observer.reaction != Reaction::ignore, "observer.reaction",
                 "a reaction to a collision", problem_list);
    const Sensors<double>& sensors = setup.digital.sensors;
    need_samples(sensors.has_encoder, "sensors.encoder.counts", "a reading of an encoder", problem_list);
    need_samples(sensors.velocity != VelocityEstimate::exact, "sensors.velocity.estimate",
                 "a rate from differences of angles", problem_list);
    need_samples(sensors.has_noise, "sensors.force.noise", "noise", problem_list);
    need_samples(sensors.has_resolution, "sensors.force.resolution", "rounding to a resolution", problem_list);
    need_samples(sensors.has_filter, "sensors.force.cutoff", "a digital filter", problem_list);
    need_samples(sensors.has_delay, "sensors.force.delay", "a delay of samples", problem_list);
    need_samples(sensors.has_tool, "sensors.force.tool_mass",
                 "the weight of a tool, which gravity adds to the reading,", problem_list);
}

// ---- rk4: samples and delayed torques must be at the ends of steps

bool is_whole(double x) { return std::abs(x - nearest_integer(x)) <= 1e-9 * std::max(1.0, std::abs(x)); }

// The step nearest to `step` that divides the period, and the delay too; 0 if none is near.
double nearest_working_step(const Sampling<double>& sampling, double step) {
    constexpr double farthest = 1000;
    const double parts = std::floor(sampling.period / step);
    const auto works = [&](double n) { return n >= 1 && is_whole(n * sampling.delay); };
    double longer = parts, shorter = parts + 1;
    while (longer >= 1 && parts - longer < farthest && !works(longer)) --longer;
    while (shorter - parts < farthest && !works(shorter)) ++shorter;
    const double above = works(longer) ? sampling.period / longer : 0,
                 below = works(shorter) ? sampling.period / shorter : 0;
    return above > 0 && (below == 0 || above - step < step - below) ? above : below;
}

void check_grid(const Setup& setup, ProblemList& problem_list) {
    const Sampling<double>& sampling = setup.digital.sampling;
    const double step = setup.solver.step, parts = sampling.period / step, later = sampling.delay * parts;
    if (!setup.solver.is_on_grid() || !sampling.on) return;
    const bool fits = parts > 0.5 && is_whole(parts);
    if (fits && is_whole(later)) return;
    problem_list.add([&] {
        const double works = nearest_working_step(sampling, step);
        const std::string period = shortest(sampling.period) + " s";
        return Problem{
            .code = "scenario.grid",
            .path = "solver.step",
            .message = fits ? "the delay of the torque, " + shortest(sampling.delay) + " of " + period +
                                  ", is no whole number of steps"
                            : "the period of sampling.rate, " + period + ", is no whole number of steps",
            .got = shortest(step) + " s",
            .allowed = "a step that parts " + std::string(fits ? "the delay and " : "") + "the period evenly",
            .hint =
                works > 0 ? "the nearest is " + shortest(works) + " s" : "let sampling.delay be a simpler fraction"};
    });
}

// The estimator uses the samples of a sampled controller, if there is one; else it samples at the ends of steps.
void check_estimates(const Setup& setup, ProblemList& problem_list) {
    const Estimation<double>& estimation = setup.estimation;
    if (!setup.solver.is_on_grid() || !estimation.on || setup.digital.sampling.on) return;
    const double step = setup.solver.step, later = estimation.start - setup.start;
    const double parts = estimation.period / step, nearest = std::max(1.0, nearest_integer(parts));
    const bool fits = is_whole(parts) && parts > 0.5;
    if (fits && is_whole(later / step)) return;
    problem_list.add([&] {
        const std::string period = shortest(estimation.period) + " s", begin = shortest(later) + " s";
        return Problem{
            .code = "scenario.grid",
            .path = fits ? "estimator.start" : "solver.step",
            .message = fits ? "the time from the start of the run to the estimator's first sample, " + begin +
                                  ", is no whole number of steps"
                            : "the period of estimator.rate, " + period + ", is no whole number of steps",
            .got = fits ? shortest(estimation.start) + " s" : shortest(step) + " s",
            .allowed = fits ? "a whole number of steps of " + shortest(step) + " s after the start"
                            : "a step that parts the period evenly",
            .hint = "the nearest is " +
                    shortest(fits ? setup.start + nearest_integer(later / step) * step : estimation.period / nearest) +
                    " s"};
    });
}

// ---- taylor: between the samples everything must be a series

void check_series(std::span<const double> params, const Setup& setup, ProblemList& problem_list) {
    if (setup.solver.method != SolverMethod::taylor) return;
    const auto refuse = [&](const char* path, const std::string& of, const std::string& hint) {
        problem_list.add([&] {
            return Problem{
                .code = "scenario.no_series", .path = path, .message = "taylor has no series of " + of, .hint = hint};
        });
    };
    const std::string samples = "add a sampling section, such as `sampling: {rate: 1000}`, or use method: dopri5";
    if (has_law(setup.controller().type) && !setup.digital.sampling.on)
        refuse("solver.method",
               "a law that computes continuously, controller.type " + choice_of(params, "controller.type"), samples);
    if (setup.observes() && !setup.digital.sampling.on)
        refuse("observer", "an observer that computes continuously", samples);
    if (setup.plant.external_force.on) refuse("push", "a push from outside", "use method: dopri5");
    if (setup.digital.sensors.has_analog_filter)
        refuse("sensors.force.analog_cutoff", "a filter before the samples", "use method: dopri5");
}

}  // namespace

void check_sampling_keys(std::span<const double> params, ProblemList& problem_list) {
    need_computing<"sampling">(params, problem_list);
    need_computing<"sensors">(params, problem_list);
}

void check_sampling(std::span<const double> params, const Setup& setup, ProblemList& problem_list) {
    check_digital(setup, problem_list);
    check_grid(setup, problem_list);
    check_estimates(setup, problem_list);
    check_series(params, setup, problem_list);
}

}  // namespace arm3r
