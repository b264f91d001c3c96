#include "control_loop.hpp"

#include <cmath>

#include "arm3r/eigen_traits.hpp"
#include "compiled_laws.hpp"
#include "numbers.hpp"

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
    if (has_law(b.controller.type) || b.controller.type == Controls::user)
        each_law_number(f, a.controller, b.controller);
}

template <class A, class B>
void copy_digital_choices(const Digital<A>& from, Digital<B>& to) {
    static_cast<SamplingChoices&>(to.sampling) = from.sampling;
    static_cast<SensorChoices&>(to.sensors) = from.sensors;
    static_cast<ObserverChoices&>(to.observer) = from.observer;
    copy_controller_choices(from.controller, to.controller);
}

}  // namespace

template <class T>
void ControlLoop<T>::put(int lane, const Digital<double>& from, const Estimation<double>& estimation) {
    const auto set = [&](T& x, double value) { Lanes<T>::set(x, lane, value); };
    law_function = compiled_law<T, T>();
    copy_digital_choices(from, digital_);
    if (from.sampling.on) each_digital_number(set, digital_, from);
    static_cast<EstimationChoices&>(estimation_) = estimation;
    set(estimation_.period, estimation.period), set(estimation_.start, estimation.start);
    set(estimation_.forgetting, estimation.forgetting);
    set(estimation_.largest_condition, estimation.largest_condition);
    set(next_estimate_, estimation.on ? estimation.start : never);
    estimator_.forget(estimation.wall_moves, [&](T& x) { set(x, 0.0); });
    for (T* zero :
         {&count_, &outputs_done_, &known_.contact, &known_.force_phase, &known_.collision, &known_.stiffness,
          &known_.wall_speed, &known_.identifiable, &quiet_since_, &reacts_, &absorbed_, &estimates_, &samples_in_})
        set(*zero, 0.0);
    for (Vec3<T>* zeros : {&known_.q, &known_.qd, &known_.f_on_tip, &known_.residual, &filtered_, &expected_,
                           &kept_pose_, &last_tip_, &last_force_})
        for (int i = 0; i < 3; ++i) set((*zeros)[i], 0.0);
    for (T& number : known_.memory) set(number, 0.0);
    set(next_sample_, from.sampling.on ? from.sampling.start : never);
    set(next_output_, never);
    has_output_delay_ = from.sampling.has_delay;
    has_failed_ = false;
    user_status_ = 0;
}

template <class T>
void ControlLoop<T>::add_noise(const Mask& due, Vec3<T>& f) const {
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
Vec3<T> ControlLoop<T>::delayed_force(const Mask& due, const Vec3<T>& f) {
    Vec3<T> seen = f;
    constexpr std::size_t size = most_force_delay + 2;
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(due, lane)) continue;
        const double now = Lanes<T>::get(count_, lane), delay = Lanes<T>::get(digital_.sensors.force_delay, lane);
        const double place = std::max(0.0, now - delay), before = std::floor(place), share = place - before;
        auto& ring = forces_[lane];
        const auto at = [&](double sample) -> Vec3<double>& { return ring[std::size_t(sample) % size]; };
        for (int i = 0; i < 3; ++i) at(now)[i] = Lanes<T>::get(f[i], lane);
        const Vec3<double>&a = at(before), &b = at(std::min(now, before + 1));
        for (int i = 0; i < 3; ++i) Lanes<T>::set(seen[i], lane, a[i] + share * (b[i] - a[i]));
    }
    return seen;
}

template <class T>
void ControlLoop<T>::queue(const Mask& due, const Vec3<T>& tau, Vec3<T>& held) {
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(due, lane)) continue;
        const double now = Lanes<T>::get(count_, lane);
        Vec3<double>& place = outputs_[lane][std::size_t(now) % outputs_[lane].size()];
        for (int i = 0; i < 3; ++i) {
            place[i] = Lanes<T>::get(tau[i], lane);
            if (now == 0) Lanes<T>::set(held[i], lane, place[i]);
        }
        if (now == 0) Lanes<T>::set(next_output_, lane, due_time(lane, 0));
    }
}

