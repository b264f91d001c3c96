#pragma once
// Force and position of one instant in contact, for the estimator (8.7). A controller knows its force sensor: it takes
// the force before the low-pass of samples, the position behind the same analog low-pass as the force, and both from
// before the delay.

#include <cmath>

#include "arm3r/control/controllers.hpp"
#include "arm3r/model/kinematics.hpp"
#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/sensing/estimator.hpp"
#include "arm3r/sensing/sampling.hpp"
#include "control/delay_line.hpp"

namespace arm3r {

template <class T>
class ContactSamples {
public:
    using Mask = typename Lanes<T>::Mask;

    struct Sample {
        T time{0.0}, position{0.0}, force{0.0};  // s, m, N: of the tip and on it, along the normal
        T touches{0.0};                          // 1: the controller is in contact
        T counts{0.0};                           // 1: taken in contact and not yet used by the estimator
        T variance{0.0}, force_variance{0.0};    // m^2, N^2: of position and force
    };

    // start: s, of the first sample; the tip was free before.
    void load_lane(int lane, double start) {
        for (T* zero : {&now_.touches, &now_.counts, &last_position_, &last_force_, &lagged_position_, &now_.variance,
                        &now_.force_variance, &before_last_position_, &in_contact_})
            Lanes<T>::set(*zero, lane, 0.0);
        Lanes<T>::set(free_until_, lane, start);
    }

    const Sample& now() const { return now_; }
    ARM3R_INLINE void use(const Mask& due) { now_.counts = select(due, T(0.0), now_.counts); }

    // Without sensors: in the contact that `seen` tells, with all that acts on the tip.
    ARM3R_INLINE void take(const Mask& due, const Arm<T>& arm, const Measurement<T>& seen) {
        store(due, seen.contact > T(0.0), seen.t, position_of(due, arm, seen), dot(seen.n, seen.f_on_tip));
    }

    // The sample of this number by the sensors of a controller; `force`: N, before the digital low-pass and the delay.
    ARM3R_INLINE void take_sensed(const Mask& due, const T& number, const DigitalController<T>& digital,
                                  const Measurement<T>& seen, const Vec3<T>& force) {
        const Sensors<T>& sensors = digital.sensors;
        const T o(0.0), position = position_of(due, digital.controller.model, seen), pressing = dot(seen.n, force);
        T felt = pressing, doubt = 2.0 * sensors.noise;  // N: the force before the analog low-pass
        if (sensors.has_analog_filter) {
            felt = last_force_ + (pressing - last_force_) / sensors.analog_share;
            doubt = doubt * 1.5 / sensors.analog_share;
        }
        Vec3<T> then{lagged(due, digital, seen.contact > o, position), pressing, felt};
        T age(0.0);
        if (sensors.has_delay) age = delay(due, number, sensors.force_delay, then);
        const Mask touches = seen.contact > o && then[2] > digital.controller.gains.contact_off - doubt;
        free_until_ = select(due && !touches, seen.t, free_until_);
        const Mask settled = seen.t - free_until_ >= settling_time(digital);
        store(due, touches, T(seen.t - age * digital.sampling.period), then[0], then[1]);
        now_.counts = select(due && !settled, o, now_.counts);
        set_variances(due, digital, seen, T(position - 2.0 * last_position_ + before_last_position_));
        before_last_position_ = select(due, last_position_, before_last_position_);
        last_position_ = select(due, position, last_position_);
        last_force_ = select(due, pressing, last_force_);
    }

private:
    // Along the pressing direction. Where the normal turns, the way is that from where the contact began, so that it is
    // the same whatever the origin: -n . (x - x0), but for a constant.
    ARM3R_INLINE T position_of(const Mask& due, const Arm<T>& arm, const Measurement<T>& seen) {
        const T o(0.0);
        const Vec3<T> tip = tip_position(arm, seen.pose);
        const Mask begins = due && !(in_contact_ > o);
        for (int i = 0; i < 3; ++i) {
            began_at_[i] = select(begins, tip[i], began_at_[i]);
            began_with_[i] = select(begins, seen.n[i], began_with_[i]);
        }
        in_contact_ = select(due, select(seen.contact > o, T(1.0), o), in_contact_);
        const Vec3<T> turned = seen.n - began_with_;
        return dot(turned, began_at_) - dot(seen.n, tip);
    }

