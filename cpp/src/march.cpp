#include "march.hpp"

#include <algorithm>

#include "recorder.hpp"
#include "taylor.hpp"

namespace arm3r {
namespace {

// A mask is set lane by lane through a number.
template <class T, class Items, class Item>
typename Lanes<T>::Mask mask_where(const Items& items, Item wanted) {
    T here(0.0);
    for (int lane = 0; lane < Lanes<T>::count; ++lane)
        if (items[lane] == wanted) Lanes<T>::set(here, lane, 1.0);
    return here > T(0.0);
}

// Whether the determinant of joints 2 and 3 can fall to rounding in some pose.
bool may_be_ill_conditioned(const Arm<double>& arm) {
    const Lumped<double>& l = arm.lumped;
    const double largest = (l.B2 + l.B3 + 2 * std::abs(l.B)) * (l.B3 + l.J3);
    return !(smallest_lower_determinant(l).value > 64 * std::numeric_limits<double>::epsilon() * largest);
}

}  // namespace

Structure structure_of(const Setup& setup) {
    const Plant<double>& plant = setup.plant;
    const Arm<double>&arm = plant.arm, &model = plant.controller.model;
    return {setup.solver.method,
            setup.solver.method == Solver::taylor ? order_of(setup.solver.tol) : 0,
            plant.has_wall,
            plant.acts_on_arm,
            plant.wall.has_outline,
            may_be_ill_conditioned(arm),
            plant.wall.motion,
            plant.contact.law,
            plant.controller.type,
            plant.controller.algorithm,
            {arm.gravity_is_vertical, arm.has_damping, arm.has_dry_friction, arm.has_torque_limit,
             model.gravity_is_vertical, model.has_damping, model.has_dry_friction, model.has_torque_limit}};
}

template <class T>
March<T>::March(const Setup& any_lane)
    : rhs_((copy_choices(any_lane.plant, plant_), plant_)),
      may_be_ill_conditioned_(structure_of(any_lane).may_be_ill_conditioned) {
    for (int lane = 0; lane < lanes; ++lane) {
        setups_[lane] = any_lane;
        retire(lane);
    }
}

template <class T>
void March<T>::put(int lane, const Setup& setup) {
    const auto set = [&](T& x, double value) { Lanes<T>::set(x, lane, value); };
    setups_[lane] = setup;
    each_number([&](T& to, const double& from) { set(to, from); }, plant_, setup.plant);
    for (int i = 0; i < 3; ++i) {
        set(y_[i], setup.q[i]);
        set(y_[3 + i], setup.qd[i]);
    }
    for (std::size_t i = motion_size; i < state_size; ++i) set(y_[i], 0.0);
    for (T* zero :
         {&t_, &residual_, &exchanged_, &held_, &deepest_, &depth_time_, &accepted_, &rejected_, &evaluations_})
        set(*zero, 0.0);
    set(stop_, setup.stop);
    set(max_steps_, setup.solver.max_steps);
    set(stiffness_, setup.plant.contact.stiffness[0]);
    contacts_[lane] = {0, 0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(), 0, 0};
    outcome_[lane] = ARM3R_RUN_OK;
    is_new_[lane] = true;
    set_running(lane, true);
    set_mode(lane, Mode::free);
}

template <class T>
void March<T>::begin_lane(int lane) {
    is_new_[lane] = false;
    const Wall<double>& wall = setups_[lane].plant.wall;
    const double depth = plant_.has_wall ? Lanes<T>::get(in_.depth, lane) : 0;
    if (depth > 0) {
        const bool within =
            abs(Lanes<T>::get(in_.across1, lane)) <= wall.half1 && abs(Lanes<T>::get(in_.across2, lane)) <= wall.half2;
        set_mode(lane, within ? Mode::contact : Mode::embedded);
    }
    if (mode_[lane] == Mode::contact) {
        contacts_[lane].count = contacts_[lane].events = 1;
        contacts_[lane].first_contact = 0;
        Lanes<T>::set(deepest_, lane, depth);
    }
    const double kinetic = Lanes<T>::get(kinetic_, lane), potential = Lanes<T>::get(potential_, lane);
    const double contact = Lanes<T>::get(stored(), lane);
    Lanes<T>::set(energy_at_start_, lane, kinetic + potential + contact);
    Lanes<T>::set(potential_at_start_, lane, potential);
    Lanes<T>::set(held_, lane, std::abs(kinetic) + std::abs(potential) + std::abs(contact));
    Lanes<T>::set(evaluations_, lane, needs_derivative_ ? 1.0 : 0.0);
}

// An empty lane stands still at the end of a run of no length.
template <class T>
void March<T>::retire(int lane) {
    Setup rest = setups_[lane];
    rest.stop = 0;
    rest.qd = {0, 0, 0};
    put(lane, rest);
    is_new_[lane] = false;
    set_running(lane, false);
}

template <class T>
void March<T>::set_running(int lane, bool running) {
    running_[lane] = running;
    alive_ = mask_where<T>(running_, true);
}

template <class T>
void March<T>::set_mode(int lane, Mode mode) {
    mode_[lane] = mode;
    touching_ = mask_where<T>(mode_, Mode::contact);
    embedded_ = mask_where<T>(mode_, Mode::embedded);
    any_touching_ = any(touching_);
    any_embedded_ = any(embedded_);
    const bool feels = only_contact_is_felt_ ? mode == Mode::contact && plant_.acts_on_arm : mode != Mode::embedded;
    Lanes<T>::set(plant_.contact.stiffness[0], lane, feels ? setups_[lane].plant.contact.stiffness[0] : 0.0);
}

template <class T>
void March<T>::pass(int lane, const Polynomial<double>& depth, double a, double b) {
    if (mode_[lane] != Mode::contact) return;
    const double deepest = Lanes<T>::get(deepest_, lane), h = Lanes<T>::get(h_, lane);
    if (range_of(depth).high > deepest) Lanes<T>::set(deepest_, lane, std::max(deepest, largest(depth, a, b)));
    Lanes<T>::set(depth_time_, lane, Lanes<T>::get(depth_time_, lane) + h * integral(depth, a, b));
}

// What is still stored in the contact is lost (4.9): something where the tip leaves over an edge, else nothing.
template <class T>
void March<T>::change_mode(int lane, const Change& change) {
    Lanes<T>::set(y_[8], lane, Lanes<T>::get(y_[8], lane) + change.lost);
    Contacts& contacts = contacts_[lane];
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
}

template <class T>
void March<T>::fail_lanes(const Mask& bad) {
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

template <class T>
Metrics March<T>::metrics(int lane) const {
    const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
    const Setup& setup = setups_[lane];
    const FullState y = state_of(y_, lane);
    const auto joints_out = [&](const Vec3<double>& v) { return plain(setup.simscape ? flipped(v) : v); };
    const Contacts& contacts = contacts_[lane];
    const bool touches = mode_[lane] == Mode::contact;
    const double stiffness = get(stiffness_);

    Metrics m;
    m.outcome = outcome_[lane];
    m.t_end = get(t_);
    m.peak_force = stiffness * get(deepest_);
    m.impulse = stiffness * get(depth_time_);
    m.contact_time = contacts.time + (touches ? m.t_end - contacts.since : 0);
    m.final_force = touches ? stiffness * std::max(0.0, get(in_.depth)) : 0;
    m.ledger_residual = get(residual_);
    m.q = joints_out(angles(y));
    m.qd = joints_out(rates(y));
    m.tip = plain(tip_position(setup.plant.arm, pose(angles(y))));
    for (std::size_t i = motion_size; i < state_size; ++i) m.books[i - motion_size] = y[i];
    m.contacts = contacts.count;
    m.first_contact = contacts.first_contact;
    m.first_release = contacts.first_release;
    m.steps = steps(lane);
    const bool balances = m.ledger_residual <= balance_limit(setup.solver, flows(lane));
    if (m.outcome == ARM3R_RUN_OK && is_strict(setup.solver) && !balances) m.outcome = ARM3R_RUN_ENERGY;
    return m;
}

template <class T>
Flows March<T>::flows(int lane) const {
    return {Lanes<T>::get(exchanged_, lane), Lanes<T>::get(held_, lane), Lanes<T>::get(residual_, lane)};
}

template class March<double>;
template class March<Pack<2>>;
#if ARM3R_WIDE_PACKS
template class March<Pack<4>>;
template class March<Pack<8>>;
#endif

}  // namespace arm3r
