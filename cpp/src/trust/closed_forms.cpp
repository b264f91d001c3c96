#include "trust/closed_forms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "batch/simulation.hpp"
#include "contact/contact_change.hpp"
#include "record/energy_balance.hpp"
#include "schema/columns.hpp"
#include "trust/enclosure.hpp"
#include "trust/exact_solver.hpp"
#include "trust/linear_impact.hpp"

namespace arm3r {
namespace {

// A state of the arm, with the wall as the tip meets it.
struct Meeting {
    double t;
    Vec3<double> q, qd, n;
    Indentation<double> in;
    double wall_acceleration;  // m/s^2, along n
};

Meeting meeting_at(const Plant<double>& plant, double t, const Vec3<double>& q, const Vec3<double>& qd) {
    const WallState<double> wall = wall_at(plant.wall, t);
    const Vec3<double> n = normal(plant.wall, wall);
    return {t, q, qd, n, tip_indentation(plant, wall, pose(q), qd), dot(n, wall.acceleration)};
}

Meeting meeting_at(const Setup& setup, const Event& event) {
    return meeting_at(setup.plant, event.t, setup.convention.to_slide(Vec3<double>(event.q.data())),
                      setup.convention.flipped(Vec3<double>(event.qd.data())));
}

// ---- the motion along the normal, less the wall's force (9.2)

// How far the wall's acceleration along its normal may be from that at some instant, m/s^2.
double wall_departure(const Wall<double>& wall) {
    const double along = std::abs(dot(wall.n, wall.direction));
    switch (wall.motion) {
        case Motion::fixed:
        case Motion::constant: return 0;
        case Motion::sinusoid: {
            const double omega = two_pi * wall.sinusoid.frequency;
            return 2 * along * std::abs(wall.sinusoid.amplitude) * omega * omega;
        }
        case Motion::ramp: {
            const double T = wall.ramp.duration;
            return 2 * along * 10 / std::sqrt(3.0) * std::abs(wall.ramp.distance) / (T * T);
        }
        default: return INFINITY;
    }
}

// Whether the tip stays within the outline of a plate that does not slide, or slides evenly.
bool stays_inside(const Wall<double>& wall, const Meeting& at, const Enclosure& box, double time) {
    if (!wall.has_outline) return true;
    const auto stays = [&](const Vec3<double>& e, double place, double half) {
        const bool slides = wall.motion != Motion::constant && std::abs(dot(e, wall.direction)) > 1e-9;
        const Interval speed = dot(broadcast<Interval>(e), minus(box.tip_velocity, broadcast<Interval>(wall.velocity)));
        return !slides && (place + speed * Interval(0, time)).largest() < half;
    };
    return stays(wall.e1, at.in.across1, wall.half1) && stays(wall.e2, at.in.across2, wall.half2);
}

// The acceleration of the depth without a force, how far it may depart from that, and how fast the mobility may change.
struct Approach {
    double g, departure, mobility_rate;  // m/s^2, m/s^2, 1/(kg s)
};

std::optional<Approach> approach(const Setup& setup, const Meeting& at, const Span& span) {
    const Plant<double>& plant = setup.plant;
    const std::optional<Enclosure> box = enclose(plant, at.n, at.q, at.qd, span);
    if (!box || !stays_inside(plant.wall, at, *box, span.time)) return {};
    const Enclosure now = at_instant(plant, at.n, at.q, at.qd);
    return Approach{at.wall_acceleration - now.acceleration.low,
                    (box->acceleration - now.acceleration).largest() + wall_departure(plant.wall),
                    box->mobility_rate.largest()};
}

Approach approach(const Setup& setup, const Meeting& at) {
    const Enclosure now = at_instant(setup.plant, at.n, at.q, at.qd);
    return {at.wall_acceleration - now.acceleration.low, 0, 0};
}

// ---- before the contact (9.4)

// When a depth that begins at -gap, with speed v and acceleration g, reaches 0; NaN: never.
double arrival(double gap, double v, double g) { return 2 * gap / (v + std::sqrt(v * v + 2 * g * gap)); }

double norm_of(const Vec3<double>& v) { return std::sqrt(dot(v, v)); }

// s: what rounding makes of the instant of a contact: of lengths that nearly cancel in the gap, and speeds in its rate,
// at the speed in the end; and of the clock.
double rounding_of_arrival(const Plant<double>& plant, const Meeting& start, double duration, double speed) {
    constexpr double unit = 4 * std::numeric_limits<double>::epsilon();
    const Pose<double> p = pose(start.q);
    const WallState<double> wall = wall_at(plant.wall, start.t);
    const double lengths = norm_of(tip_position(plant.arm, p)) + reach(plant.arm) + norm_of(plant.wall.point) +
                           norm_of(wall.position) + std::abs(plant.wall.face_offset);
    const double speeds = norm_of(tip_velocity(plant.arm, p, start.qd)) + norm_of(wall.velocity);
    const double clock = std::max(std::abs(start.t), std::abs(start.t + duration));
    return unit * (lengths + speeds * duration) / speed + std::max(event_time_tolerance, unit * clock);
}

void add_contact_instant(const Setup& setup, const Run& run, double tolerance, std::vector<ClosedForm>& forms) {
    const Meeting start = meeting_at(setup.plant, setup.start, setup.q, setup.qd);
    const double gap = -start.in.depth, v = start.in.rate, g = approach(setup, start).g;
    const double duration = arrival(gap, v, g), time = 1.2 * duration;
    if (!(gap > 0 && duration > 0 && duration < INFINITY)) return;
    const std::optional<Approach> on_the_way = approach(setup, start, {time, 0});
    if (!on_the_way) return;
    const double early = arrival(gap, v, g + on_the_way->departure), late = arrival(gap, v, g - on_the_way->departure);
    if (!(late < time)) return;
    const double speed = std::sqrt(v * v + 2 * g * gap);
    forms.push_back({"first_contact", "s", run.first_contact, setup.start + duration,
                     std::max(duration - early, late - duration) + tolerance * duration +
                         rounding_of_arrival(setup.plant, start, duration, speed)});
}

// A wall that passes through the tip of an arm which does not feel it.
void add_force_of_replay(const Setup& setup, const Run& run, double tolerance, std::vector<ClosedForm>& forms) {
    const Meeting start = meeting_at(setup.plant, setup.start, setup.q, setup.qd);
    const double time = run.t_end - setup.start, k = setup.plant.contact.stiffness[0];
    const std::optional<Approach> all_the_way = approach(setup, start, {time, 0});
    if (!all_the_way || run.events.back().type != Event::make || !is_spring(setup.plant.contact.law)) return;
    const double depth = start.in.depth + (start.in.rate + all_the_way->g * time / 2) * time;
    const double allowed = all_the_way->departure * time * time / 2;
    if (allowed < depth)
        forms.push_back({"final_force", "N", run.final_force, k * depth, k * (allowed + tolerance * depth)});
}

// ---- the contacts (9.1), (9.3)

bool is_linear(const Contact<double>& contact) {
    const bool holds_sideways = contact.stiffness[1] > 0 || contact.stiffness[2] > 0;
    return is_linear(contact.law) && !holds_sideways && !contact.has_friction;
}

// The span is guessed from the impact, and enlarged until the bounds keep within it.
std::optional<ImpactNumbers> bounds_of(const Setup& setup, const Meeting& at, const LinearImpact& impact,
                                       const ImpactNumbers& numbers) {
    Span span{1.02 * numbers.duration, 1.02 * numbers.impulse};
    for (int attempt = 0; attempt < 12; ++attempt) {
        const std::optional<Approach> during = approach(setup, at, span);
        if (!during) return {};
        const auto bounds = departures(impact, {during->departure, during->mobility_rate, span.time});
        if (!bounds) return {};
        const double impulse = numbers.impulse + bounds->most.impulse;
        if (bounds->end <= span.time && impulse <= span.impulse) return bounds->most;
        span = {std::max(span.time, 1.02 * bounds->end), std::max(span.impulse, 1.02 * impulse)};
    }
    return {};
}

// Of all contacts of a run.
struct Sums {
    ImpactNumbers form{0, 0, 0}, allowed{0, 0, 0};

