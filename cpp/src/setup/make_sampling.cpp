#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "setup/make_controller.hpp"
#include "setup/make_sampling.hpp"

namespace arm3r {
namespace {

using std::numbers::pi;

// The weight of a new sample in a first-order low-pass of samples (8.1).
double share_of(double cutoff, double period) { return 1 - exp(-2 * pi * cutoff * period); }

}  // namespace

Sampling<double> make_sampling(std::span<const double> params) {
    Sampling<double> sampling;
    sampling.on = true;
    sampling.start = at<"time.start">(params);
    sampling.period = 1 / at<"sampling.rate">(params);
    sampling.delay = at<"sampling.delay">(params);
    sampling.has_delay = sampling.delay > 0;
    sampling.seed = at<"sampling.seed">(params);
    return sampling;
}

Sensors<double> make_sensors(std::span<const double> params) {
    const double counts = at<"sensors.encoder.counts">(params), period = 1 / at<"sampling.rate">(params);
    const double cutoff = at<"sensors.force.cutoff">(params), analog = at<"sensors.force.analog_cutoff">(params);
    Sensors<double> sensors;
    sensors.encoder_step = counts > 0 ? 2 * pi / counts : 0;
    sensors.velocity = choice_at<"sensors.velocity.estimate", VelocityEstimate>(params);
    sensors.velocity_share = share_of(at<"sensors.velocity.cutoff">(params), period);
    sensors.noise = at<"sensors.force.noise">(params);
    sensors.bias = vector_at<"sensors.force.bias">(params);
    sensors.resolution = at<"sensors.force.resolution">(params);
    sensors.analog_rate = std::isnan(analog) ? 0 : 2 * pi * analog;
    sensors.analog_share = std::isnan(analog) ? 1 : share_of(analog, period);
    sensors.force_share = std::isnan(cutoff) ? 1 : share_of(cutoff, period);
    sensors.force_delay = at<"sensors.force.delay">(params);
    sensors.tool_mass = at<"sensors.force.tool_mass">(params);
    sensors.has_encoder = sensors.encoder_step > 0;
    sensors.has_noise = sensors.noise > 0;
    sensors.has_resolution = sensors.resolution > 0;
    sensors.has_bias = sensors.bias[0] != 0 || sensors.bias[1] != 0 || sensors.bias[2] != 0;
    sensors.has_analog_filter = !std::isnan(analog);
    sensors.has_filter = !std::isnan(cutoff);
    sensors.has_delay = sensors.force_delay > 0;
    sensors.has_tool = sensors.tool_mass > 0;
    return sensors;
}

Observer<double> make_observer(std::span<const double> params) {
    Observer<double> observer;
    observer.on = true;
    observer.gain = each_axis<"observer.gain">(params);
    observer.threshold = each_axis<"observer.threshold">(params);
    observer.hold = at<"observer.hold">(params);
    observer.reaction = choice_at<"observer.reaction", Reaction>(params);
    observer.reflex_gain = at<"observer.reflex_gain">(params);
    observer.retreat_gain = at<"observer.retreat_gain">(params);
    observer.joint_stiffness = vector_at<"observer.joint_stiffness">(params);
    observer.joint_damping = vector_at<"observer.joint_damping">(params);
    return observer;
}

Estimation<double> make_estimation(std::span<const double> params, const Contact<double>& contact) {
    Estimation<double> estimation;
    estimation.on = true;
    estimation.wall_moves = is<"estimator.wall", "moving">(params);
    estimation.period = 1 / at<"estimator.rate">(params);
    estimation.start = std::max(at<"estimator.start">(params), at<"time.start">(params));
    estimation.forgetting = at<"estimator.forgetting">(params);
    estimation.max_condition = at<"estimator.largest_condition">(params);
    estimation.assumed = at<"controller.assumed_stiffness">(params);
    estimation.damping = contact.damping;
    estimation.dissipation = contact.dissipation;
    return estimation;
}

ExternalForce<double> make_external_force(std::span<const double> params) {
    ExternalForce<double> external_force;
    external_force.on = true;
    external_force.force = vector_at<"push.force">(params);
    external_force.start = at<"push.start">(params);
    external_force.rise = at<"push.rise">(params);
    external_force.end = external_force.start + at<"push.duration">(params);
    return external_force;
}

}  // namespace arm3r
