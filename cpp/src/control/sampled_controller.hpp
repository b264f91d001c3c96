#pragma once
// A digital controller beside an arm that never stops moving: what it reads, computes and holds between its samples, lane
// by lane; docs/model.md, section 8. Sensors, law, reaction, limit, delay, hold, in this order. Three torques are told
// apart (8.3): the law computes one, the controller puts one out behind the limit, and behind the delay it acts on the
// joints. Slide convention.

#include <array>
#include <limits>
#include <string>

#include "arm3r/control/energy_reserve.hpp"
#include "arm3r/lanes.hpp"
#include "arm3r/numbers/random.hpp"
#include "arm3r/sensing/estimator.hpp"
#include "base/lane_access.hpp"
#include "base/noinline.hpp"
#include "control/user_law.hpp"

namespace arm3r {

// What there is to sense at an instant.
template <class T>
struct Instant {
    Sensed<T> seen;      // the truth, until a sample puts what the sensors read in its place
    Vec3<T> f_filtered;  // N, behind the analog filter, if there is one
};

// What a digital controller knew at its last sample, and the estimator at its own.
template <class T>
struct Known {
    Vec3<T> q, qd, f_on_tip;  // measured
    Vec3<T> residual;         // N m
    T contact{0.0}, force_phase{0.0}, collision{0.0};
    std::array<T, law_memory> memory{};
    T stiffness{0.0}, wall_speed{0.0}, identifiable{0.0};  // N/m, m/s
};

template <class T>
class ControlLoop {
public:
    using Mask = typename Lanes<T>::Mask;

    UserLaw user;
    LawFunction<T, T> law_function = nullptr;

    // The controller of a run put into a lane; its first sample is at the start.
    void put(int lane, const Digital<double>& from, const Estimation<double>& estimation);

    // The next instant, s, at which it samples or its torque changes; infinite where there is no such controller.
    ARM3R_INLINE T next() const { return min(min(next_sample_, next_output_), next_estimate_); }

    // Those lanes for which it is time. `acting` is the torque that the joints feel from now on.
    ARM3R_INLINE void attend(const Mask& due, const T& slack, const Arm<T>& arm, Instant<T>& now, Vec3<T>& acting) {
        const T until = now.seen.t + slack;
        if (estimation_.on) estimate_if_due(due && next_estimate_ < next_sample_ - slack, until, arm, now.seen);
        const Mask samples = due && next_sample_ <= until;
        if (any(samples)) sample(samples, arm, now, acting);
        if (has_output_delay_) {
            const Mask outputs = due && next_output_ <= until;
            if (any(outputs)) put_out(outputs, acting);
        }
        if (estimation_.on) estimate_if_due(due, until, arm, now.seen);
    }

    const Known<T>& known() const { return known_; }
    bool is_on() const { return digital_.sampling.on; }
    const Controller<T>& controller() const { return digital_.controller; }
    // When the next sample is due, s.
    ARM3R_INLINE T next_sample() const { return next_sample_; }
    bool has_failed() const { return has_failed_; }
    std::string complaint() const;  // about the user's law, once it has failed

private:
    ARM3R_INLINE void sample(const Mask& due, const Arm<T>& arm, Instant<T>& now, Vec3<T>& acting) {
        const Controller<T>& controller = digital_.controller;
        Sensed<T>& sensed = now.seen;
        if constexpr (Lanes<T>::count == 1)
            if (controller.type == Controls::user) truth_ = {sensed.q, sensed.qd, sensed.f_on_tip};
        sense(due, arm, now.f_filtered, sensed);
        judge_contact(due, sensed);
        if (estimation_.on) note_pressing(due, controller.model, sensed);
        if (digital_.observer.on) observe(due, sensed);
        start_memory(due, sensed);
        if (keeps_reserve(controller)) settle(due, sensed);
        Command<T> command;
        compute(controller, sensed, command);
        if (digital_.observer.reaction != Reaction::ignore) react(due, sensed, command);
        if (keeps_reserve(controller)) keep_passive(due, arm, sensed, command);
        const Vec3<T> output = actuated(arm, controller, known_.memory[0], command);
        const T limit = memory_limit();
        if (remembers()) Apart<T>::run([&]() ARM3R_INLINE_LAMBDA { remember(due, command, limit); });
        deliver(due, output, acting);
        if (digital_.observer.on) expect(due, sensed);
        count_ = count_ + select(due, T(1.0), T(0.0));
        next_sample_ = select(due, T(digital_.sampling.start + count_ * digital_.sampling.period), next_sample_);
    }

