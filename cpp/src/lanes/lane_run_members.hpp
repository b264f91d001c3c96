#pragma once
// The members of LaneRun (lane_run.hpp) that are not part of its steps, for the files that compile it.

#include <algorithm>

#include "arm3r/numbers/widths.hpp"
#include "integrate/taylor.hpp"
#include "lanes/lane_run.hpp"
#include "record/metrics.hpp"

namespace arm3r {

template <class T, std::size_t N>
LaneRun<T, N>::LaneRun(const Setup& any_lane, ContactFelt felt)
    : rhs_((copy_choices(any_lane.plant, plant_), plant_)),
      has_common_terms_(has_common_terms(any_lane.plant)),
      felt_(felt),
      may_be_ill_conditioned_(batch_key_of(any_lane).may_be_ill_conditioned),
      is_controlled_(any_lane.digital.sampling.on || any_lane.estimation.on),
      contact_(plant_.contact, is_damped(any_lane.plant.contact.law) || felt == ContactFelt::by_mode),
      performance_(any_lane, plant_, contact_.law(),
                   any_lane.digital.sampling.on ? sampled_.controller() : plant_.controller),
      rest_(any_lane) {
    rhs_.law_function = compiled_law<T, T>();
    rest_.stop = rest_.start;
    rest_.qd = {0, 0, 0};
    for (int lane = 0; lane < lanes; ++lane) clear_lane(lane);
}

template <class T, std::size_t N>
void LaneRun<T, N>::load_lane(int lane, const Setup& setup) {
    const auto set = [&](T& x, double value) { Lanes<T>::set(x, lane, value); };
    setups_[lane] = &setup;
    each_number(set, plant_, setup.plant);
    if (plant_.wall.motion == Motion::table) each_table_number(set, *plant_.wall.table, *setup.plant.wall.table);
    for (int i = 0; i < 3; ++i) {
        set(y_[i], setup.q[i]);
        set(y_[3 + i], setup.qd[i]);
    }
    for (std::size_t i = motion_size; i < N; ++i) set(y_[i], 0.0);
    set(accepted_, 0.0), set(rejected_, 0.0), set(evaluations_, 0.0);
    if (has_law(plant_.controller.type)) each_law_number(set, plant_.controller, setup.plant.controller);
    if (has_memory(plant_)) {
        each_sensor_number(set, plant_.sensors, setup.plant.sensors);
        each_observer_number(set, plant_.observer, setup.plant.observer);
    }
    if (plant_.external_force.on) each_external_force_number(set, plant_.external_force, setup.plant.external_force);
    if (is_controlled_) sampled_.load_lane(lane, setup.digital, setup.estimation);
    set(rhs_.contact, 0.0), set(rhs_.force_phase, 0.0);
    set(t_, setup.start), set(stop_, setup.stop);
    set(max_steps_, setup.solver.max_steps);
    contact_.load_lane(lane, setup.plant.contact, setup.start);
    performance_.load_lane(lane);
    set(next_knot_, next_metric_knot(lane, setup.start));
    outcome_[lane] = ARM3R_RUN_OK;
    is_new_[lane] = true;
    set_running(lane, true);
    set_mode(lane, ContactMode::free);
}

template <class T, std::size_t N>
void LaneRun<T, N>::start_lane(int lane) {
    const Wall<double>& wall = setups_[lane]->plant.wall;
    const double depth = plant_.has_wall ? Lanes<T>::get(in_.depth, lane) : 0;
    if (depth > 0) {
        const bool within =
            abs(Lanes<T>::get(in_.across1, lane)) <= wall.half1 && abs(Lanes<T>::get(in_.across2, lane)) <= wall.half2;
        set_mode(lane, within ? ContactMode::contact : ContactMode::embedded);
        if (mode(lane) == ContactMode::contact && felt_ == ContactFelt::by_mode && would_pull(lane))
            set_mode(lane, ContactMode::separated);
    }
    if (is_touching(mode(lane))) contact_.begin(lane, setups_[lane]->start, depth, force_of(lane));
    const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
    balance_.start(lane, {get(kinetic_), get(potential_), get(stored(in_))});
    Lanes<T>::set(evaluations_, lane, needs_derivative_ ? 1.0 : 0.0);
}

template <class T, std::size_t N>
void LaneRun<T, N>::observe_outlined() {
    Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { observe(); });
}

