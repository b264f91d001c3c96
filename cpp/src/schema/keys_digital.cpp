// The keys of samples and sensors, of the momentum observer and of the estimator.

#include "schema/keys.hpp"

#include "schema/choice_words.hpp"
#include "schema/key_builders.hpp"

namespace arm3r {
namespace {

Words with_a_sensor() {
    return laws_that([](const LawProperties& law) { return law.has_model || law.type == ControllerType::user; });
}

std::vector<Key> sampling_keys() {
    std::vector<Key> keys;
    keys.push_back(
        of_kind(Kind::section, number("sampling", {0}, Source::ours, no_bounds, "",
                                      "Sampling of the controller. Absent: the controller computes continuously.")));
    keys.push_back(number("sampling.rate", {1000}, Source::ours, {1e-3, 1e6}, "Hz",
                          "How often the controller computes; its torque is held in between."));
    keys.push_back(number("sampling.delay", {0}, Source::ours, {0, 64}, "samples",
                          "Delay from reading the sensors to the torque, in whole and fractional samples."));
    keys.push_back(of_kind(Kind::integer, number("sampling.seed", {1}, Source::ours, {0, 9007199254740991}, "",
                                                 "Seed of the sensors' noise: the same seed gives the same bits.")));
    keys.push_back(
        of_kind(Kind::section, number("sensors", {0}, Source::ours, no_bounds, "",
                                      "Errors of the controller's sensors. Absent: it reads the true values.")));
    keys.push_back(of_kind(Kind::integer, number("sensors.encoder.counts", {0}, Source::ours, {0, 1e9}, "",
                                                 "Counts per turn to which each joint's encoder rounds; 0: exact.")));
    keys.push_back(choice(
        "sensors.velocity.estimate", words_of<VelocityEstimate>(), Source::ours,
        "How joint rates are measured: exactly, as the difference of two samples, or as that difference after a low-pass."));
    keys.push_back(where("sensors.velocity.estimate", {"filtered"},
                         number("sensors.velocity.cutoff", {50}, Source::ours, {1e-6, 1e6}, "Hz",
                                "Cutoff frequency of the low-pass on the joint rates.")));
    keys.push_back(number("sensors.force.noise", {0}, Source::ours, not_negative, "N",
                          "Standard deviation of the noise in each component of the measured force, in each sample."));
    keys.push_back(number("sensors.force.bias", {0, 0, 0}, Source::ours, {-1e9, 1e9}, "N",
                          "Constant error that is added to the measured force, base axes."));
    keys.push_back(
        number("sensors.force.resolution", {0}, Source::ours, not_negative, "N",
               "Resolution of the measured force: each component is rounded to a multiple of it; 0: exact."));
    keys.push_back(
        derived("no filter", number("sensors.force.analog_cutoff", {unset}, Source::ours, {1e-6, 1e6}, "Hz",
                                    "Cutoff frequency of a first-order low-pass on the force before sampling.")));
    keys.push_back(derived("no filter",
                           number("sensors.force.cutoff", {unset}, Source::ours, {1e-6, 1e6}, "Hz",
                                  "Cutoff frequency of a first-order digital low-pass on the samples of the force.")));
    keys.push_back(number("sensors.force.delay", {0}, Source::ours, {0, 256}, "samples",
                          "Delay of the measured force, in whole and fractional samples."));
    keys.push_back(number("sensors.force.tool_mass", {0}, Source::ours, {0, 1e9}, "kg",
                          "Mass of a tool beyond the force sensor, which measures its weight too."));
    return keys;
}

}  // namespace

void append_sampling(std::vector<Key>& keys) { append_for_laws(keys, with_a_sensor(), sampling_keys()); }

void append_observer(std::vector<Key>& keys) {
    const auto vector = [](Key key) { return with_form(Form::number_or_vector, std::move(key)); };
    keys.push_back(of_kind(Kind::section, number("observer", {0}, Source::ours, no_bounds, "",
                                                 "Momentum observer of the external torque. Absent: none.")));
    keys.push_back(vector(number("observer.gain", {50, unset, unset}, Source::ours, {0, 1e6, true}, "1/s",
                                 "Gain K_O of the momentum observer: the pole of its first-order filter.")));
    keys.push_back(vector(number("observer.threshold", {0.5, unset, unset}, Source::ours, not_negative, "N m",
                                 "Residual above which there is a collision.")));
    keys.push_back(
        number("observer.hold", {0.02}, Source::ours, {0, 1e6}, "s",
               "How long all residuals must stay below half of observer.threshold until the collision is over."));
    keys.push_back(choice(
        "observer.reaction", words_of<Reaction>(), Source::ours,
        "Reaction from a collision on: none, hold the pose, only compensate gravity, push with the residual, or retreat."));
    keys.push_back(where("observer.reaction", {"reflex"},
                         number("observer.reflex_gain", {1}, Source::ours, not_negative, "",
                                "Gain K_R of the reflex tau = tau_g + K_R r.")));
    keys.push_back(where("observer.reaction", {"retreat"},
                         number("observer.retreat_gain", {0.1}, Source::ours, not_negative, "rad/(N m s)",
                                "Gain K_Q of the retreat: rate of the joint reference per residual.")));
    keys.push_back(where("observer.reaction", {"stop", "retreat"},
                         number("observer.joint_stiffness", {200, 200, 100}, Source::ours, not_negative, "N m/rad",
                                "Kp of the PD controller that holds the pose after a collision.")));
    keys.push_back(where("observer.reaction", {"stop", "retreat"},
                         number("observer.joint_damping", {30, 30, 10}, Source::ours, not_negative, "N m s/rad",
                                "Kd of the PD controller that holds the pose after a collision.")));
    keys.push_back(
        of_kind(Kind::section, number("estimator", {0}, Source::ours, no_bounds, "",
                                      "Recursive least squares of the wall's stiffness and speed. Absent: none.")));
    keys.push_back(number(
        "estimator.rate", {500}, Source::ours, {1e-3, 1e6}, "Hz",
        "How often the estimator takes a sample; with a controller without `sampling`, rk4 needs a whole number of steps in between."));
    keys.push_back(number("estimator.forgetting", {0.995}, Source::ours, {0.5, 1}, "",
                          "Forgetting factor: the weight of a sample is multiplied by it at each later one."));
    keys.push_back(
        choice("estimator.wall", {"moving", "fixed"}, Source::ours, "Whether the wall's speed is estimated too."));
    keys.push_back(
        number("estimator.start", {0}, Source::ours, an_instant, "s", "When the estimator takes its first sample."));
    keys.push_back(number("estimator.largest_condition", {1e8}, Source::ours, {1, 1e15}, "",
                          "Condition number of the data above which the wall is not identifiable."));
}

}  // namespace arm3r
