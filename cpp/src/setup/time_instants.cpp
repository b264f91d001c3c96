#include <algorithm>
#include <cmath>
#include <limits>

#include "arm3r/numbers/primitives.hpp"
#include "setup/time_instants.hpp"

namespace arm3r {
namespace {

template <class Load, class Visit>
void each_jump_of_external_force(Load& external_force, Visit visit) {
    if (!external_force.on) return;
    if (!(external_force.rise > 0)) visit(external_force.start);
    visit(external_force.end);
}

template <class W, class Visit>
void each_jump_of_wall(W& wall, Visit visit) {
    if (wall.motion != Motion::table) return;
    QuinticTable<double>& table = *wall.table;
    for (const int end : {std::size_t{0}, table.t.size() - 1})
        if (table.v[end] != 0) visit(table.t[end]);
}

template <class S, class Visit>
void each_jump_of_reference(S& reference, Visit visit) {
    if (reference.path == Path::line || reference.path == Path::sinusoid) visit(reference.start);
    if (reference.path == Path::line) visit(reference.end);
    if (reference.force_profile == ForceProfile::step) visit(reference.force_start);
}

// Of the instants that it is called with, those after t: `next` becomes the earliest of them.
auto earliest_after(double t, double& next) {
    return [t, &next](double instant) {
        if (instant > t) next = std::min(next, instant);
    };
}

// Of instants that increase.
double first_after(double t, std::span<const double> instants) {
    const auto found = std::ranges::upper_bound(instants, t);
    return found == instants.end() ? infinite : *found;
}

}  // namespace

double next_knot(const Wall<double>& wall, double t) {
    double next = infinite;
    const auto consider = earliest_after(t, next);
    if (wall.motion == Motion::ramp) {
        consider(wall.ramp.start);
        consider(wall.ramp.start + wall.ramp.duration);
    }
    if (wall.motion == Motion::table) next = std::min(next, first_after(t, wall.table->t));
    return next;
}

double next_knot(const Reference<double>& reference, double t) {
    double next = infinite;
    const auto consider = earliest_after(t, next);
    if (is_moving(reference.path)) consider(reference.start), consider(reference.end);
    if (reference.path == Path::table) next = std::min(next, first_after(t, (*reference.table)[0].t));
    if (reference.force_profile == ForceProfile::step || reference.force_profile == ForceProfile::ramp)
        consider(reference.force_start), consider(reference.force_start + reference.force_duration);
    return next;
}

double next_knot(const Setup& setup, double t) {
    const Plant<double>& plant = setup.plant;
    double next = plant.has_wall ? next_knot(plant.wall, t) : infinite;
    const auto consider = earliest_after(t, next);
    if (plant.external_force.on) {
        const ExternalForce<double>& external_force = plant.external_force;
        for (const double knot : {external_force.start, external_force.start + external_force.rise, external_force.end})
            consider(knot);
    }
    return has_law(setup.controller().type) ? std::min(next, next_knot(setup.controller().reference, t)) : next;
}

double next_jump(const Setup& setup, double t) {
    const Plant<double>& plant = setup.plant;
    double next = infinite;
    const auto consider = earliest_after(t, next);
    each_jump_of_external_force(plant.external_force, consider);
    if (plant.has_wall) each_jump_of_wall(plant.wall, consider);
    if (has_law(plant.controller.type)) each_jump_of_reference(plant.controller.reference, consider);
    return next;
}

double just_before(double t) {
    if (t == 0) return -std::numeric_limits<double>::denorm_min();
    return with_bits(t, [t](auto& bits) { bits += t > 0 ? -1 : 1; });
}

double Setup::clock_rounding() const {
    return 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(start), std::abs(stop));
}

void set_jumps_on_clock(Setup& setup) {
    const bool has_grid = setup.solver.is_on_grid(), has_samples = setup.digital.sampling.on;
    const double period = has_grid ? setup.solver.step : has_samples ? setup.digital.sampling.period : infinite;
    const auto nearest = [&](double jump, double every) {
        const double count = nearest_integer((jump - setup.start) / every);
        return setup.start + (count > 0 ? count * every : 0);
    };
    const auto snap = [&](double& jump) {
        for (const double instant : {setup.stop, nearest(jump, period)})
            if (std::abs(jump - instant) <= setup.clock_rounding()) {
                jump = instant;
                return;
            }
    };
    each_jump_of_external_force(setup.plant.external_force, snap);
    if (setup.plant.has_wall) each_jump_of_wall(setup.plant.wall, snap);
    Controller<double>& law = has_samples ? setup.digital.controller : setup.plant.controller;
    each_jump_of_reference(law.reference, snap);
}

std::vector<double> jumps_within_steps(const Setup& setup) {
    std::vector<double> jumps;
    if (!setup.solver.is_on_grid()) return jumps;
    const auto add = [&](double jump) { jumps.push_back(jump); };
    each_jump_of_external_force(setup.plant.external_force, add);
    if (setup.plant.has_wall) each_jump_of_wall(setup.plant.wall, add);
    if (has_law(setup.controller().type)) each_jump_of_reference(setup.controller().reference, add);
    return jumps;
}

}  // namespace arm3r