// The derivative is evaluated again, with the new contact.
template <class T, std::size_t N>
void LaneRun<T, N>::reevaluate() {
    if (!needs_derivative_) return;
    Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { derive(); });
}

template <class T, std::size_t N>
void LaneRun<T, N>::update_controller(const Mask& due) {
    Outlined<T>::run([this, &due]() ARM3R_INLINE_LAMBDA {
        PlantOutput<T> now = plant_output();
        sampled_.update(due, slack_, plant_.arm, now, plant_.held_torque);
        if (!asks_estimator(plant_.controller)) return;
        if (sampled_.estimates())
            plant_.controller.gains.assumed_stiffness = sampled_.controller_state().assumed_stiffness;
    });
    if (sampled_.has_failed()) stop_lane(0, ARM3R_RUN_CONTROLLER);
}

// The initial memory of a law depends on the contact, which start_lane() has determined.
template <class T, std::size_t N>
void LaneRun<T, N>::start_memory() {
    if constexpr (N == full_size) {
        for (int lane = 0; lane < lanes; ++lane)
            if (is_new_[lane]) update_inputs(lane);
        Y start;
        Outlined<T>::run(
            [&]() ARM3R_INLINE_LAMBDA { start = rhs_.with_initial_memory(y_, wall_, plant_output().measurement); });
        for (std::size_t i = law_at; i < full_size; ++i)
            for (int lane = 0; lane < lanes; ++lane)
                if (is_new_[lane]) Lanes<T>::set(y_[i], lane, Lanes<T>::get(start[i], lane));
    }
}

template <class T, std::size_t N>
void LaneRun<T, N>::update_inputs(int lane) {
    if constexpr (N == full_size) {
        ContinuousInputs inputs = this->inputs(lane);
        double integral = Lanes<T>::get(y_[law_at], lane);
        inputs.update(plant_.controller, is_touching(mode(lane)), integral);
        Lanes<T>::set(rhs_.contact, lane, inputs.contact);
        Lanes<T>::set(rhs_.force_phase, lane, inputs.force_phase);
        Lanes<T>::set(y_[law_at], lane, integral);
    }
}

// An empty lane is at the end of a run of no duration and does not move.
template <class T, std::size_t N>
void LaneRun<T, N>::clear_lane(int lane) {
    load_lane(lane, rest_);
    is_new_[lane] = false;
    set_running(lane, false);
}

template <class T, std::size_t N>
void LaneRun<T, N>::set_running(int lane, bool running) {
    running_[lane] = running;
    any_running_ = std::any_of(running_.begin(), running_.end(), [](bool is) { return is; });
    Lanes<T>::mark(active_, lane, running);
    Lanes<T>::mark(started_, lane, false);  // until it starts
}

template <class T, std::size_t N>
void LaneRun<T, N>::set_mode(int lane, ContactMode mode) {
    contact_.set_mode(lane, mode);
    if (felt_ == ContactFelt::by_mode) {
        rhs_.touching = contact_.touching() || contact_.separated();
        rhs_.separated = contact_.separated();
        rhs_.force_mode = any(rhs_.touching) ? ContactForceMode::pressed : ContactForceMode::none;
        return;
    }
    const bool feels = felt_ == ContactFelt::in_contact ? mode == ContactMode::contact && plant_.acts_on_arm
                                                        : mode != ContactMode::embedded;
    const Contact<double>& own = setups_[lane]->plant.contact;
    const auto set = [&](T& strength, double value) { Lanes<T>::set(strength, lane, feels ? value : 0.0); };
    for (int i = 0; i < 3; ++i) set(plant_.contact.stiffness[i], own.stiffness[i]);
    set(plant_.contact.damping, own.damping);
}

