#pragma once
// A sampled controller for an arm that moves continuously, lane by lane: what it measures, computes and holds;
// docs/model.md, section 8. The order is sensors, law, reaction, limit, delay, hold. There are three different torques
// (8.3): that of the law, the output of the controller after the limit, and the one that acts on the joints after the
// delay. Slide convention.

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "arm3r/control/energy_reserve.hpp"
#include "arm3r/lanes.hpp"
#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/numbers/random.hpp"
#include "arm3r/numbers/widths.hpp"
#include "arm3r/sensing/estimator.hpp"
#include "control/contact_samples.hpp"
#include "control/delay_line.hpp"
#include "control/user_law.hpp"

namespace arm3r {

// The output of the plant at an instant.
template <class T>
struct PlantOutput {
    Measurement<T> measurement;  // true values, until a sample replaces them by those of the sensors
    Vec3<T> f_filtered;          // N, after the analog filter, if there is one
};

// At time t, with `f_wall`, N, the force of the wall on the tip, and `wall` if the plant has one.
template <class T, std::size_t N>
ARM3R_INLINE PlantOutput<T> plant_output(const Plant<T>& plant, const WallState<T>& wall, const T& t,
                                         const State<T, N>& y, const Pose<T>& p, const Vec3<T>& f_wall) {
    const T o(0.0);
    Vec3<T> f = f_wall, n = zero_vector<T>();
    T face = o, contact = o;
    if (plant.has_wall) {
        n = normal(plant.wall, wall);
        face = dot(n, wall.position) + plant.wall.face_offset;
        contact = select(dot(n, f) > o, T(1.0), o);
    }
    if (plant.external_force.on) f = plus(f, external_force_at(plant.external_force, t));
    PlantOutput<T> now{{t, {y[0], y[1], y[2]}, {y[3], y[4], y[5]}, p, f, f, n, face, contact, o}, {}};
    if constexpr (N == full_size) now.f_filtered = {y[filter_at], y[filter_at + 1], y[filter_at + 2]};
    return now;
}

// The state of a sampled controller after its last sample, and of the estimator after its own.
template <class T>
struct ControllerState {
    Vec3<T> q, qd, f_on_tip;  // measured
    Vec3<T> residual;         // N m
    T contact{0.0}, force_phase{0.0}, collision{0.0};
    std::array<T, law_memory> memory{};
    T stiffness{0.0}, stiffness_sigma{0.0}, wall_speed{0.0}, identifiable{0.0};  // N/m, N/m, m/s
    T assumed_stiffness{0.0};  // N/m, for a law that asks the estimator
};

// The state of the controller in one lane.
template <class T>
ControllerState<double> lane_of(const ControllerState<T>& state, int lane) {
    const auto get = [lane](const T& x) { return Lanes<T>::get(x, lane); };
    const auto three = [&](const Vec3<T>& v) { return Vec3<double>(get(v[0]), get(v[1]), get(v[2])); };
    ControllerState<double> one{three(state.q),
                                three(state.qd),
                                three(state.f_on_tip),
                                three(state.residual),
                                get(state.contact),
                                get(state.force_phase),
                                get(state.collision),
                                {},
                                get(state.stiffness),
                                get(state.stiffness_sigma),
                                get(state.wall_speed),
                                get(state.identifiable),
                                get(state.assumed_stiffness)};
    for (std::size_t i = 0; i < law_memory; ++i) one.memory[i] = get(state.memory[i]);
    return one;
}

template <class T>
class SampledController {
public:
    using Mask = typename Lanes<T>::Mask;

    UserLaw user;
    LawFunction<T, T> law_function = nullptr;

    // Loads the controller of a run into a lane; its first sample is at the start.
    void load_lane(int lane, const DigitalController<double>& from, const Estimation<double>& estimation);

    // The next instant, s, at which it samples or its torque changes; infinite if there is no such controller.
    ARM3R_INLINE T next() const { return min(min(next_sample_, next_output_), next_estimate_); }

