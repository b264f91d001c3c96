#include "validate/linear_loop.hpp"

#include <algorithm>
#include <cmath>

#include "arm3r/control/energy_reserve.hpp"
#include "arm3r/ode/linearization.hpp"
#include "control/compiled_laws.hpp"
#include "setup/make_controller.hpp"
#include "validate/square_matrix.hpp"

namespace arm3r {
namespace {

using D = Dual<derivatives_per_pass>;
using Signals = std::vector<D>;

constexpr std::size_t most_states = 128;  // a product of such matrices takes a millisecond
constexpr std::size_t motion_and_filter = motion_size + 3;

// ---- the operating point

void leave_out(Arm<double>& arm) {
    arm.gravity = {0, 0, 0};
    arm.gravity_is_vertical = true;
    arm.has_dry_friction = arm.has_torque_limit = false;
    arm.friction = {0, 0, 0};
}

constexpr double touch = 1e-6;  // N: a force that moves nothing by itself

// m: the depth at which a contact pushes with a force, N, at rest.
double depth_of(const Contact<double>& contact, double force) {
    double low = 0, high = 1;
    Indentation<double> in{};
    for (int i = 0; i < 60; ++i) {
        in.depth = 0.5 * (low + high);
        (normal_force_law(contact, in).total < force ? low : high) = in.depth;
    }
    return high;
}

void place_wall(Plant<double>& plant, const Vec3<double>& tip, double depth) {
    Wall<double>& wall = plant.wall;
    wall.motion = Motion::fixed;
    wall.rotation = Rotation::none;
    wall.has_outline = false;
    wall.half1 = wall.half2 = infinite;
    for (int i = 0; i < 3; ++i) wall.point[i] = tip[i] + (depth - wall.face_offset) * wall.n[i];
    plant.contact.has_friction = false;
}

Controller<double>& law_of(Setup& setup) {
    return setup.digital.sampling.on ? setup.digital.controller : setup.plant.controller;
}

// The law wants what is there: the force of the contact, none where the tip is free.
Setup at_rest(Setup setup, TipPlace place) {
    Controller<double>& law = law_of(setup);
    const double wanted = law.reference.force;
    leave_out(setup.plant.arm), leave_out(law.model), leave_out(setup.plant.controller.model);
    setup.qd = {0, 0, 0};
    setup.plant.external_force.on = false;
    setup.plant.held_torque = {0, 0, 0};
    law.anti_windup = AntiWindup::none;
    law.reference.path = Path::hold;
    law.reference.from = law.reference.in_joints ? setup.q : tip_position(law.model, pose(setup.q));
    law.reference.force_profile = ForceProfile::constant;
    law.reference.force = 0;
    if (place == TipPlace::in_contact) {
        law.reference.force = tracks_force(law.type) ? std::max(1.0, std::abs(wanted)) : touch;
        place_wall(setup.plant, tip_position(setup.plant.arm, pose(setup.q)),
                   depth_of(setup.plant.contact, law.reference.force));
    }
    return setup;
}

// ---- the plant and its continuous memory

ContactForceMode force_mode(TipPlace place) {
    return place == TipPlace::in_contact ? ContactForceMode::pressed : ContactForceMode::none;
}

template <class T>
Measurement<T> measured(const Setup& setup, TipPlace place, const Vec3<T>& q, const Vec3<T>& qd, const Vec3<T>& f) {
    const Controller<double>& law = setup.controller();
    const T contact(place == TipPlace::in_contact ? 1.0 : 0.0);
    Measurement<T> now{T(setup.start), q, qd, pose(q), f, f, zero_vector<T>(), T(0.0), contact, T(0.0)};
    now.force_phase = force_phase_after(law.switching, contact, T(0.0));
    if (!setup.plant.has_wall) return now;
    const WallState<T> wall = wall_at(setup.plant.wall, now.t);
    now.n = normal(setup.plant.wall, wall);
    now.face = dot(now.n, wall.position) + setup.plant.wall.face_offset;
    return now;
}

template <class T>
Vec3<T> wall_force(const Setup& setup, TipPlace place, const Vec3<T>& q, const Vec3<T>& qd) {
    if (place == TipPlace::free) return zero_vector<T>();
    const Plant<double>& plant = setup.plant;
    const WallState<T> wall = wall_at(plant.wall, T(setup.start));
    return contact_force(plant.wall, wall, plant.contact, tip_indentation(plant, wall, pose(q), qd), Clamping::smooth)
        .on_tip;
}

State<double, full_size> state_at_start(const Setup& setup, TipPlace place) {
    State<double, full_size> y{};
    for (int i = 0; i < 3; ++i) y[i] = setup.q[i];
    RightHandSide<double, double> rhs(setup.plant);
    const Vec3<double> f = wall_force(setup, place, setup.q, setup.qd);
    const Measurement<double> truth = measured(setup, place, setup.q, setup.qd, f);
    rhs.contact = truth.contact, rhs.force_phase = truth.force_phase;
    return rhs.with_initial_memory(y, setup.plant.has_wall ? wall_at(setup.plant.wall, setup.start) : no_wall<double>(),
                                   truth);
}

// Of motion and memory; the work of the run's own quadratures is left out.
SquareMatrix continuous_matrix(const Setup& setup, TipPlace place) {
    constexpr std::size_t memory = std::size_t(full_size) - std::size_t(state_size);
    RightHandSide<double, D> rhs(setup.plant);
    rhs.law_function = compiled_law<double, D>();
    rhs.force_mode = force_mode(place);
    const State<double, full_size> y = state_at_start(setup, place);
    const Measurement<double> truth = measured(setup, place, setup.q, setup.qd, zero_vector<double>());
    rhs.contact = D(truth.contact), rhs.force_phase = D(truth.force_phase);
    State<double, full_size> f0{};
    Linearization<full_size> found{};
    linearize<motion_size, quadrature_count, derivatives_per_pass>(rhs, setup.start, y, memory, f0, found);
    const auto index = [](std::size_t k) { return state_index<motion_size, quadrature_count>(k); };
    SquareMatrix A(motion_size + memory);
    for (std::size_t i = 0; i < A.n; ++i)
        for (std::size_t j = 0; j < A.n; ++j) A(i, j) = found.df_dy[index(i)][index(j)];
    return A;
}

// [A B; 0 0] of motion and analog filter with held torques.
SquareMatrix held_matrix(const Setup& setup, TipPlace place) {
    const SquareMatrix A = continuous_matrix(setup, place);
    const auto index = [&](std::size_t k) { return k < motion_size ? k : A.n - motion_and_filter + k; };
    SquareMatrix held(motion_and_filter + 3);
    for (std::size_t i = 0; i < motion_and_filter; ++i)
        for (std::size_t j = 0; j < motion_and_filter; ++j) held(i, j) = A(index(i), index(j));
    for (int k = 0; k < 3; ++k) {
        Vec3<double> tau(0, 0, 0);
        tau[k] = 1;
        const Vec3<double> qdd = joint_acceleration(setup.plant.arm, pose(setup.q), setup.qd, tau, {0, 0, 0});
        for (int i = 0; i < 3; ++i) held(std::size_t(3 + i), motion_and_filter + std::size_t(k)) = qdd[i];
    }
    return held;
}

// ---- a sampled loop: from a sample to the next one

Vec3<D> three(const Signals& s, std::size_t at) { return {s[at], s[at + 1], s[at + 2]}; }
void put(Signals& s, std::size_t at, const Vec3<D>& v) {
    for (std::size_t i = 0; i < 3; ++i) s[at + i] = v[int(i)];
}

double share_at(double share, double period, double other) {
    return share >= 1 ? 1 : 1 - exp(log(1 - share) * other / period);
}

class SampledLoop {
public:
    SampledLoop(const Setup& setup, TipPlace place, double period)
        : setup_(setup), place_(place), sensors_(setup.digital.sensors), period_(period) {
        const double own = setup.digital.sampling.period, delay = setup.digital.sampling.delay;
        velocity_share_ = share_at(sensors_.velocity_share, own, period);
        force_share_ = share_at(sensors_.force_share, own, period);
        late_ = std::size_t(std::floor(delay));
        early_share_ = delay - std::floor(delay);
        const double force_delay = sensors_.has_delay ? sensors_.force_delay : 0;
        force_late_ = std::size_t(std::floor(force_delay));
        force_early_share_ = force_delay - std::floor(force_delay);
        forces_ = memory_ + law_memory + 9;
        torques_ = forces_ + 3 * (force_late_ + 1);
        size_ = torques_ + 3 * (late_ + 1);
    }

