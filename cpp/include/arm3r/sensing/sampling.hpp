#pragma once
// Sampling, sensors, observer and estimator of a controller. If all of them are off, the controller is ideal:
// continuous and exact. Slide convention, base axes.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

enum class VelocityEstimate { exact, difference, filtered };
enum class Reaction { ignore, stop, floating, reflex, retreat };

enum : std::size_t { max_delay = 64, max_force_delay = 256 };  // samples

struct SamplingChoices {
    bool on = false, has_delay = false;

    bool operator==(const SamplingChoices&) const = default;
};

template <class P>
struct Sampling : SamplingChoices {
    P start;   // s, of the first sample
    P period;  // s
    P delay;   // samples, from the sensors to the torque
    P seed;    // seed of the noise, a whole number
};

struct SensorChoices {
    VelocityEstimate velocity = VelocityEstimate::exact;
    bool has_encoder = false, has_noise = false, has_resolution = false, has_bias = false, has_analog_filter = false,
         has_filter = false, has_delay = false, has_tool = false;

    bool operator==(const SensorChoices&) const = default;
};

template <class P>
struct Sensors : SensorChoices {
    P encoder_step;       // rad
    P velocity_share;     // weight of a new difference in the filtered rate: 1 - exp(-2 pi f T)
    P noise, resolution;  // N: standard deviation, step
    Vec3<P> bias;         // N
    P analog_rate;        // rad/s, pole of the low-pass before sampling
    P analog_share;       // by which its output approaches a constant force within a period
    P force_share;        // weight of a new sample in the digitally filtered force
    P force_delay;        // samples
    P tool_mass;          // kg
};

struct ObserverChoices {
    bool on = false;
    Reaction reaction = Reaction::ignore;

    bool operator==(const ObserverChoices&) const = default;
};

template <class P>
struct Observer : ObserverChoices {
    Vec3<P> gain, threshold;                 // 1/s, N m
    P hold;                                  // s
    P reflex_gain, retreat_gain;             // 1, rad/(N m s)
    Vec3<P> joint_stiffness, joint_damping;  // N m/rad, N m s/rad
};

// The parameters of a controller that computes at samples.
template <class P>
struct DigitalController {
    Sampling<P> sampling;
    Sensors<P> sensors;
    Observer<P> observer;
    Controller<P> controller;
};

struct EstimationChoices {
    bool on = false, wall_moves = true;

    bool operator==(const EstimationChoices&) const = default;
};

template <class P>
struct Estimation : EstimationChoices {
    P period, start;         // s
    P forgetting;            // forgetting factor: the weight of a sample is multiplied by it at each later sample
    P max_condition;         // the estimate is not valid above it
    P assumed;               // N/m: what a law that asks the estimator goes by where the wall is not identifiable
    P damping, dissipation;  // N s/m, s/m: of the wall, which is fitted as a spring
};

// An external force on the tip, beside that of the wall: it grows linearly during `rise` and then stays constant.
template <class P>
struct ExternalForce {
    bool on = false;
    Vec3<P> force;       // N
    P start, rise, end;  // s; rise: how long the force grows
};

template <class P, class T>
ARM3R_INLINE Vec3<T> external_force_at(const ExternalForce<P>& external_force, const T& t) {  // (8.9)
    const T since = t - external_force.start, o(0.0), l(1.0);
    const T growing = select(t < external_force.start + external_force.rise, min(l, T(since / external_force.rise)), l);
    const T share = select(t >= external_force.start, select(t < external_force.end, growing, o), o);
    return {share * external_force.force[0], share * external_force.force[1], share * external_force.force[2]};
}

}  // namespace arm3r