    // Updates the lanes that are due. `acting` is the torque that acts on the joints from now on.
    ARM3R_INLINE void update(const Mask& due, const T& slack, const Arm<T>& arm, PlantOutput<T>& now, Vec3<T>& acting) {
        const T until = now.measurement.t + slack;
        if (estimation_.on) estimate_if_due(due && next_estimate_ < next_sample_ - slack, until, arm, now.measurement);
        const Mask samples = due && next_sample_ <= until;
        if (in_any_lane(samples)) sample(samples, arm, now, acting);
        if (has_output_delay_) {
            const Mask outputs = due && next_output_ <= until;
            if (in_any_lane(outputs)) apply_queued(outputs, acting);
        }
        if (estimation_.on) estimate_if_due(due, until, arm, now.measurement);
    }

    const ControllerState<T>& controller_state() const { return state_; }
    // Of several lanes its state has what they have measured only where it is asked for, for rows.
    void keep_measurements() { keeps_measurements_ = true; }
    bool is_on() const { return digital_.sampling.on; }
    bool estimates() const { return estimation_.on; }
    const Controller<T>& controller() const { return digital_.controller; }
    // The instant of the next sample, s.
    ARM3R_INLINE T next_sample() const { return next_sample_; }
    bool has_failed() const { return has_failed_; }
    std::string error_message() const;  // of the user's law, after it has failed

private:
    ARM3R_INLINE void sample(const Mask& due, const Arm<T>& arm, PlantOutput<T>& now, Vec3<T>& acting) {
        const Controller<T>& controller = digital_.controller;
        Measurement<T>& sensed = now.measurement;
        if constexpr (Lanes<T>::count == 1)
            if (controller.type == ControllerType::user) truth_ = {sensed.q, sensed.qd, sensed.f_on_tip};
        measure(due, arm, now.f_filtered, sensed);
        update_contact(due, sensed);
        if (estimation_.on) sense_contact(due, sensed);
        if (digital_.observer.on) update_residual(due, sensed);
        start_memory(due, sensed);
        if (has_reserve(controller)) update_reserve(due, sensed);
        Command<T> command;
        compute(controller, sensed, command);
        if (digital_.observer.reaction != Reaction::ignore) react(due, sensed, command);
        if (has_reserve(controller)) apply_brake(due, arm, sensed, command);
        const Vec3<T> output = actuated(arm, controller, state_.memory[0], command);
        const T limit = memory_limit();
        if (has_integrated_memory())
            Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { integrate_memory(due, command, limit); });
        apply_output(due, output, acting);
        if (digital_.observer.on) update_observer(due, sensed);
        count_ = count_ + select(due, T(1.0), T(0.0));
        next_sample_ = select(due, T(digital_.sampling.start + count_ * digital_.sampling.period), next_sample_);
    }

    // ---- sensors (8.1)

    ARM3R_INLINE void measure(const Mask& due, const Arm<T>& arm, const Vec3<T>& f_filtered, Measurement<T>& sensed) {
        const Sensors<T>& sensors = digital_.sensors;
        if (sensors.has_encoder) {
            for (int i = 0; i < 3; ++i) sensed.q[i] = rounded_to_grid(sensed.q[i], sensors.encoder_step);
            sensed.pose = pose(sensed.q);
        }
        const bool estimates_rate = sensors.velocity != VelocityEstimate::exact;
        if (estimates_rate) sensed.qd = estimated_rate(sensed.q, sensed.qd);
        if (sensors.has_analog_filter) sensed.f_on_tip = f_filtered;
        measure_force(due, arm, sensed.f_on_tip);
        if (!digital_.controller.ideal_cancellation) sensed.f_cancelled = sensed.f_on_tip;
        const bool keeps = Lanes<T>::count == 1 || keeps_measurements_;
        if (keeps || estimates_rate) assign_where(due, sensed.q, state_.q), assign_where(due, sensed.qd, state_.qd);
        if (keeps) assign_where(due, sensed.f_on_tip, state_.f_on_tip);
    }

    ARM3R_INLINE static void assign_where(const Mask& due, const Vec3<T>& now, Vec3<T>& kept) {
        for (int i = 0; i < 3; ++i) kept[i] = select(due, now[i], kept[i]);
    }

    ARM3R_INLINE static T rounded_to_grid(const T& x, const T& step) {
        return select(step > T(0.0), T(nearest_integer(T(x / step)) * step), x);
    }