    std::size_t size() const { return size_; }

    SquareMatrix matrix() const {
        const SquareMatrix held = held_matrix(setup_, place_);
        const SquareMatrix early = exponential(held, early_share_ * period_),
                           late = exponential(held, (1 - early_share_) * period_);
        SquareMatrix map(size_);
        for (std::size_t first = 0; first < size_; first += derivatives_per_pass) {
            Signals s = start();
            const std::size_t end = std::min(size_, first + derivatives_per_pass);
            for (std::size_t k = first; k < end; ++k) s[k].slope[k - first] = 1;
            const Signals next = after(s, early, late);
            for (std::size_t i = 0; i < size_; ++i)
                for (std::size_t k = first; k < end; ++k) map(i, k) = next[i].slope[k - first];
        }
        return map;
    }

private:
    static constexpr std::size_t filter_ = motion_size, memory_ = filter_ + 3, last_q_ = memory_ + law_memory,
                                 last_rate_ = last_q_ + 3, filtered_ = last_rate_ + 3;

    Signals start() const {
        Signals s(size_);
        put(s, 0, broadcast<D>(setup_.q));
        const Vec3<double> f = wall_force(setup_, place_, setup_.q, setup_.qd);
        const auto memory = memory_at_start(setup_.controller(), measured(setup_, place_, setup_.q, setup_.qd, f));
        for (std::size_t i = 0; i < law_memory; ++i) s[memory_ + i] = D(memory[i]);
        put(s, last_q_, broadcast<D>(setup_.q));
        for (std::size_t at = forces_; at < torques_; at += 3) put(s, at, broadcast<D>(f));
        put(s, filter_, broadcast<D>(f)), put(s, filtered_, broadcast<D>(f));
        return s;
    }