    ARM3R_INLINE void store(const Mask& due, const Mask& touches, const T& time, const T& position, const T& force) {
        now_.time = select(due, time, now_.time);
        now_.position = select(due, position, now_.position);
        now_.force = select(due, force, now_.force);
        now_.touches = select(due, select(touches, T(1.0), T(0.0)), now_.touches);
        now_.counts = select(due, now_.touches, now_.counts);
        now_.variance = select(due, T(1e-26 * position * position), now_.variance);
    }

    // The position behind the analog low-pass of the force, which begins with the contact; exact where the tip moves
    // evenly between two samples.
    ARM3R_INLINE T lagged(const Mask& due, const DigitalController<T>& digital, const Mask& touches,
                          const T& position) {
        const Sensors<T>& sensors = digital.sensors;
        if (!sensors.has_analog_filter) return position;
        const T share = sensors.analog_share, lead = 1.0 - share / (sensors.analog_rate * digital.sampling.period);
        const T next =
            lagged_position_ + share * (last_position_ - lagged_position_) + lead * (position - last_position_);
        lagged_position_ = select(due, select(touches, next, position), lagged_position_);
        return lagged_position_;
    }

    // Replaces `sample` by the one that the delayed force is of, and returns its age in whole samples.
    [[gnu::noinline]] T delay(const Mask& due, const T& number, const T& delay, Vec3<T>& sample) {
        T age(0.0);
        for (int lane = 0; lane < Lanes<T>::count; ++lane) {
            if (!Lanes<T>::is(due, lane)) continue;
            const double now = Lanes<T>::get(number, lane), whole = std::ceil(Lanes<T>::get(delay, lane));
            Vec3<double>& latest = samples_[lane].to_write(now);
            for (int i = 0; i < 3; ++i) latest[i] = Lanes<T>::get(sample[i], lane);
            const Vec3<double>& then = samples_[lane].at(now - whole);
            for (int i = 0; i < 3; ++i) Lanes<T>::set(sample[i], lane, then[i]);
            Lanes<T>::set(age, lane, std::min(whole, now));
        }
        return age;
    }

    // How long after contact began a sample is the first to count, s: eight time constants of the analog low-pass have
    // forgotten where exactly it began. Rounding of the instants, which depends on time.start, does not add a sample.
    ARM3R_INLINE static T settling_time(const DigitalController<T>& digital) {
        const Sensors<T>& sensors = digital.sensors;
        T samples(-1e-6), time(0.0);
        if (sensors.has_delay) samples = T(1.0 - 1e-6);
        if (sensors.has_analog_filter) {
            samples = sensors.force_delay + (2.0 - 1e-6);
            time = 8.0 / sensors.analog_rate;
        }
        return time + samples * digital.sampling.period;
    }

    // Noise, and roundings to steps of the sensors; that of numbers comes with every position. Behind the analog low-pass
    // the position is known but for the part of its way in a sample that was uneven, by the bend of its last three, m.
    ARM3R_INLINE void set_variances(const Mask& due, const DigitalController<T>& digital, const Measurement<T>& seen,
                                    const T& bend) {
        const Sensors<T>& sensors = digital.sensors;
        const auto variance = [](const T& step) ARM3R_INLINE_LAMBDA { return T(step * step * (1.0 / 12)); };
        const T force = sensors.noise * sensors.noise + variance(sensors.resolution);
        now_.force_variance = select(due, force, now_.force_variance);
        T position = now_.variance;
        if (sensors.has_analog_filter) position = position + uneven * uneven * bend * bend;
        if (sensors.has_encoder) {
            const Vec3<T> per_angle = transposed_times(jacobian(digital.controller.model, seen.pose), seen.n);
            position = position + variance(sensors.encoder_step) * dot(per_angle, per_angle);
        }
        now_.variance = select(due, position, now_.variance);
    }

    static constexpr double uneven = 0.25;

    Sample now_;
    Vec3<T> began_at_{T(0.0), T(0.0), T(0.0)}, began_with_ = began_at_;  // m: the tip, and the normal, as contact began
    T in_contact_{0.0};                                                  // 1: at the sample before
    T before_last_position_{0.0};                                        // m
    T last_position_{0.0}, last_force_{0.0}, lagged_position_{0.0}, free_until_{0.0};  // m, N, m, s
    std::array<DelayLine<max_force_delay + 2>, Lanes<T>::count> samples_;  // position, force, force before the low-pass
};

}  // namespace arm3r