    // At the first sample the rate is assumed to be known.
    ARM3R_INLINE Vec3<T> estimated_rate(const Vec3<T>& q, const Vec3<T>& qd) {
        const Mask first = count_ == T(0.0);
        Vec3<T> rate;
        for (int i = 0; i < 3; ++i) {
            T difference = (q[i] - state_.q[i]) / digital_.sampling.period;
            if (digital_.sensors.velocity == VelocityEstimate::filtered)
                difference = state_.qd[i] + digital_.sensors.velocity_share * (difference - state_.qd[i]);
            rate[i] = select(first, qd[i], difference);
        }
        return rate;
    }

    ARM3R_INLINE void measure_force(const Mask& due, const Arm<T>& arm, Vec3<T>& f) {
        const Sensors<T>& sensors = digital_.sensors;
        if (sensors.has_tool)
            for (int i = 0; i < 3; ++i) f[i] = f[i] + sensors.tool_mass * arm.gravity[i];
        if (sensors.has_resolution)
            for (int i = 0; i < 3; ++i) f[i] = rounded_to_grid(f[i], sensors.resolution);
        if (sensors.has_bias) f = plus(f, sensors.bias);
        if (sensors.has_noise) add_noise(due, f);
        unfiltered_ = f;
        if (sensors.has_filter) {
            const Mask first = count_ == T(0.0);
            for (int i = 0; i < 3; ++i) {
                const T next = select(first, f[i], T(filtered_[i] + sensors.force_share * (f[i] - filtered_[i])));
                filtered_[i] = select(due, next, filtered_[i]);
            }
            f = filtered_;
        }
        if (sensors.has_delay) f = delayed_force(due, f);
    }

    [[gnu::noinline]] void add_noise(const Mask& due, Vec3<T>& f) const;
    [[gnu::noinline]] Vec3<T> delayed_force(const Mask& due, const Vec3<T>& f);

    // ---- contact, law, observer and reaction

    // Contact begins above one measured force and ends below another (8.2).
    ARM3R_INLINE void update_contact(const Mask& due, Measurement<T>& sensed) {
        const Controller<T>& controller = digital_.controller;
        const T f = dot(sensed.n, sensed.f_on_tip), o(0.0), l(1.0);
        const T least = select(state_.contact > o, controller.gains.contact_off, controller.gains.contact_on);
        const T touching = select(f > least, l, o);
        state_.contact = select(due, touching, state_.contact);
        const T phase = force_phase_after(controller.switching, state_.contact, state_.force_phase);
        state_.force_phase = select(due, phase, state_.force_phase);
        sensed.contact = state_.contact;
        sensed.force_phase = state_.force_phase;
        if (integrates_force(controller.type))
            state_.memory[0] = select(due, T(state_.contact * state_.memory[0]), state_.memory[0]);
    }

    ARM3R_INLINE void start_memory(const Mask& due, const Measurement<T>& sensed) {
        if (!has_law(digital_.controller.type)) return;
        const Mask first = due && count_ == T(0.0);
        if (!in_any_lane(first)) return;
        const std::array<T, law_memory> start = memory_at_start(digital_.controller, sensed);
        for (std::size_t i = 0; i < law_memory; ++i) state_.memory[i] = select(first, start[i], state_.memory[i]);
    }

    ARM3R_INLINE void compute(const Controller<T>& controller, const Measurement<T>& sensed, Command<T>& command) {
        if (has_law(controller.type)) {
            law_function(controller, sensed, state_.memory, command);
            return;
        }
        command.rates.fill(T(0.0));
        command.dtau_dintegral = {T(0.0), T(0.0), T(0.0)};
        if (controller.type == ControllerType::user) call_user_law(sensed, command.tau);
        else command.tau = feedforward_torque(controller, sensed.q, sensed.pose);
    }

    [[gnu::noinline]] void call_user_law(const Measurement<T>& sensed, Vec3<T>& tau);

    ARM3R_INLINE void update_residual(const Mask& due, const Measurement<T>& sensed) {  // (8.4)
        const Vec3<T> p = momentum(digital_.controller.model, sensed.pose, sensed.qd);
        const Mask first = count_ == T(0.0);
        for (int i = 0; i < 3; ++i) expected_[i] = select(due && first, p[i], expected_[i]);
        const Vec3<T> r = residual(digital_.observer.gain, p, expected_);
        for (int i = 0; i < 3; ++i) state_.residual[i] = select(due, r[i], state_.residual[i]);
        update_collision(due, sensed, r);
    }