    // ---- sensors (8.1)

    ARM3R_INLINE void sense(const Mask& due, const Arm<T>& arm, const Vec3<T>& f_filtered, Sensed<T>& sensed) {
        const Sensors<T>& sensors = digital_.sensors;
        if (sensors.has_encoder) {
            for (int i = 0; i < 3; ++i) sensed.q[i] = on_grid(sensed.q[i], sensors.encoder_step);
            sensed.pose = pose(sensed.q);
        }
        const bool estimates_rate = sensors.velocity != VelocityEstimate::exact;
        if (estimates_rate) sensed.qd = estimated_rate(sensed.q, sensed.qd);
        if (sensors.has_analog_filter) sensed.f_on_tip = f_filtered;
        measure_force(due, arm, sensed.f_on_tip);
        if (!digital_.controller.ideal_cancellation) sensed.f_cancelled = sensed.f_on_tip;
        if (Lanes<T>::count == 1 || estimates_rate) keep(due, sensed.q, known_.q), keep(due, sensed.qd, known_.qd);
        if (Lanes<T>::count == 1) keep(due, sensed.f_on_tip, known_.f_on_tip);
    }

    ARM3R_INLINE static void keep(const Mask& due, const Vec3<T>& now, Vec3<T>& kept) {
        for (int i = 0; i < 3; ++i) kept[i] = select(due, now[i], kept[i]);
    }

    ARM3R_INLINE static T on_grid(const T& x, const T& step) {
        return select(step > T(0.0), T(nearest_integer(T(x / step)) * step), x);
    }

    // Where there is no sample before, the rate is taken for known.
    ARM3R_INLINE Vec3<T> estimated_rate(const Vec3<T>& q, const Vec3<T>& qd) {
        const Mask first = count_ == T(0.0);
        Vec3<T> rate;
        for (int i = 0; i < 3; ++i) {
            T difference = (q[i] - known_.q[i]) / digital_.sampling.period;
            if (digital_.sensors.velocity == VelocityEstimate::filtered)
                difference = known_.qd[i] + digital_.sensors.velocity_share * (difference - known_.qd[i]);
            rate[i] = select(first, qd[i], difference);
        }
        return rate;
    }