template <class T, std::size_t N>
Indentation<double> LaneRun<T, N>::indentation_of(int lane) const {
    const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
    return {get(in_.depth), get(in_.rate), get(in_.across1), get(in_.across2), get(in_.slip1), get(in_.slip2)};
}

template <class T, std::size_t N>
double LaneRun<T, N>::force_of(int lane) const {
    if (mode(lane) != ContactMode::contact) return 0;
    return normal_force(setups_[lane]->plant.contact, indentation_of(lane));
}

template <class T, std::size_t N>
bool LaneRun<T, N>::would_pull(int lane) const {
    const Contact<double>& law = setups_[lane]->plant.contact;
    return is_damped(law.law) && normal_force_law(law, indentation_of(lane)).release < 0;
}

template <class T, std::size_t N>
void LaneRun<T, N>::change_mode(int lane, const ContactChange& change) {
    if (on_change_) on_change_(lane, change);
    const auto add = [lane](T& x, double more) { Lanes<T>::set(x, lane, Lanes<T>::get(x, lane) + more); };
    add(y_[work_of_wall], change.gained);
    add(y_[dissipated], change.lost);
    if (contact_.count(lane, change)) stop_lane(lane, ARM3R_RUN_EVENT_STORM);
    set_mode(lane, change.to);
    update_inputs(lane);
}

template <class T, std::size_t N>
void LaneRun<T, N>::fail_lanes(const Mask& bad) {
    for (int lane = 0; lane < lanes; ++lane) {
        if (!running_[lane] || !Lanes<T>::is(bad, lane)) continue;
        const FullState y = state_of(y_, lane);
        const bool used_up = Lanes<T>::get(accepted_, lane) >= Lanes<T>::get(max_steps_, lane) && !at_stop(lane);
        if (is_out_of_range(y)) stop_lane(lane, ARM3R_RUN_DIVERGED);
        else if (used_up) stop_lane(lane, ARM3R_RUN_BUDGET);
        else stop_lane(lane, ARM3R_RUN_ILL_CONDITIONED);
    }
}

template <class T, std::size_t N>
Metrics LaneRun<T, N>::metrics(int lane) const {
    const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
    const Setup& setup = *setups_[lane];
    const bool touches = is_touching(mode(lane));

    Metrics m;
    m.outcome = outcome_[lane];
    set_end_values(setup, get(t_), state_of(y_, lane), touches, contact_.tally(lane), contact_.peak(lane), m);
    m.impulse = contact_.impulse(lane);
    m.final_force = force_of(lane);
    m.steps = steps(lane);
    if (performance_.is_on()) write_performance(performance_.sums(lane), setup, m);
    if (is_controlled_ && touches) set_estimate(sampled_.controller_state(), lane, m);
    const EnergyTotals totals = this->totals(lane);
    m.ledger_residual = totals.residual;
    const bool balances = totals.residual <= balance_limit(setup.solver, totals);
    if (m.outcome == ARM3R_RUN_OK && is_strict(setup.solver) && !balances) m.outcome = ARM3R_RUN_ENERGY;
    return m;
}

// Each member by name: `template class` would also compile the functions that are inlined everywhere (ARM3R_INLINE).
#define ARM3R_LANE_RUN(T, N)                                             \
    template LaneRun<T, N>::LaneRun(const Setup&, ContactFelt);          \
    template void LaneRun<T, N>::load_lane(int, const Setup&);           \
    template void LaneRun<T, N>::start_lane(int);                        \
    template void LaneRun<T, N>::observe_outlined();                     \
    template void LaneRun<T, N>::reevaluate();                           \
    template void LaneRun<T, N>::update_controller(const Mask&);         \
    template void LaneRun<T, N>::start_memory();                         \
    template void LaneRun<T, N>::clear_lane(int);                        \
    template void LaneRun<T, N>::change_mode(int, const ContactChange&); \
    template void LaneRun<T, N>::fail_lanes(const Mask&);                \
    template Metrics LaneRun<T, N>::metrics(int) const;                  \
    template Indentation<double> LaneRun<T, N>::indentation_of(int) const;

}  // namespace arm3r