    ARM3R_INLINE void update_observer(const Mask& due, const Measurement<T>& sensed) {
        const Vec3<T> rate =
            expected_rate(digital_.controller.model, sensed.pose, sensed.qd, mean_acting_, state_.residual);
        for (int i = 0; i < 3; ++i)
            expected_[i] = expected_[i] + select(due, T(digital_.sampling.period * rate[i]), T(0.0));
    }

    // A collision begins if a residual exceeds its threshold, and ends after all residuals have stayed below half of it
    // for a while. The reaction starts with the first collision and does not end (8.5).
    ARM3R_INLINE void update_collision(const Mask& due, const Measurement<T>& sensed, const Vec3<T>& r) {
        const Observer<T>& observer = digital_.observer;
        T share(0.0);
        for (int i = 0; i < 3; ++i) share = max(share, T(abs(r[i]) / observer.threshold[i]));
        const T o(0.0), l(1.0);
        quiet_since_ = select(due && share > T(0.5), sensed.t, quiet_since_);
        const Mask begins = due && share > l;
        // Rounding of the instants, which depends on the method and on time.start, does not add a sample.
        const T hold = observer.hold - 1e-6 * digital_.sampling.period;
        const Mask lasts = state_.collision > o && sensed.t - quiet_since_ < hold;
        state_.collision = select(due, select(begins || lasts, l, o), state_.collision);
        const Mask reacts_now = begins && !(reacts_ > o);
        for (int i = 0; i < 3; ++i) hold_pose_[i] = select(reacts_now, sensed.q[i], hold_pose_[i]);
        reacts_ = select(begins, l, reacts_);
    }

    ARM3R_INLINE void react(const Mask& due, const Measurement<T>& sensed, Command<T>& command) {  // (8.6)
        const Observer<T>& observer = digital_.observer;
        const Vec3<T>& r = state_.residual;
        Vec3<T> tau = gravity_torque(digital_.controller.model, sensed.pose);
        const bool keeps_pose = observer.reaction == Reaction::stop || observer.reaction == Reaction::retreat;
        for (int i = 0; i < 3; ++i) {
            if (observer.reaction == Reaction::reflex) tau[i] = tau[i] + observer.reflex_gain * r[i];
            if (keeps_pose)
                tau[i] = tau[i] + (observer.joint_stiffness[i] * (hold_pose_[i] - sensed.q[i]) -
                                   observer.joint_damping[i] * sensed.qd[i]);
            command.tau[i] = select(reacts_ > T(0.0), tau[i], command.tau[i]);
        }
        if (observer.reaction != Reaction::retreat) return;
        for (int i = 0; i < 3; ++i) {
            const T step = digital_.sampling.period * observer.retreat_gain * r[i];
            hold_pose_[i] = hold_pose_[i] + select(due && reacts_ > T(0.0), step, T(0.0));
        }
    }

    // ---- the energy reserve of a law that has one (8.8)

    [[gnu::noinline]] void update_reserve(const Mask& due, const Measurement<T>& sensed);
    [[gnu::noinline]] void apply_brake(const Mask& due, const Arm<T>& arm, const Measurement<T>& sensed,
                                       Command<T>& command);
    ARM3R_INLINE T work_of_reference(const Vec3<T>& desired) const;
    T pending_torque(const Mask& due, double still, Vec3<T>& acting) const;
    ARM3R_INLINE Prediction<T> predict_at_actuation(const Mask& due, const Measurement<T>& sensed,
                                                    const Vec3<T>& output) const;

    ARM3R_INLINE Vec3<T> desired_tip(const Measurement<T>& sensed) const {
        const Controller<T>& controller = digital_.controller;
        return tracks_path(controller.type) ? desired_motion_at(controller.reference, sensed.t).position
                                            : zero_vector<T>();
    }

    // Integrates the memory by Euler's rule; an integral of the force error is limited at the end of the step (7.5). A
    // reserve is updated by update_reserve() instead. Unused memory has rate zero. There are no branches or loops
    // (numbers/README.md, g++ 2).
    ARM3R_INLINE void integrate_memory(const Mask& due, const Command<T>& command, const T& limit) {
        const auto next = [&](std::size_t i) ARM3R_INLINE_LAMBDA {
            return T(state_.memory[i] + select(due, T(digital_.sampling.period * command.rates[i]), T(0.0)));
        };
        state_.memory = {max(min(next(0), limit), T(-limit)), next(1), next(2), next(3), next(4), next(5)};
    }