template <class T>
void ControlLoop<T>::put_out(const Mask& due, Vec3<T>& held) {
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(due, lane)) continue;
        const double done = Lanes<T>::get(outputs_done_, lane);
        const Vec3<double>& tau = outputs_[lane][std::size_t(done) % outputs_[lane].size()];
        for (int i = 0; i < 3; ++i) Lanes<T>::set(held[i], lane, tau[i]);
        Lanes<T>::set(outputs_done_, lane, done + 1);
        Lanes<T>::set(next_output_, lane, due_time(lane, done + 1));
    }
}

// When the torque of a sample comes through, s.
template <class T>
double ControlLoop<T>::due_time(int lane, double sample) const {
    const auto get = [lane](const T& x) { return Lanes<T>::get(x, lane); };
    const Sampling<T>& sampling = digital_.sampling;
    return get(sampling.start) + (sample + get(sampling.delay)) * get(sampling.period);
}

template <class T>
void ControlLoop<T>::ask_user(const Sensed<T>& sensed, Vec3<T>& tau) {
    tau = {T(0.0), T(0.0), T(0.0)};
    if constexpr (Lanes<T>::count == 1) {
        if (has_failed_) return;
        user_status_ = user.function(user.user, count_, truth_, sensed, known_, user_torque_);
        has_failed_ = user_status_ != 0;
        for (int i = 0; i < 3; ++i) has_failed_ = has_failed_ || !(std::abs(user_torque_[i]) <= largest_torque);
        if (!has_failed_) tau = user_torque_;
    }
}

template <class T>
std::string ControlLoop<T>::complaint() const {
    const double tick = Lanes<T>::get(count_, 0) - 1;
    const double t = Lanes<T>::get(digital_.sampling.start, 0) + tick * Lanes<T>::get(digital_.sampling.period, 0);
    const std::string place = " at tick " + shortest(tick) + ", t = " + shortest(t) + " s";
    if (user_status_ != 0) return "the controller asked to stop with " + std::to_string(user_status_) + place;
    const Vec3<double> tau = user.simscape ? flipped(user_torque_) : user_torque_;
    return "the controller gave the torque [" + shortest(tau[0]) + ", " + shortest(tau[1]) + ", " + shortest(tau[2]) +
           "] N m" + place + "; three finite numbers are needed, at most 1e12 either way";
}

// Under the hold the virtual wall gives out f . (x_{k+1} - x_k) exactly. Where it has given more than it took, a damping
// force takes the rest back within a period (8.8).
template <class T>
void ControlLoop<T>::keep_passive(const Mask& due, const Sensed<T>& sensed, Command<T>& command) {
    const Arm<T>& model = digital_.controller.model;
    const T period = digital_.sampling.period;
    const Vec3<T> tip = tip_position(model, sensed.pose), way = minus(tip, last_tip_);
    const Mask first = count_ == T(0.0);
    const T taken = select(first, T(0.0), T(-dot(last_force_, way)));
    const T absorbed = absorbed_ + taken;
    const Vec3<T> v{way[0] / period, way[1] / period, way[2] / period};
    const T speed_2 = dot(v, v);
    const Mask owes = absorbed < T(0.0) && !first && speed_2 > T(1e-300);
    const T alpha = select(owes, T(-absorbed / (period * speed_2)), T(0.0));
    const Gains<T>& gains = digital_.controller.gains;
    const T pushes = virtual_wall_force(gains, tip, tip_velocity(model, sensed.pose, sensed.qd));
    Vec3<T> force{pushes * gains.plane_normal[0], pushes * gains.plane_normal[1], pushes * gains.plane_normal[2]};
    Vec3<T> brake;
    for (int i = 0; i < 3; ++i) brake[i] = -alpha * v[i];
    command.tau = plus(command.tau, tip_force_torque(model, sensed.pose, brake));
    force = plus(force, brake);
    absorbed_ = select(due, absorbed, absorbed_);
    for (int i = 0; i < 3; ++i) {
        last_tip_[i] = select(due, tip[i], last_tip_[i]);
        last_force_[i] = select(due, force[i], last_force_[i]);
    }
}

