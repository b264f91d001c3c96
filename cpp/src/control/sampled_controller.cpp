#include "control/sampled_controller.hpp"

#include <cmath>

#include "arm3r/control/task_space.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "base/number_text.hpp"
#include "control/compiled_laws.hpp"

namespace arm3r {
namespace {

template <class F, class A, class B>
void each_digital_number(F f, A& a, B& b) {
    f(a.sampling.start, b.sampling.start), f(a.sampling.period, b.sampling.period);
    f(a.sampling.delay, b.sampling.delay), f(a.sampling.seed, b.sampling.seed);
    each_sensor_number(f, a.sensors, b.sensors);
    each_observer_number(f, a.observer, b.observer);
    for (int i = 0; i < 3; ++i) f(a.controller.torque[i], b.controller.torque[i]);
    each_arm_number(f, a.controller.model, b.controller.model);
    each_law_number(f, a.controller, b.controller);
}

template <class A, class B>
void copy_digital_choices(const DigitalController<A>& from, DigitalController<B>& to) {
    static_cast<SamplingChoices&>(to.sampling) = from.sampling;
    static_cast<SensorChoices&>(to.sensors) = from.sensors;
    static_cast<ObserverChoices&>(to.observer) = from.observer;
    copy_controller_choices(from.controller, to.controller);
}

}  // namespace

template <class T>
void SampledController<T>::load_lane(int lane, const DigitalController<double>& from,
                                     const Estimation<double>& estimation) {
    const auto set = [&](T& x, double value) { Lanes<T>::set(x, lane, value); };
    law_function = compiled_law<T, T>();
    copy_digital_choices(from, digital_);
    if (from.sampling.on) each_digital_number(set, digital_, from);
    static_cast<EstimationChoices&>(estimation_) = estimation;
    set(estimation_.period, estimation.period), set(estimation_.start, estimation.start);
    set(estimation_.forgetting, estimation.forgetting);
    set(estimation_.max_condition, estimation.max_condition);
    set(estimation_.damping, estimation.damping), set(estimation_.dissipation, estimation.dissipation);
    set(next_estimate_, estimation.on ? estimation.start : never);
    set(estimation_.assumed, estimation.assumed), set(state_.assumed_stiffness, estimation.assumed);
    contact_samples_.load_lane(lane, from.sampling.start);
    estimator_.reset(estimation.wall_moves, [&](T& x) { set(x, 0.0); });
    for (T* zero : {&count_, &outputs_done_, &state_.contact, &state_.force_phase, &state_.collision, &state_.stiffness,
                    &state_.stiffness_sigma, &state_.wall_speed, &state_.identifiable, &quiet_since_, &reacts_,
                    &last_potential_, &early_share_, &estimates_, &samples_in_})
        set(*zero, 0.0);
    for (Vec3<T>* zeros : {&state_.q, &state_.qd, &state_.f_on_tip, &state_.residual, &filtered_, &expected_,
                           &hold_pose_, &last_q_, &last_qd_, &last_desired_, &early_torque_})
        for (int i = 0; i < 3; ++i) set((*zeros)[i], 0.0);
    for (T& number : state_.memory) set(number, 0.0);
    set(next_sample_, from.sampling.on ? from.sampling.start : never);
    set(next_output_, never);
    set(early_share_, from.sampling.delay - std::floor(from.sampling.delay));
    has_output_delay_ = from.sampling.has_delay;
    has_failed_ = false;
    user_status_ = 0;
}

template <class T>
void SampledController<T>::add_noise(const Mask& due, Vec3<T>& f) const {
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(due, lane)) continue;
        const auto seed = static_cast<std::uint64_t>(Lanes<T>::get(digital_.sampling.seed, lane));
        const auto counter = static_cast<std::uint64_t>(Lanes<T>::get(count_, lane));
        const double deviation = Lanes<T>::get(digital_.sensors.noise, lane);
        for (std::uint32_t axis = 0; axis < 3; ++axis)
            Lanes<T>::set(f[axis], lane,
                          Lanes<T>::get(f[axis], lane) + deviation * standard_normal(seed, axis, counter));
    }
}