    Vec3<D> rate(const Signals& s) const {
        if (sensors_.velocity == VelocityEstimate::exact) return three(s, 3);
        Vec3<D> found;
        for (std::size_t i = 0; i < 3; ++i) {
            const D difference = (s[i] - s[last_q_ + i]) / period_, last = s[last_rate_ + i];
            const bool filters = sensors_.velocity == VelocityEstimate::filtered;
            found[int(i)] = filters ? last + velocity_share_ * (difference - last) : difference;
        }
        return found;
    }

    // The force after filters, before its delay.
    Vec3<D> force(const Signals& s) const {
        Vec3<D> f =
            sensors_.has_analog_filter ? three(s, filter_) : wall_force(setup_, place_, three(s, 0), three(s, 3));
        if (sensors_.has_filter)
            for (std::size_t i = 0; i < 3; ++i)
                f[int(i)] = s[filtered_ + i] + force_share_ * (f[int(i)] - s[filtered_ + i]);
        return f;
    }

    // Of a line of values, the latest of which is not in it yet: the value `whole` + `share` samples ago.
    static Vec3<D> delayed(const Signals& s, std::size_t line, const Vec3<D>& now, std::size_t whole, double share) {
        const Vec3<D> later = whole == 0 ? now : three(s, line + 3 * (whole - 1));
        if (share == 0) return later;  // the one before may have left the line
        const Vec3<D> before = three(s, line + 3 * whole);
        Vec3<D> seen;
        for (int i = 0; i < 3; ++i) seen[i] = later[i] + share * (before[i] - later[i]);
        return seen;
    }