    void add(const ImpactNumbers& numbers, const ImpactNumbers& bounds) {
        form.peak_force = std::max(form.peak_force, numbers.peak_force);
        allowed.peak_force = std::max(allowed.peak_force, bounds.peak_force);
        form.duration += numbers.duration;
        allowed.duration += bounds.duration;
        form.impulse += numbers.impulse;
        allowed.impulse += bounds.impulse;
    }
};

// Whether a closed form and its bounds exist.
bool add_contact(const Setup& setup, const Event& event, Sums& sums) {
    const Meeting at = meeting_at(setup, event);
    const Contact<double>& contact = setup.plant.contact;
    const double m = effective_mass(setup.plant.arm, pose(at.q), at.n), k = contact.stiffness[0];
    const double c = contact.damping;
    const LinearImpact impact{m, k, c, at.in.rate, approach(setup, at).g};
    if (event.t <= setup.start || !(impact.v > 0) || !(c < 2 * std::sqrt(k * m))) return false;
    const std::optional<ImpactNumbers> numbers = numbers_of(impact);
    if (!numbers) return false;
    const std::optional<ImpactNumbers> bounds = bounds_of(setup, at, impact, *numbers);
    if (bounds) sums.add(*numbers, *bounds);
    return bounds.has_value();
}

void add_contacts(const Setup& setup, const Run& run, std::span<const Event> events, double tolerance,
                  std::vector<ClosedForm>& forms) {
    if (run.events.back().type != Event::brk || events.back().type != Event::brk) return;
    Sums sums;
    for (const Event& event : events)
        if (event.type == Event::make && !add_contact(setup, event, sums)) return;
    const auto add = [&](std::string_view name, std::string_view unit, double own, double form, double allowed) {
        if (allowed < form) forms.push_back({name, unit, own, form, allowed + tolerance * form});
    };
    add("peak_force", "N", run.peak_force, sums.form.peak_force, sums.allowed.peak_force);
    add("contact_time", "s", run.contact_time, sums.form.duration, sums.allowed.duration);
    add("impulse", "N s", run.impulse, sums.form.impulse, sums.allowed.impulse);
}

// ---- at rest on the wall (9.5)

void add_steady_force(const Setup& setup, const Run& run, double tolerance, std::vector<ClosedForm>& forms) {
    if (!run.at_end || run.events.back().type != Event::make || setup.plant.external_force.on) return;
    const Arm<double>& arm = setup.plant.arm;
    const Vec3<double> q = setup.convention.to_slide(Vec3<double>(run.q.data())),
                       qd = setup.convention.flipped(Vec3<double>(run.qd.data()));
    const Meeting end = meeting_at(setup.plant, run.t_end, q, qd);
    const Pose<double> p = pose(q);
    const Vec3<double> carried = times(inverse_jacobian(arm, p), end.n);  // f_n = carried . (J^T f)
    const Vec3<double> moving =
        plus(times(mass_matrix(arm, p), setup.convention.flipped(Vec3<double>(run.at_end->qdd.data()))),
             velocity_product(arm, p, qd));
    const Vec3<double> holding = minus(plus(gravity_torque(arm, p), friction_torque(arm, qd)),
                                       setup.convention.flipped(Vec3<double>(run.at_end->tau.data())));
    const double form = dot(carried, holding), allowed = std::abs(dot(carried, moving));
    if (allowed < 0.01 * form) forms.push_back({"final_force", "N", run.final_force, form, allowed + tolerance * form});
}

// ---- where and how fast the tip meets the wall

bool has_closed_motion(const Setup& setup) { return !setup.digital.sampling.on && is_passive(setup.plant); }

// The changes of contact by another, more exact method: the run's own error is to stand in its numbers only. Nothing
// where that run ends at another instant.
std::vector<Event> exact_events(const Setup& setup, const Run& run) {
    Setup exact = setup;
    exact.solver = exact_solver(setup.solver);
    exact.stop = run.t_end;
    exact.log_every = 2 * (run.t_end - setup.start);  // no rows but the first and the last
    exact.metrics = {};
    const Run other = run.t_end > setup.start ? simulate(exact, {.judges = false}) : Run{};
    return other.t_end == run.t_end ? other.events : std::vector<Event>{};
}

// Whether the tip has its speed of before the contact where a run meets the wall: steps of rk4 end beyond it.
bool knows_approach(const Setup& setup) {
    return has_closed_motion(setup) || !setup.solver.is_on_grid() || !setup.plant.acts_on_arm;
}

}  // namespace

ClosedForms closed_forms(const Setup& setup, const Run& run) {
    ClosedForms found;
    if (run.events.empty() || run.events.front().type != Event::make) return found;
    const bool is_closed = has_closed_motion(setup), turns = setup.plant.wall.rotation != Rotation::none;
    const std::vector<Event> events = is_closed ? exact_events(setup, run) : run.events;
    if (events.empty() || events.front().type != Event::make) return found;
    const Meeting first = meeting_at(setup, events.front());
    found.effective_mass = effective_mass(setup.plant.arm, pose(first.q), first.n);
    if (knows_approach(setup)) found.approach_speed = first.in.rate;
    const double tolerance = balance_limit(setup.solver, {.throughput = 1});  // 100 times that of the method (4.9)
    const double of_both = tolerance + balance_limit(exact_solver(setup.solver), {.throughput = 1});
    if (!turns && is_closed) {
        add_contact_instant(setup, run, tolerance, found.forms);
        if (!setup.plant.acts_on_arm) add_force_of_replay(setup, run, tolerance, found.forms);
        else if (is_linear(setup.plant.contact)) add_contacts(setup, run, events, of_both, found.forms);
    }
    if (setup.plant.acts_on_arm) add_steady_force(setup, run, tolerance, found.forms);
    return found;
}

}  // namespace arm3r