    ARM3R_INLINE void measure_force(const Mask& due, const Arm<T>& arm, Vec3<T>& f) {
        const Sensors<T>& sensors = digital_.sensors;
        if (sensors.has_tool)
            for (int i = 0; i < 3; ++i) f[i] = f[i] + sensors.tool_mass * arm.gravity[i];
        if (sensors.has_resolution)
            for (int i = 0; i < 3; ++i) f[i] = on_grid(f[i], sensors.resolution);
        if (sensors.has_bias) f = plus(f, sensors.bias);
        if (sensors.has_noise) add_noise(due, f);
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

    // ---- what it makes of them

    // Contact is made above one measured force and lost below another (8.2).
    ARM3R_INLINE void judge_contact(const Mask& due, Sensed<T>& sensed) {
        const Controller<T>& controller = digital_.controller;
        const T f = dot(sensed.n, sensed.f_on_tip), o(0.0), l(1.0);
        const T least = select(known_.contact > o, controller.gains.contact_off, controller.gains.contact_on);
        const T touching = select(f > least, l, o);
        known_.contact = select(due, touching, known_.contact);
        T phase = l;
        if (controller.switching == Switching::in_contact) phase = known_.contact;
        if (controller.switching == Switching::latched) phase = max(known_.force_phase, known_.contact);
        known_.force_phase = select(due, phase, known_.force_phase);
        sensed.contact = known_.contact;
        sensed.force_phase = known_.force_phase;
        if (integrates_force(controller.type))
            known_.memory[0] = select(due, T(known_.contact * known_.memory[0]), known_.memory[0]);
    }

    ARM3R_INLINE void start_memory(const Mask& due, const Sensed<T>& sensed) {
        if (!has_law(digital_.controller.type)) return;
        const Mask first = due && count_ == T(0.0);
        if (!any(first)) return;
        const std::array<T, law_memory> start = memory_at_start(digital_.controller, sensed);
        for (std::size_t i = 0; i < law_memory; ++i) known_.memory[i] = select(first, start[i], known_.memory[i]);
    }

    ARM3R_INLINE void compute(const Controller<T>& controller, const Sensed<T>& sensed, Command<T>& command) {
        if (has_law(controller.type)) {
            law_function(controller, sensed, known_.memory, command);
            return;
        }
        command.rates.fill(T(0.0));
        command.per_integral = {T(0.0), T(0.0), T(0.0)};
        if (controller.type == Controls::user) ask_user(sensed, command.tau);
        else command.tau = control(controller, sensed.q, sensed.pose);
    }

    [[gnu::noinline]] void ask_user(const Sensed<T>& sensed, Vec3<T>& tau);

    ARM3R_INLINE void observe(const Mask& due, const Sensed<T>& sensed) {  // (8.4)
        const Vec3<T> p = momentum(digital_.controller.model, sensed.pose, sensed.qd);
        const Mask first = count_ == T(0.0);
        for (int i = 0; i < 3; ++i) expected_[i] = select(due && first, p[i], expected_[i]);
        const Vec3<T> r = residual(digital_.observer.gain, p, expected_);
        for (int i = 0; i < 3; ++i) known_.residual[i] = select(due, r[i], known_.residual[i]);
        judge_collision(due, sensed, r);
    }

    ARM3R_INLINE void expect(const Mask& due, const Sensed<T>& sensed) {
        const Vec3<T> rate =
            expected_rate(digital_.controller.model, sensed.pose, sensed.qd, mean_acting_, known_.residual);
        for (int i = 0; i < 3; ++i)
            expected_[i] = expected_[i] + select(due, T(digital_.sampling.period * rate[i]), T(0.0));
    }

    // A collision begins where a residual exceeds its threshold, and is over when all have stayed below half of it for a
    // while. The reaction to it begins with the first and stays (8.5).
    ARM3R_INLINE void judge_collision(const Mask& due, const Sensed<T>& sensed, const Vec3<T>& r) {
        const Observer<T>& observer = digital_.observer;
        T share(0.0);
        for (int i = 0; i < 3; ++i) share = max(share, T(abs(r[i]) / observer.threshold[i]));
        const T o(0.0), l(1.0);
        quiet_since_ = select(due && share > T(0.5), sensed.t, quiet_since_);
        const Mask begins = due && share > l;
        const Mask lasts = known_.collision > o && sensed.t - quiet_since_ < observer.hold;
        known_.collision = select(due, select(begins || lasts, l, o), known_.collision);
        const Mask reacts_now = begins && !(reacts_ > o);
        for (int i = 0; i < 3; ++i) kept_pose_[i] = select(reacts_now, sensed.q[i], kept_pose_[i]);
        reacts_ = select(begins, l, reacts_);
    }

    ARM3R_INLINE void react(const Mask& due, const Sensed<T>& sensed, Command<T>& command) {  // (8.6)
        const Observer<T>& observer = digital_.observer;
        const Vec3<T>& r = known_.residual;
        Vec3<T> tau = gravity_torque(digital_.controller.model, sensed.pose);
        const bool keeps_pose = observer.reaction == Reaction::stop || observer.reaction == Reaction::retreat;
        for (int i = 0; i < 3; ++i) {
            if (observer.reaction == Reaction::reflex) tau[i] = tau[i] + observer.reflex_gain * r[i];
            if (keeps_pose)
                tau[i] = tau[i] + (observer.joint_stiffness[i] * (kept_pose_[i] - sensed.q[i]) -
                                   observer.joint_damping[i] * sensed.qd[i]);
            command.tau[i] = select(reacts_ > T(0.0), tau[i], command.tau[i]);
        }
        if (observer.reaction != Reaction::retreat) return;
        for (int i = 0; i < 3; ++i) {
            const T step = digital_.sampling.period * observer.retreat_gain * r[i];
            kept_pose_[i] = kept_pose_[i] + select(due && reacts_ > T(0.0), step, T(0.0));
        }
    }

    // ---- the reserve of energy of a law that keeps one (8.8)

    [[gnu::noinline]] void settle(const Mask& due, const Sensed<T>& sensed);
    [[gnu::noinline]] void keep_passive(const Mask& due, const Arm<T>& arm, const Sensed<T>& sensed,
                                        Command<T>& command);
    T work_of_reference(const Vec3<T>& wanted) const;
    T pending(const Mask& due, double still, Vec3<T>& acting) const;
    Prospect<T> when_it_acts(const Mask& due, const Sensed<T>& sensed, const Vec3<T>& output) const;

    ARM3R_INLINE Vec3<T> wanted_tip(const Sensed<T>& sensed) const {
        const Controller<T>& controller = digital_.controller;
        return wants_path(controller.type) ? wanted_at(controller.setpoint, sensed.t).position : none<T>();
    }

    // By Euler's rule; an integral of the force error ends its step at its limit (7.5). A reserve is settled instead. What
    // a law does not remember has no rate. Without branches or loops, for g++ 12 (pack.hpp).
    ARM3R_INLINE void remember(const Mask& due, const Command<T>& command, const T& limit) {
        const auto next = [&](std::size_t i) ARM3R_INLINE_LAMBDA {
            return T(known_.memory[i] + select(due, T(digital_.sampling.period * command.rates[i]), T(0.0)));
        };
        known_.memory = {max(min(next(0), limit), T(-limit)), next(1), next(2), next(3), next(4), next(5)};
    }

    ARM3R_INLINE bool remembers() const {
        return memory_size(digital_.controller.type) > 0 && !keeps_reserve(digital_.controller);
    }

    ARM3R_INLINE T memory_limit() const {
        return integrates_force(digital_.controller.type) ? digital_.controller.gains.integral_limit : T(never);
    }

    // ---- the wall's stiffness, told from force and position in contact (8.7)

    // Before the sample of the same step where it is due before: a step of rk4 may end after both.
    ARM3R_INLINE void estimate_if_due(const Mask& due, const T& until, const Arm<T>& arm, const Sensed<T>& seen) {
        const Mask estimates = due && next_estimate_ <= until;
        if (!any(estimates)) return;
        if (!is_on()) note_pressing(estimates, arm, seen);
        estimate(estimates);
    }

    // Force and position of one instant; a sampled controller has both from its sensors.
    struct Pressing {
        T time{0.0}, place{0.0}, force{0.0};  // s, m, N: of the tip and on it, along the normal
        T counts{0.0};                        // 1: taken in contact and not estimated from yet
    };

    ARM3R_INLINE void note_pressing(const Mask& due, const Arm<T>& arm, const Sensed<T>& seen) {
        const T force = dot(seen.n, seen.f_on_tip), o(0.0), l(1.0);
        const bool judges = !is_on() || digital_.controller.switching != Switching::always;
        const Mask touches = judges ? seen.contact > o : force > o;
        pressing_.time = select(due, seen.t, pressing_.time);
        pressing_.place = select(due, T(-dot(seen.n, tip_position(arm, seen.pose))), pressing_.place);
        pressing_.force = select(due, force, pressing_.force);
        pressing_.counts = select(due, select(touches, l, o), pressing_.counts);
    }

    [[gnu::noinline]] void estimate(const Mask& due);

    // ---- delay and hold (8.3)

    ARM3R_INLINE void deliver(const Mask& due, const Vec3<T>& output, Vec3<T>& acting) {
        if (has_output_delay_) return queue(due, output, acting);
        keep(due, output, acting);
        keep(due, output, mean_acting_);
    }

    // Before the first torque has come through, it is the one that acts: the loop stood at rest before the start.
    [[gnu::noinline]] void queue(const Mask& due, const Vec3<T>& output, Vec3<T>& acting);
    [[gnu::noinline]] void put_out(const Mask& due, Vec3<T>& acting);

    double due_time(int lane, double sample) const;

    static constexpr double never = std::numeric_limits<double>::infinity();

    Digital<T> digital_;
    T count_{0.0}, outputs_done_{0.0};  // samples taken, torques that act or have acted
    T next_sample_{never}, next_output_{never}, next_estimate_{never};
    Known<T> known_;
    Truth truth_;  // for a law of the user's own
    Pressing pressing_;
    Estimation<T> estimation_;
    Estimator<T> estimator_;
    T estimates_{0.0}, first_place_{0.0}, first_time_{0.0}, samples_in_{0.0};
    Vec3<T> mean_acting_{};  // N m: of the torques that act from the last sample to the next one (8.3)
    Vec3<T> filtered_{}, expected_{}, kept_pose_{};
    T quiet_since_{0.0}, reacts_{0.0};
    Vec3<T> last_q_{}, last_qd_{}, last_wanted_{};  // rad, rad/s, m: at the last sample of a law with a reserve
    T last_potential_{0.0};                         // J
    // Of a delay that is no whole number of samples: the share of the period in which the torque before still acts, and
    // by how much that differs from the next one, N m.
    T early_share_{0.0};
    Vec3<T> early_torque_{};
    bool has_output_delay_ = false;
    bool has_failed_ = false;
    int user_status_ = 0;         // what the user's law returned
    Vec3<double> user_torque_{};  // N m, slide: what it asked for
    std::array<std::array<Vec3<double>, most_delay + 2>, Lanes<T>::count> outputs_;
    std::array<std::array<Vec3<double>, most_force_delay + 2>, Lanes<T>::count> forces_;
};

}  // namespace arm3r