    static void shift(const Signals& s, Signals& next, std::size_t line, std::size_t end, const Vec3<D>& now) {
        put(next, line, now);
        for (std::size_t at = line + 3; at < end; ++at) next[at] = s[at - 3];
    }

    void move(Signals& next, const SquareMatrix& by, const Vec3<D>& tau) const {
        const Signals from(next.begin(), next.begin() + motion_and_filter);
        for (std::size_t i = 0; i < motion_and_filter; ++i) {
            next[i] = D(0.0);
            for (std::size_t j = 0; j < motion_and_filter; ++j) next[i] += by(i, j) * from[j];
            for (int k = 0; k < 3; ++k) next[i] += by(i, motion_and_filter + std::size_t(k)) * tau[k];
        }
    }

    Signals after(const Signals& s, const SquareMatrix& early, const SquareMatrix& late) const {
        const Controller<double>& law = setup_.digital.controller;
        Signals next = s;
        const Vec3<D> q = three(s, 0), qd = rate(s), f = force(s);
        Measurement<D> sensed =
            measured(setup_, place_, q, qd, delayed(s, forces_, f, force_late_, force_early_share_));
        if (law.ideal_cancellation) sensed.f_cancelled = wall_force(setup_, place_, q, three(s, 3));
        std::array<D, law_memory> memory;
        for (std::size_t i = 0; i < law_memory; ++i) memory[i] = s[memory_ + i];
        if (integrates_force(law.type)) memory[0] = sensed.contact * memory[0];
        Command<D> command;
        compiled_law<double, D>()(law, sensed, memory, command);
        for (std::size_t i = 0; i < memory_size(law.type); ++i)
            next[memory_ + i] = memory[i] + period_ * command.rates[i];
        put(next, last_q_, q), put(next, last_rate_, qd), put(next, filtered_, f);
        shift(s, next, forces_, torques_, f), shift(s, next, torques_, size_, command.tau);
        if (early_share_ > 0) move(next, early, delayed(s, torques_, command.tau, late_ + 1, 0));
        move(next, late, delayed(s, torques_, command.tau, late_, 0));
        return next;
    }

    const Setup& setup_;
    TipPlace place_;
    const Sensors<double>& sensors_;
    double period_, velocity_share_, force_share_, early_share_, force_early_share_;
    std::size_t late_, force_late_, forces_, torques_, size_;
};

bool has_loop(const Setup& setup, TipPlace place) {
    const Controller<double>& law = setup.controller();
    const bool feels_wall = setup.plant.has_wall && setup.plant.acts_on_arm;
    return has_law(law.type) && !has_reserve(law) && (place == TipPlace::free || feels_wall);
}

}  // namespace

std::optional<LoopGrowth> loop_growth(const Setup& setup, TipPlace place, double period) {
    if (!has_loop(setup, place)) return {};
    const Setup point = at_rest(setup, place);
    if (!setup.digital.sampling.on) {
        constexpr double moment = 1e-3;  // s
        return LoopGrowth{log_spectral_radius(exponential(continuous_matrix(point, place), moment)) / moment, 0};
    }
    const SampledLoop loop(point, place, period);
    if (loop.size() > most_states) return {};
    return LoopGrowth{log_spectral_radius(loop.matrix()) / period, period};
}

std::optional<double> fastest_rate(const Setup& setup) {
    constexpr double enough = 1e5;  // the eigenvalues of these matrices are of very different size
    std::optional<double> fastest;
    for (const TipPlace place : {TipPlace::free, TipPlace::in_contact}) {
        if (!has_loop(setup, place)) continue;
        const double rate = exp(log_spectral_radius(continuous_matrix(at_rest(setup, place), place), enough));
        fastest = std::max(rate, fastest.value_or(0));
    }
    return fastest;
}

std::optional<LoopGrowth> loop_growth(const Setup& setup, TipPlace place) {
    return loop_growth(setup, place, setup.digital.sampling.period);
}

}  // namespace arm3r