template <class T>
Vec3<T> SampledController<T>::delayed_force(const Mask& due, const Vec3<T>& f) {
    Vec3<T> seen = f;
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(due, lane)) continue;
        const double now = Lanes<T>::get(count_, lane), delay = Lanes<T>::get(digital_.sensors.force_delay, lane);
        const double position = std::max(0.0, now - delay), before = std::floor(position), share = position - before;
        Vec3<double>& latest = forces_[lane].to_write(now);
        for (int i = 0; i < 3; ++i) latest[i] = Lanes<T>::get(f[i], lane);
        const Vec3<double>&a = forces_[lane].at(before), &b = forces_[lane].at(std::min(now, before + 1));
        for (int i = 0; i < 3; ++i) Lanes<T>::set(seen[i], lane, a[i] + share * (b[i] - a[i]));
    }
    return seen;
}

// The torque of sample k - floor(delay) acts until the next sample; if the delay is not a whole number, the torque
// before it acts for the fractional part first. Their mean is what an integral over the period needs.
template <class T>
void SampledController<T>::enqueue(const Mask& due, const Vec3<T>& output, Vec3<T>& acting) {
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(due, lane)) continue;
        const double now = Lanes<T>::get(count_, lane), delay = Lanes<T>::get(digital_.sampling.delay, lane);
        const double whole = std::floor(delay), share = delay - whole;
        Vec3<double>& latest = outputs_[lane].to_write(now);
        for (int i = 0; i < 3; ++i) latest[i] = Lanes<T>::get(output[i], lane);
        const Vec3<double>&before = outputs_[lane].at(now - whole - 1), &after = outputs_[lane].at(now - whole);
        for (int i = 0; i < 3; ++i) {
            const double early = before[i] - after[i];
            Lanes<T>::set(early_torque_[i], lane, early);
            Lanes<T>::set(mean_acting_[i], lane, after[i] + share * early);
            if (now == 0) Lanes<T>::set(acting[i], lane, after[i]);
        }
        if (now == 0) Lanes<T>::set(next_output_, lane, due_time(lane, 0));
    }
}

template <class T>
void SampledController<T>::apply_queued(const Mask& due, Vec3<T>& acting) {
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(due, lane)) continue;
        const double done = Lanes<T>::get(outputs_done_, lane);
        const Vec3<double>& tau = outputs_[lane].at(done);
        for (int i = 0; i < 3; ++i) Lanes<T>::set(acting[i], lane, tau[i]);
        Lanes<T>::set(outputs_done_, lane, done + 1);
        Lanes<T>::set(next_output_, lane, due_time(lane, done + 1));
    }
}

// The instant at which the torque of a sample begins to act, s.
template <class T>
double SampledController<T>::due_time(int lane, double sample) const {
    const auto get = [lane](const T& x) { return Lanes<T>::get(x, lane); };
    const Sampling<T>& sampling = digital_.sampling;
    return get(sampling.start) + (sample + get(sampling.delay)) * get(sampling.period);
}

template <class T>
void SampledController<T>::call_user_law(const Measurement<T>& sensed, Vec3<T>& tau) {
    tau = {T(0.0), T(0.0), T(0.0)};
    if constexpr (Lanes<T>::count == 1) {
        if (has_failed_) return;
        user_status_ = user.function(user.user, count_, truth_, sensed, state_, user_torque_);
        has_failed_ = user_status_ != 0;
        for (int i = 0; i < 3; ++i) has_failed_ = has_failed_ || !(std::abs(user_torque_[i]) <= max_torque);
        if (!has_failed_) tau = user_torque_;
    }
}

template <class T>
std::string SampledController<T>::error_message() const {
    const double tick = Lanes<T>::get(count_, 0) - 1;
    const double t = Lanes<T>::get(digital_.sampling.start, 0) + tick * Lanes<T>::get(digital_.sampling.period, 0);
    const std::string position = " at tick " + shortest(tick) + ", t = " + shortest(t) + " s";
    if (user_status_ != 0) return "the controller asked to stop with " + std::to_string(user_status_) + position;
    const Vec3<double> tau = user.convention.flipped(user_torque_);
    return "the controller gave the torque [" + shortest(tau[0]) + ", " + shortest(tau[1]) + ", " + shortest(tau[2]) +
           "] N m" + position + "; three finite numbers are needed, at most 1e12 either way";
}