// A sample counts in contact only. The answer is the assumed stiffness of a law that asks for it.
template <class T>
void ControlLoop<T>::estimate(const Mask& due, const Sensed<T>& sensed) {
    const T o(0.0), l(1.0);
    const T f = digital_.sampling.on ? dot(sensed.n, known_.f_on_tip) : pressing_.force;
    const Mask counts = due && pressing_.force > o;
    const Mask first = counts && samples_in_ == o;
    first_place_ = select(first, pressing_.place, first_place_);
    first_time_ = select(first, sensed.t, first_time_);
    estimator_.add_where(counts, T(pressing_.place - first_place_), T(sensed.t - first_time_), f,
                         estimation_.forgetting);
    samples_in_ = samples_in_ + select(counts, l, o);
    const WallEstimate<T> answer = estimator_.answer();
    const Mask told = samples_in_ >= T(8.0) && answer.condition < estimation_.largest_condition;
    known_.identifiable = select(due, select(told, l, o), known_.identifiable);
    known_.stiffness = select(due, select(told, answer.stiffness, o), known_.stiffness);
    known_.wall_speed = select(due, select(told, answer.speed, o), known_.wall_speed);
    if (digital_.sampling.on && asks_estimator(digital_.controller)) {
        T& assumed = digital_.controller.gains.assumed_stiffness;
        assumed = select(due && told, answer.stiffness, assumed);
    }
    estimates_ = estimates_ + select(due, l, o);
    next_estimate_ = select(due, T(estimation_.start + estimates_ * estimation_.period), next_estimate_);
}

// By name: `template class` would also build, for no caller, what is inlined everywhere (ARM3R_INLINE).
#define ARM3R_CONTROL_LOOP(...)                                                                                \
    template void ControlLoop<__VA_ARGS__>::put(int, const Digital<double>&, const Estimation<double>&);       \
    template void ControlLoop<__VA_ARGS__>::add_noise(const Mask&, Vec3<__VA_ARGS__>&) const;                  \
    template Vec3<__VA_ARGS__> ControlLoop<__VA_ARGS__>::delayed_force(const Mask&, const Vec3<__VA_ARGS__>&); \
    template void ControlLoop<__VA_ARGS__>::queue(const Mask&, const Vec3<__VA_ARGS__>&, Vec3<__VA_ARGS__>&);  \
    template void ControlLoop<__VA_ARGS__>::put_out(const Mask&, Vec3<__VA_ARGS__>&);                          \
    template void ControlLoop<__VA_ARGS__>::ask_user(const Sensed<__VA_ARGS__>&, Vec3<__VA_ARGS__>&);          \
    template std::string ControlLoop<__VA_ARGS__>::complaint() const;                                          \
    template void ControlLoop<__VA_ARGS__>::keep_passive(const Mask&, const Sensed<__VA_ARGS__>&,              \
                                                         Command<__VA_ARGS__>&);                               \
    template void ControlLoop<__VA_ARGS__>::estimate(const Mask&, const Sensed<__VA_ARGS__>&);

ARM3R_CONTROL_LOOP(double)
#if !ARM3R_ONE_LANE
ARM3R_CONTROL_LOOP(Pack<2>)
#endif
#if ARM3R_WIDE_PACKS
ARM3R_CONTROL_LOOP(Pack<4>)
ARM3R_CONTROL_LOOP(Pack<8>)
#endif

}  // namespace arm3r