    ARM3R_INLINE bool has_integrated_memory() const {
        return memory_size(digital_.controller.type) > 0 && !has_reserve(digital_.controller);
    }

    ARM3R_INLINE T memory_limit() const {
        return integrates_force(digital_.controller.type) ? digital_.controller.gains.integral_limit : T(never);
    }

    // ---- the wall's stiffness, estimated from force and position in contact (8.7)

    // The estimator comes before the sample if it is due before it: a step of rk4 may end after both.
    ARM3R_INLINE void estimate_if_due(const Mask& due, const T& until, const Arm<T>& arm, const Measurement<T>& seen) {
        const Mask estimates = due && next_estimate_ <= until;
        if (!in_any_lane(estimates)) return;
        if (!is_on()) {
            contact_samples_.take(estimates, arm, seen);
            forget_lost_contact(estimates);
        }
        estimate(estimates);
    }

    ARM3R_INLINE void sense_contact(const Mask& due, const Measurement<T>& sensed) {
        contact_samples_.take_sensed(due, count_, digital_, sensed, unfiltered_);
        forget_lost_contact(due);
    }

    // An estimate is of one contact: where it is lost, the estimator starts anew.
    ARM3R_INLINE void forget_lost_contact(const Mask& due) {
        const T o(0.0);
        const Mask lost = due && !(contact_samples_.now().touches > o) && samples_in_ > o;
        if (in_any_lane(lost)) forget(lost);
    }

    [[gnu::noinline]] void forget(const Mask& lost);
    ARM3R_INLINE void tell(const Mask& due, const Mask& is_valid, const WallEstimate<T>& answer);

    [[gnu::noinline]] void estimate(const Mask& due);

    // ---- delay and hold (8.3)

    ARM3R_INLINE void apply_output(const Mask& due, const Vec3<T>& output, Vec3<T>& acting) {
        if (has_output_delay_) return enqueue(due, output, acting);
        assign_where(due, output, acting);
        assign_where(due, output, mean_acting_);
    }

    // Until the first torque acts, its value acts too: the loop was at rest before the start.
    [[gnu::noinline]] void enqueue(const Mask& due, const Vec3<T>& output, Vec3<T>& acting);
    [[gnu::noinline]] void apply_queued(const Mask& due, Vec3<T>& acting);

    double due_time(int lane, double sample) const;

    static constexpr double never = infinite;
    static constexpr double least_certainty = 5;  // standard deviations of the stiffness in an estimate of it

    DigitalController<T> digital_;
    T count_{0.0}, outputs_done_{0.0};  // number of samples, and of torques that have begun to act
    T next_sample_{never}, next_output_{never}, next_estimate_{never};
    ControllerState<T> state_;
    bool keeps_measurements_ = false;
    GroundTruth truth_;  // for a law of the user's own
    ContactSamples<T> contact_samples_;
    Estimation<T> estimation_;
    Estimator<T> estimator_;
    T estimates_{0.0}, first_position_{0.0}, first_time_{0.0}, samples_in_{0.0};
    Vec3<T> mean_acting_{};  // N m: mean of the torques that act from the last sample to the next one (8.3)
    Vec3<T> unfiltered_{}, filtered_{}, expected_{}, hold_pose_{};
    T quiet_since_{0.0}, reacts_{0.0};
    Vec3<T> last_q_{}, last_qd_{}, last_desired_{};  // rad, rad/s, m: at the last sample, for a law with a reserve
    T last_potential_{0.0};                          // J
    // For a delay that is not a whole number of samples: the fraction of the period in which the previous torque still
    // acts, and its difference from the next one, N m.
    T early_share_{0.0};
    Vec3<T> early_torque_{};
    bool has_output_delay_ = false;
    bool has_failed_ = false;
    int user_status_ = 0;         // what the user's law returned
    Vec3<double> user_torque_{};  // N m, slide: its torque
    std::array<DelayLine<max_delay + 2>, Lanes<T>::count> outputs_;
    std::array<DelayLine<max_force_delay + 2>, Lanes<T>::count> forces_;
};

}  // namespace arm3r