// The energy that the law has put out since the last sample: the work of the applied torques, less the change of the
// potential whose gradient is the law, less the work of the moving reference. It is exact, except for the two torques
// of a delay that is not a whole number of samples, where the accelerations are assumed to be constant.
template <class T>
void SampledController<T>::update_reserve(const Mask& due, const Measurement<T>& sensed) {
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
        const Controller<T>& controller = digital_.controller;
        const Vec3<T> desired = desired_tip(sensed), way = minus(sensed.q, last_q_);
        const T potential = law_potential(controller, sensed.pose, desired);
        T given = dot(mean_acting_, way) - (potential - last_potential_);
        if (has_output_delay_) {
            const T share = 0.5 * early_share_ * (1.0 - early_share_) * digital_.sampling.period;
            given = given - share * dot(early_torque_, minus(sensed.qd, last_qd_));
        }
        if (tracks_path(controller.type)) given = given - work_of_reference(desired);
        T reserve = state_.memory[0] - given;
        if (controller.type == ControllerType::energy_tank) reserve = min(reserve, controller.gains.tank_capacity);
        state_.memory[0] = select(due && count_ > T(0.0), reserve, state_.memory[0]);
        assign_where(due, sensed.q, last_q_);
        assign_where(due, sensed.qd, last_qd_);
        assign_where(due, desired, last_desired_);
        last_potential_ = select(due, potential, last_potential_);
    });
}

// J, from the force at the tip that is equivalent to the torque; a singular pose does not determine that force.
template <class T>
T SampledController<T>::work_of_reference(const Vec3<T>& desired) const {
    const Arm<T>& model = digital_.controller.model;
    const Pose<T> before = pose(last_q_);
    const Vec3<T> force = force_from(model, before, minus(mean_acting_, gravity_torque(model, before)));
    const Vec3<T> moved = minus(desired, last_desired_);
    const Mask stands = dot(moved, moved) == T(0.0) || distance_to_singular(model, before) < T(1e-3);
    return select(stands, T(0.0), T(dot(force, moved)));
}

// The torque that acts `still` periods before that of this sample, and the fraction of a period for which it acts.
template <class T>
T SampledController<T>::pending_torque(const Mask& due, double still, Vec3<T>& acting) const {
    T share(0.0);
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        const double whole = std::floor(Lanes<T>::get(digital_.sampling.delay, lane));
        if (!Lanes<T>::is(due, lane) || still > whole) continue;
        Lanes<T>::set(share, lane, still < whole ? 1.0 : Lanes<T>::get(early_share_, lane));
        const double now = Lanes<T>::get(count_, lane), sample = std::max(0.0, now - still - 1);
        if (now == 0) continue;  // the torque of this sample acts from the start
        for (int i = 0; i < 3; ++i) Lanes<T>::set(acting[i], lane, outputs_[lane].at(sample)[i]);
    }
    return share;
}

// The predicted state of the arm and the reserve when the torque of this sample begins to act.
template <class T>
Prediction<T> SampledController<T>::predict_at_actuation(const Mask& due, const Measurement<T>& sensed,
                                                         const Vec3<T>& output) const {
    Prediction<T> prediction{sensed.q, sensed.qd, sensed.pose, last_potential_, state_.memory[0]};
    if (!has_output_delay_) return prediction;
    const Sampling<T>& sampling = digital_.sampling;
    double longest = 0;
    for (int lane = 0; lane < Lanes<T>::count; ++lane)
        if (Lanes<T>::is(due, lane)) longest = std::max(longest, std::floor(Lanes<T>::get(sampling.delay, lane)));
    for (double still = longest; still >= 0; --still) {
        Vec3<T> acting = output;
        const T time = sampling.period * pending_torque(due, still, acting);
        predict(digital_.controller, last_desired_, acting, time, prediction);
    }
    return prediction;
}

// The braking torque is added to any torque, also outside a virtual wall.
template <class T>
void SampledController<T>::apply_brake(const Mask& due, const Arm<T>& arm, const Measurement<T>& sensed,
                                       Command<T>& command) {
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
        const Controller<T>& controller = digital_.controller;
        const Vec3<T> output = limited(arm, command.tau, controller.saturation);
        const Prediction<T> prediction = predict_at_actuation(due, sensed, output);
        command.tau =
            plus(command.tau, braking_torque(controller, last_desired_, output, digital_.sampling.period, prediction));
    });
}

