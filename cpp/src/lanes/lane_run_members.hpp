#pragma once
// What March (march.hpp) does apart from its steps, for the files that build it.

#include <algorithm>

#include "base/noinline.hpp"
#include "control/compiled_laws.hpp"
#include "integrate/taylor.hpp"
#include "lanes/lane_run.hpp"
#include "run/run_recorder.hpp"

namespace arm3r {

// A mask is set lane by lane through a number.
template <class T, class Items, class Item>
typename Lanes<T>::Mask mask_where(const Items& items, Item wanted) {
    T here(0.0);
    for (int lane = 0; lane < Lanes<T>::count; ++lane)
        if (items[lane] == wanted) Lanes<T>::set(here, lane, 1.0);
    return here > T(0.0);
}

template <class T, std::size_t N>
March<T, N>::March(const Setup& any_lane)
    : rhs_((copy_choices(any_lane.plant, plant_), plant_)),
      may_be_ill_conditioned_(structure_of(any_lane).may_be_ill_conditioned),
      is_controlled_(any_lane.digital.sampling.on || any_lane.estimation.on),
      is_scored_(any_lane.is_scored()),
      looks_(any_lane),
      true_contact_(plant_.contact),
      is_elastic_(!is_damped(any_lane.plant.contact.law)) {
    rhs_.law_function = compiled_law<T, T>();
    for (int lane = 0; lane < lanes; ++lane) {
        setups_[lane] = any_lane;
        retire(lane);
    }
}

template <class T, std::size_t N>
void March<T, N>::put(int lane, const Setup& setup) {
    const auto set = [&](T& x, double value) { Lanes<T>::set(x, lane, value); };
    setups_[lane] = setup;
    each_number(set, plant_, setup.plant);
    if (plant_.wall.motion == Motion::table) each_table_number(set, *plant_.wall.table, *setup.plant.wall.table);
    for (int i = 0; i < 3; ++i) {
        set(y_[i], setup.q[i]);
        set(y_[3 + i], setup.qd[i]);
    }
    for (std::size_t i = motion_size; i < N; ++i) set(y_[i], 0.0);
    for (T* zero : {&residual_, &exchanged_, &held_, &deepest_, &depth_time_, &peak_, &impulse_, &accepted_, &rejected_,
                    &evaluations_})
        set(*zero, 0.0);
    if (has_law(plant_.controller.type)) each_law_number(set, plant_.controller, setup.plant.controller);
    if (has_memory(plant_)) {
        each_sensor_number(set, plant_.sensors, setup.plant.sensors);
        each_observer_number(set, plant_.observer, setup.plant.observer);
    }
    if (plant_.load.on) each_load_number(set, plant_.load, setup.plant.load);
    if (is_controlled_) loop_.put(lane, setup.digital, setup.estimation);
    set_tally(lane, {});
    set(rhs_.contact, 0.0), set(rhs_.force_phase, 0.0);
    set(t_, setup.start), set(stop_, setup.stop), set(peak_time_, setup.start);
    set(max_steps_, setup.solver.max_steps);
    each_contact_number(set, true_contact_, setup.plant.contact);
    contacts_[lane] = {
        0, 0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(), 0, setup.start, 0};
    outcome_[lane] = ARM3R_RUN_OK;
    is_new_[lane] = true;
    set_running(lane, false);  // of a run before this one
    set_running(lane, true);
    set_mode(lane, Mode::free);
}

template <class T, std::size_t N>
void March<T, N>::begin_lane(int lane) {
    const Wall<double>& wall = setups_[lane].plant.wall;
    const double depth = plant_.has_wall ? Lanes<T>::get(in_.depth, lane) : 0;
    if (depth > 0) {
        const bool within =
            abs(Lanes<T>::get(in_.across1, lane)) <= wall.half1 && abs(Lanes<T>::get(in_.across2, lane)) <= wall.half2;
        set_mode(lane, within ? Mode::contact : Mode::embedded);
    }
    if (mode_[lane] == Mode::contact) {
        contacts_[lane].count = contacts_[lane].events = 1;
        contacts_[lane].first_contact = setups_[lane].start;
        Lanes<T>::set(deepest_, lane, depth);
        Lanes<T>::set(peak_, lane, force_of(lane));
    }
    const double kinetic = Lanes<T>::get(kinetic_, lane), potential = Lanes<T>::get(potential_, lane);
    const double contact = Lanes<T>::get(stored(), lane);
    Lanes<T>::set(energy_at_start_, lane, kinetic + potential + contact);
    Lanes<T>::set(potential_at_start_, lane, potential);
    Lanes<T>::set(held_, lane, std::abs(kinetic) + std::abs(potential) + std::abs(contact));
    Lanes<T>::set(evaluations_, lane, needs_derivative_ ? 1.0 : 0.0);
}

template <class T, std::size_t N>
void March<T, N>::look() {
    Apart<T>::run([this]() ARM3R_INLINE_LAMBDA { observe(); });
}

// What a change of contact has changed is felt from here on.
template <class T, std::size_t N>
void March<T, N>::evaluate_anew() {
    if (!needs_derivative_) return;
    Apart<T>::run([this]() ARM3R_INLINE_LAMBDA { derive(); });
}

template <class T, std::size_t N>
void March<T, N>::control() {
    Apart<T>::run([this]() ARM3R_INLINE_LAMBDA {
        Instant<T> now = instant();
        loop_.attend(is_due(), slack_, plant_.arm, now, plant_.controller.torque);
        if (!asks_estimator(plant_.controller)) return;
        T& assumed = plant_.controller.gains.assumed_stiffness;
        assumed = select(loop_.known().identifiable > T(0.0), loop_.known().stiffness, assumed);
    });
    if (loop_.has_failed()) stop_lane(0, ARM3R_RUN_CONTROLLER);
}

template <class T, std::size_t N>
Tally<double> March<T, N>::tally_of(int lane) const {
    Tally<double> tally;
    each_tally_number([&](double& to, const T& from) { to = Lanes<T>::get(from, lane); }, tally, tally_);
    return tally;
}

template <class T, std::size_t N>
void March<T, N>::set_tally(int lane, const Tally<double>& tally) {
    each_tally_number([&](T& to, const double& from) { Lanes<T>::set(to, lane, from); }, tally_, tally);
}

// A law's memory at the start needs the contact that begin_lane() has found.
template <class T, std::size_t N>
void March<T, N>::start_memory() {
    if constexpr (N == full_size) {
        const Instant<T> now = instant();
        const Sensed<T>& truth = now.seen;
        const Vec3<T> p = momentum(plant_.controller.model, p_, truth.qd);
        const auto start = [&](std::size_t i, const T& value) {
            for (int lane = 0; lane < lanes; ++lane)
                if (is_new_[lane]) Lanes<T>::set(y_[i], lane, Lanes<T>::get(value, lane));
        };
        for (int i = 0; i < 3; ++i) start(filter_at + i, truth.f_on_tip[i]);
        for (int lane = 0; lane < lanes; ++lane)
            if (is_new_[lane]) tell_controller(lane);
        if (has_law(plant_.controller.type)) {
            const Sensed<T> sensed = rhs_.sense(t_, wall_, p_, truth.q, truth.qd, truth.f_on_tip, y_);
            const std::array<T, law_memory> memory = memory_at_start(plant_.controller, sensed);
            for (std::size_t i = 0; i < law_memory; ++i) start(law_at + i, memory[i]);
        }
        for (int i = 0; i < 3; ++i) start(observer_at + i, p[i]);
    }
}

// A continuous controller sees contact as it is; its integral starts anew with each (7.4).
template <class T, std::size_t N>
void March<T, N>::tell_controller(int lane) {
    if constexpr (N == full_size) {
        const Controller<double>& controller = setups_[lane].plant.controller;
        const double contact = mode_[lane] == Mode::contact ? 1 : 0, before = force_phase(lane);
        const double phase = controller.switching == Switching::always       ? 1
                             : controller.switching == Switching::in_contact ? contact
                                                                             : std::max(before, contact);
        Lanes<T>::set(rhs_.contact, lane, contact);
        Lanes<T>::set(rhs_.force_phase, lane, phase);
        if (contact == 0 && integrates_force(controller.type)) Lanes<T>::set(y_[law_at], lane, 0.0);
    }
}

// An empty lane stands still at the end of a run of no length.
template <class T, std::size_t N>
void March<T, N>::retire(int lane) {
    Setup rest = setups_[lane];
    rest.stop = rest.start;
    rest.qd = {0, 0, 0};
    put(lane, rest);
    is_new_[lane] = false;
    set_running(lane, false);
}

template <class T, std::size_t N>
void March<T, N>::set_running(int lane, bool running) {
    running_[lane] = running;
    alive_ = mask_where<T>(running_, true);
    begun_ = begun_ && alive_;
}

template <class T, std::size_t N>
void March<T, N>::set_mode(int lane, Mode mode) {
    mode_[lane] = mode;
    touching_ = mask_where<T>(mode_, Mode::contact);
    embedded_ = mask_where<T>(mode_, Mode::embedded);
    any_touching_ = any(touching_);
    any_embedded_ = any(embedded_);
    const bool feels = only_contact_is_felt_ ? mode == Mode::contact && plant_.acts_on_arm : mode != Mode::embedded;
    const Contact<double>& own = setups_[lane].plant.contact;
    const auto set = [&](T& strength, double value) { Lanes<T>::set(strength, lane, feels ? value : 0.0); };
    for (int i = 0; i < 3; ++i) set(plant_.contact.stiffness[i], own.stiffness[i]);
    set(plant_.contact.damping, own.damping);
}

template <class T, std::size_t N>
double March<T, N>::force_of(int lane) const {
    const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
    return normal_force(setups_[lane].plant.contact, Indentation<double>{get(in_.depth), get(in_.rate), 0, 0, 0, 0});
}

template <class T, std::size_t N>
void March<T, N>::pass(int lane, const Polynomial<double>& depth, double t0, double a, double b) {
    if (mode_[lane] != Mode::contact) return;
    const double h = Lanes<T>::get(h_, lane);
    if (!is_elastic_)
        return pass_damped(lane, forces(setups_[lane].plant.contact, depth, h, a, b), t0 + h * a, h * (b - a));
    if (range_of(depth).high > Lanes<T>::get(deepest_, lane)) {
        const Maximum most = maximum(depth, a, b);
        note_peak(lane, most.value, t0 + h * most.place, deepest_);
    }
    Lanes<T>::set(depth_time_, lane, Lanes<T>::get(depth_time_, lane) + h * integral(depth, a, b));
}

template <class T, std::size_t N>
void March<T, N>::pass_damped(int lane, const std::array<double, 5>& force, double t0, double duration) {
    const Polynomial<double> over_time = through_five(force);
    if (range_of(over_time).high > Lanes<T>::get(peak_, lane)) {
        const Maximum most = maximum(over_time, 0, 1);
        note_peak(lane, most.value, t0 + duration * most.place, peak_);
    }
    Lanes<T>::set(impulse_, lane, Lanes<T>::get(impulse_, lane) + duration * mean_of_five(force));
}

template <class T, std::size_t N>
void March<T, N>::note_peak(int lane, double value, double t, T& peak) {
    if (!(value > Lanes<T>::get(peak, lane))) return;
    Lanes<T>::set(peak, lane, value);
    Lanes<T>::set(peak_time_, lane, t);
}

template <class T, std::size_t N>
void March<T, N>::change_mode(int lane, const Change& change) {
    const auto add = [lane](T& x, double more) { Lanes<T>::set(x, lane, Lanes<T>::get(x, lane) + more); };
    add(y_[work_of_wall], change.gained);
    add(y_[dissipated], change.lost);
    Contacts& contacts = contacts_[lane];
    contacts.lost_at_edges += change.lost_at_edge();
    if (change.to == Mode::contact) {
        if (contacts.count == 0) contacts.first_contact = change.t;
        contacts.count += 1;
        contacts.since = change.t;
    } else if (change.from == Mode::contact) {
        if (std::isnan(contacts.first_release)) contacts.first_release = change.t;
        contacts.time += change.t - contacts.since;
    }
    if (change.to == Mode::contact || change.from == Mode::contact) contacts.events += 1;
    if (contacts.events > most_events) stop_lane(lane, ARM3R_RUN_EVENT_STORM);
    set_mode(lane, change.to);
    if (N == full_size) tell_controller(lane);
}

template <class T, std::size_t N>
void March<T, N>::fail_lanes(const Mask& bad) {
    for (int lane = 0; lane < lanes; ++lane) {
        if (!running_[lane] || !Lanes<T>::is(bad, lane)) continue;
        const FullState y = state_of(y_, lane);
        const bool in_range = abs(y[0]) <= sincos_limit && abs(y[1]) <= sincos_limit && abs(y[2]) <= sincos_limit;
        const double steps = Lanes<T>::get(accepted_, lane) + Lanes<T>::get(rejected_, lane);
        const bool used_up = steps >= Lanes<T>::get(max_steps_, lane) && !at_stop(lane);
        if (!in_range) stop_lane(lane, ARM3R_RUN_DIVERGED);
        else if (used_up) stop_lane(lane, ARM3R_RUN_BUDGET);
        else stop_lane(lane, ARM3R_RUN_ILL_CONDITIONED);
    }
}

template <class T, std::size_t N>
Metrics March<T, N>::metrics(int lane) const {
    const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
    const Setup& setup = setups_[lane];
    const FullState y = state_of(y_, lane);
    const auto joints_out = [&](const Vec3<double>& v) { return plain(setup.simscape ? flipped(v) : v); };
    const Contacts& contacts = contacts_[lane];
    const bool touches = mode_[lane] == Mode::contact;
    const double stiffness = get(true_contact_.stiffness[0]);

    Metrics m;
    m.outcome = outcome_[lane];
    m.t_end = get(t_);
    m.peak_force = peak_force(lane);
    if (contacts.count > 0) m.peak_force_time = get(peak_time_);
    m.impulse = is_elastic_ ? stiffness * get(depth_time_) : get(impulse_);
    m.contact_time = contacts.time + (touches ? m.t_end - contacts.since : 0);
    m.final_force = touches ? force_of(lane) : 0;
    m.ledger_residual = get(residual_);
    m.q = joints_out(angles(y));
    m.qd = joints_out(rates(y));
    m.tip = plain(tip_position(setup.plant.arm, pose(angles(y))));
    note_energies(y, setup.plant, contacts.lost_at_edges, m);
    m.contacts = contacts.count;
    m.first_contact = contacts.first_contact;
    m.first_release = contacts.first_release;
    m.steps = steps(lane);
    if (is_scored_) tell_score(tally_of(lane), setup, m);
    if (is_controlled_ && get(loop_.known().identifiable) > 0) {
        m.stiffness_estimate = get(loop_.known().stiffness);
        m.wall_speed_estimate = get(loop_.known().wall_speed);
    }
    const bool balances = m.ledger_residual <= balance_limit(setup.solver, flows(lane));
    if (m.outcome == ARM3R_RUN_OK && is_strict(setup.solver) && !balances) m.outcome = ARM3R_RUN_ENERGY;
    return m;
}

template <class T, std::size_t N>
Flows March<T, N>::flows(int lane) const {
    const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
    return {get(exchanged_), get(held_), get(residual_), leverage(setups_[lane].plant, peak_force(lane))};
}

// By name: `template class` would also build, for no caller, what is inlined everywhere (ARM3R_INLINE).
#define ARM3R_MARCH(...)                                                                              \
    template March<__VA_ARGS__>::March(const Setup&);                                                 \
    template void March<__VA_ARGS__>::put(int, const Setup&);                                         \
    template void March<__VA_ARGS__>::begin_lane(int);                                                \
    template void March<__VA_ARGS__>::look();                                                         \
    template void March<__VA_ARGS__>::evaluate_anew();                                                \
    template void March<__VA_ARGS__>::control();                                                      \
    template void March<__VA_ARGS__>::start_memory();                                                 \
    template void March<__VA_ARGS__>::retire(int);                                                    \
    template void March<__VA_ARGS__>::pass(int, const Polynomial<double>&, double, double, double);   \
    template void March<__VA_ARGS__>::pass_damped(int, const std::array<double, 5>&, double, double); \
    template void March<__VA_ARGS__>::change_mode(int, const Change&);                                \
    template void March<__VA_ARGS__>::fail_lanes(const Mask&);                                        \
    template Tally<double> March<__VA_ARGS__>::tally_of(int) const;                                   \
    template void March<__VA_ARGS__>::set_tally(int, const Tally<double>&);                           \
    template Metrics March<__VA_ARGS__>::metrics(int) const;                                          \
    template Flows March<__VA_ARGS__>::flows(int) const;

}  // namespace arm3r
