#pragma once
// What stands between a controller and the arm: when it computes, what its sensors do to the truth, what watches beside it.
// All of it off is the ideal: continuous, exact. Slide convention, base axes.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

enum class VelocityEstimate { exact, difference, filtered };
enum class Reaction { ignore, stop, floating, reflex, retreat };

enum : std::size_t { most_delay = 64, most_force_delay = 256 };  // samples

struct SamplingChoices {
    bool on = false, has_delay = false;

    bool operator==(const SamplingChoices&) const = default;
};

template <class P>
struct Sampling : SamplingChoices {
    P start;   // s, of the first sample
    P period;  // s
    P delay;   // samples, from the sensors to the torque
    P seed;    // of the noise, a whole number
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
    P velocity_share;     // of a new difference in the filtered rate: 1 - exp(-2 pi f T)
    P noise, resolution;  // N: standard deviation, step
    Vec3<P> bias;         // N
    P analog_rate;        // rad/s, pole of the low-pass before sampling
    P force_share;        // of a new sample in the digitally filtered force
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

// A controller that computes at samples, with all that belongs to it.
template <class P>
struct Digital {
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
    P period, start;      // s
    P forgetting;         // weight of a sample per later one
    P largest_condition;  // above it: not identifiable
};

// A force on the tip from outside, beside the wall's: grows in proportion to time for `rise`, then stays.
template <class P>
struct TipLoad {
    bool on = false;
    Vec3<P> force;       // N
    P start, rise, end;  // s; rise: how long it grows
};

template <class P, class T>
ARM3R_INLINE Vec3<T> load_at(const TipLoad<P>& load, const T& t) {  // (8.9)
    const T since = t - load.start, o(0.0), l(1.0);
    const T growing = select(t < load.start + load.rise, min(l, T(since / load.rise)), l);
    const T share = select(t >= load.start, select(t < load.end, growing, o), o);
    return {share * load.force[0], share * load.force[1], share * load.force[2]};
}

}  // namespace arm3r