// Each sample is used once, and in contact only.
template <class T>
void SampledController<T>::estimate(const Mask& due) {
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
        const T o(0.0), l(1.0);
        const auto& sample = contact_samples_.now();
        const Mask counts = due && sample.counts > o;
        const Mask first = counts && samples_in_ == o;
        first_position_ = select(first, sample.position, first_position_);
        first_time_ = select(first, sample.time, first_time_);
        estimator_.add_where(counts, T(sample.position - first_position_), T(sample.time - first_time_), sample.force,
                             sample.variance, estimation_.forgetting);
        contact_samples_.use(due);
        samples_in_ = samples_in_ + select(counts, l, o);
        const WallEstimate<T> answer = estimator_.solve(
            {sample.force_variance, T(estimation_.damping + estimation_.dissipation * abs(sample.force))});
        const Mask is_valid = samples_in_ >= T(8.0) && answer.condition < estimation_.max_condition &&
                              answer.stiffness > least_certainty * answer.sigma;
        tell(due, is_valid, answer);
        estimates_ = estimates_ + select(due, l, o);
        next_estimate_ = select(due, T(estimation_.start + estimates_ * estimation_.period), next_estimate_);
    });
}

template <class T>
void SampledController<T>::forget(const Mask& lost) {
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
        estimator_.forget_where(lost);
        samples_in_ = select(lost, T(0.0), samples_in_);
        tell(lost, !lost, {});
    });
}

// Where it is valid, the estimate is the stiffness of a law that needs one.
template <class T>
void SampledController<T>::tell(const Mask& due, const Mask& is_valid, const WallEstimate<T>& answer) {
    const T o(0.0), l(1.0);
    state_.identifiable = select(due, select(is_valid, l, o), state_.identifiable);
    state_.stiffness = select(due, select(is_valid, answer.stiffness, o), state_.stiffness);
    state_.stiffness_sigma = select(due, select(is_valid, answer.sigma, o), state_.stiffness_sigma);
    state_.wall_speed = select(due, select(is_valid, answer.speed, o), state_.wall_speed);
    const T assumed = select(is_valid, answer.stiffness, estimation_.assumed);
    state_.assumed_stiffness = select(due, assumed, state_.assumed_stiffness);
    if (is_on() && asks_estimator(digital_.controller))
        digital_.controller.gains.assumed_stiffness = state_.assumed_stiffness;
}

// Each member by name: `template class` would also compile the functions that are inlined everywhere (ARM3R_INLINE).
#define ARM3R_SAMPLED_CONTROLLER(...)                                                                                  \
    template void SampledController<__VA_ARGS__>::load_lane(int, const DigitalController<double>&,                     \
                                                            const Estimation<double>&);                                \
    template void SampledController<__VA_ARGS__>::add_noise(const Mask&, Vec3<__VA_ARGS__>&) const;                    \
    template Vec3<__VA_ARGS__> SampledController<__VA_ARGS__>::delayed_force(const Mask&, const Vec3<__VA_ARGS__>&);   \
    template void SampledController<__VA_ARGS__>::enqueue(const Mask&, const Vec3<__VA_ARGS__>&, Vec3<__VA_ARGS__>&);  \
    template void SampledController<__VA_ARGS__>::apply_queued(const Mask&, Vec3<__VA_ARGS__>&);                       \
    template void SampledController<__VA_ARGS__>::call_user_law(const Measurement<__VA_ARGS__>&, Vec3<__VA_ARGS__>&);  \
    template std::string SampledController<__VA_ARGS__>::error_message() const;                                        \
    template void SampledController<__VA_ARGS__>::update_reserve(const Mask&, const Measurement<__VA_ARGS__>&);        \
    template void SampledController<__VA_ARGS__>::apply_brake(const Mask&, const Arm<__VA_ARGS__>&,                    \
                                                              const Measurement<__VA_ARGS__>&, Command<__VA_ARGS__>&); \
    template void SampledController<__VA_ARGS__>::estimate(const Mask&);                                               \
    template void SampledController<__VA_ARGS__>::forget(const Mask&);

ARM3R_LANE_TYPES(ARM3R_SAMPLED_CONTROLLER)

}  // namespace arm3r
