#include "run/performance.hpp"

#include <algorithm>
#include <cmath>

#include "arm3r/numbers/eigen_traits.hpp"
#include "control/compiled_laws.hpp"
#include "run/scalar_search.hpp"

namespace arm3r {
namespace {

// What is known at one instant of a step.
struct Instant {
    double t;
    FullState y;
    Pose<double> p;
    WallState<double> wall = no_wall<double>();
    Indentation<double> in{};  // zero unless it is asked for

    Instant(const Plant<double>& plant, double time, const FullState& state, bool needs_indentation)
        : t(time), y(state), p(pose(angles(state))) {
        if (plant.has_wall) wall = wall_at(plant.wall, t);
        if (plant.has_wall && needs_indentation) in = tip_indentation(plant, wall, p, rates(y));
    }
};

PerformanceSample<double> motion_at(const StepView& view, const Instant& now, const TrackedQuantities& wanted) {
    const Plant<double>& plant = view.setup.plant;
    PerformanceSample<double> sample;
    sample_motion(wanted, plant, plant.contact, view.setup.controller(), now.t, now.p, now.wall, now.in, view.pressed,
                  view.force_phase, sample);
    return sample;
}

Vec3<double> torque_at(const StepView& view, const Instant& now) {
    if (view.held) return *view.held;
    const Plant<double>& plant = view.setup.plant;
    const Vec3<double> q = angles(now.y);
    if (!has_memory(plant)) return torque_without_memory(plant, q, now.p);
    Vec3<double> f_on_tip(0, 0, 0);
    if (plant.has_wall && view.pressed)
        f_on_tip = contact_force(plant.wall, now.wall, plant.contact, now.in, Clamping::clamped).on_tip;
    if (plant.external_force.on) f_on_tip = plus(f_on_tip, external_force_at(plant.external_force, now.t));
    RightHandSide<double, double> rhs(plant);
    rhs.law_function = compiled_law<double, double>();
    rhs.contact = view.contact;
    rhs.force_phase = view.force_phase;
    FullState rates;
    return rhs.torque(now.t, now.wall, now.p, q, arm3r::rates(now.y), f_on_tip, now.y, rates);
}

// Refines one segment between the nodes of its rule. Positions are fractions of the segment.
template <std::size_t n>
class SegmentRefinement {
public:
    SegmentRefinement(const Rule<n>& rule, const Segment<double>& segment, const StepView& view, double a, double b)
        : rule_(rule), segment_(segment), view_(view), a_(a), b_(b) {}

    void refine(const TrackedQuantities& tracked, PerformanceSums<double>& sums) const {
        if (segment_.touching && tracked.overshoot) include_maxima(excess, 0, sums.overshoot);
        if (segment_.touching && tracked.shortfall) refine_shortfall(sums);
        if (tracked.settling) refine_settling(sums);
        if (tracked.path_maximum) include_maxima(path_error, 0, sums.max_path_2);
        if (tracked.limits) refine_saturation(sums);
    }

private:
    // A function of a sample, and the quantities of the sample that it needs.
    struct Quantity {
        double (*value)(const PerformanceSample<double>&);
        TrackedQuantities needed;

        double operator()(const PerformanceSample<double>& sample) const { return value(sample); }
    };
    static constexpr TrackedQuantities force_alone{.force = true}, path_alone{.path = true};
    static constexpr Quantity path_error{[](const auto& sample) { return sample.path_error_2; }, path_alone},
        shortfall{[](const auto& sample) { return force_error_of(sample); }, force_alone},
        excess{[](const auto& sample) { return -force_error_of(sample); }, force_alone},
        band_excess{[](const auto& sample) { return band_excess_of(sample); }, force_alone};

    double theta(double place) const { return a_ + (b_ - a_) * place; }
    auto along(const Quantity& quantity) const {
        return [this, quantity](double place) { return quantity(view_.motion(theta(place), quantity.needed)); };
    }
    double sampled(const Quantity& quantity, std::size_t j) const { return quantity(segment_.samples[j]); }
    SearchPoint point(const Quantity& quantity, std::size_t j) const { return {rule_.node[j], sampled(quantity, j)}; }
    SearchPoint point_at(const Quantity& quantity, double place) const { return {place, along(quantity)(place)}; }

    // The rounding errors of a quantity near node j. They are those of the tip's position, times the stiffness of the wall
    // or, of a squared distance, twice the distance. A broken power has no one stiffness.
    double noise(const Quantity& quantity, std::size_t j) const {
        const Plant<double>& plant = view_.setup.plant;
        const double of_position = 4 * std::numeric_limits<double>::epsilon() * reach(plant.arm);
        if (quantity.needed.path) return of_position * (2 * std::sqrt(sampled(quantity, j)) + of_position);
        return !is_linear(plant.contact.law) ? 0 : of_position * plant.contact.stiffness[0];
    }

    // Around node j.
    Maximum maximum_around(const Quantity& quantity, std::size_t j) const {
        return find_maximum(along(quantity), point(quantity, j - 1), point(quantity, j), point(quantity, j + 1),
                            noise(quantity, j));
    }
    // The same in the part after `from`, which may lie beyond the node.
    Maximum maximum_around(const Quantity& quantity, std::size_t j, double from) const {
        if (from <= rule_.node[j - 1]) return maximum_around(quantity, j);
        const SearchPoint last = point(quantity, j + 1);
        const SearchPoint middle =
            from < rule_.node[j] ? point(quantity, j) : point_at(quantity, 0.5 * (from + last.at));
        return find_maximum(along(quantity), point_at(quantity, from), middle, last, noise(quantity, j));
    }

    // Includes maxima after `from` that exceed the largest value so far.
    void include_maxima(const Quantity& quantity, double from, double& largest) const {
        for (std::size_t j = 1; j + 1 < n; ++j)
            if (rule_.node[j + 1] > from && peak_bound_around(rule_, segment_, quantity, j) > largest)
                largest = std::max(largest, maximum_around(quantity, j, from).value);
    }

    void refine_shortfall(PerformanceSums<double>& sums) const {
        double from = 0;
        if (!(sums.reached > 0)) {
            const std::optional<double> reached = first_time_reached();
            if (!reached) return;
            from = *reached;
            sums.reached = 1;
            for (std::size_t j = 0; j < n; ++j)
                if (rule_.node[j] >= from) sums.max_shortfall = std::max(sums.max_shortfall, sampled(shortfall, j));
        }
        include_maxima(shortfall, from, sums.max_shortfall);
    }

    // The first position at which the force reaches the desired one.
    std::optional<double> first_time_reached() const {
        for (std::size_t j = 0; j < n; ++j) {
            if (sampled(shortfall, j) <= 0)
                return j == 0 ? 0 : find_zero(along(shortfall), point(shortfall, j - 1), point(shortfall, j));
            if (j == 0 || j + 1 == n || peak_bound_around(rule_, segment_, excess, j) < 0) continue;
            const Maximum top = maximum_around(excess, j);
            if (top.value >= 0) return find_zero(along(shortfall), point(shortfall, j - 1), {top.position, -top.value});
        }
        return std::nullopt;
    }

    // The last instant at which the force is outside its band, if it is inside at the end.
    void refine_settling(PerformanceSums<double>& sums) const {
        if (sampled(band_excess, n - 1) > 0) return;
        const auto note = [&](const SearchPoint& from, std::size_t to) {
            const double last = find_zero(along(band_excess), from, point(band_excess, to));
            sums.unsettled_until = segment_.start + segment_.duration * last;
        };
        for (std::size_t j = n - 1; j-- > 0;) {
            if (sampled(band_excess, j) > 0) return note(point(band_excess, j), j + 1);
            if (j == 0 || !(peak_bound_around(rule_, segment_, band_excess, j) > 0)) continue;
            const Maximum top = maximum_around(band_excess, j);
            if (top.value > 0) return note({top.position, top.value}, j + 1);
        }
    }

    // The saturated time of a segment in part of which a torque is at its limit, which add_segment() leaves out.
    void refine_saturation(PerformanceSums<double>& sums) const {
        const auto saturated = [](const PerformanceSample<double>& sample) { return sample.saturated; };
        if (max_of<n>(segment_, saturated) == -max_of<n>(segment_, [](const auto& s) { return -s.saturated; })) return;
        double share = 0;
        for (std::size_t j = 1; j < n; ++j) {
            const double before = segment_.samples[j - 1].saturated, after = segment_.samples[j].saturated;
            const double from = rule_.node[j - 1], to = rule_.node[j];
            const auto is_as_before = [&](double place) {
                return view_(theta(place)).saturated == before ? 1.0 : -1.0;
            };
            const double change = before == after ? to : find_zero(is_as_before, {from, 1}, {to, -1});
            share += before * (change - from) + after * (to - change);
        }
        sums.saturated_time += segment_.duration * share;
    }

    const Rule<n>& rule_;
    const Segment<double>& segment_;
    const StepView& view_;
    const double a_, b_;
};

}  // namespace

PerformanceSample<double> StepView::operator()(double theta) const {
    Vec3<double> power;
    return with_power(theta, power);
}

PerformanceSample<double> StepView::with_power(double theta, Vec3<double>& power) const {
    const Instant now(setup.plant, time(theta), dense(theta), true);
    PerformanceSample<double> sample = motion_at(*this, now, tracked_quantities(setup));
    const Vec3<double> tau = torque_at(*this, now);
    power = cwise_product(tau, rates(now.y));
    sample_saturation(setup.plant.arm, tau, sample);
    return sample;
}

PerformanceSample<double> StepView::motion(double theta, const TrackedQuantities& wanted) const {
    return motion_at(*this, Instant(setup.plant, time(theta), dense.motion(theta), wanted.force), wanted);
}

template <std::size_t n>
void refine_segment(const Rule<n>& rule, const Segment<double>& segment, const StepView& view, double a, double b,
                    PerformanceSums<double>& sums) {
    SegmentRefinement<n>(rule, segment, view, a, b).refine(tracked_quantities(view.setup), sums);
}

template <std::size_t n>
Vec3<double> add_whole_segment(const Rule<n>& rule, bool touching, const StepView& view, double a, double b,
                               PerformanceSums<double>& sums) {
    const DenseOutput& dense = view.dense;
    Segment<double> segment{dense.t0 + a * dense.h, (b - a) * dense.h, touching, {}};
    Vec3<double> mean_power(0, 0, 0), power;
    for (std::size_t j = 0; j < n; ++j) {
        segment.samples[j] = view.with_power(a + (b - a) * rule.node[j], power);
        mean_power = plus(mean_power, scaled(rule.weight[j], power));
    }
    if (add_segment(tracked_quantities(view.setup), rule, true, segment, sums))
        refine_segment(rule, segment, view, a, b, sums);
    if (!view.held) return scaled(segment.duration, mean_power);
    Vec3<double> way;
    for (std::size_t i = 0; i < 3; ++i) way[i] = dense.component(i, b) - dense.component(i, a);
    return cwise_product(*view.held, way);
}

void write_performance(const PerformanceSums<double>& sums, const Setup& setup, Metrics& m) {
    const Controller<double>& controller = setup.controller();
    const double duration = m.t_end - setup.start;
    if (tracks_force(controller.type) && m.contacts > 0) {
        if (sums.touching_time > 0) m.force_error_rms = std::sqrt(sums.force_error_2 / sums.touching_time);
        const bool is_constant = controller.reference.force_profile == ForceProfile::constant;
        m.overshoot = is_constant ? std::max(0.0, m.peak_force - controller.reference.force) : sums.overshoot;
        if (sums.reached > 0) m.force_error_peak = std::max(sums.max_shortfall, m.overshoot);
        if (sums.unsettled_until < m.t_end) m.settling_time = std::max(0.0, sums.unsettled_until - m.first_contact);
    }
    if (tracks_path(controller.type) && duration > 0) {
        m.path_error_rms = std::sqrt(sums.path_2 / duration);
        m.path_error_max = std::sqrt(sums.max_path_2);
    }
    m.saturation_share = duration > 0 ? sums.saturated_time / duration : 0;
    for (std::size_t i = 0; i < 3; ++i) m.work[i] = sums.work[i];
}

#define ARM3R_RULE(n)                                                                                     \
    template void refine_segment(const Rule<n>&, const Segment<double>&, const StepView&, double, double, \
                                 PerformanceSums<double>&);                                               \
    template Vec3<double> add_whole_segment(const Rule<n>&, bool, const StepView&, double, double,        \
                                            PerformanceSums<double>&);
ARM3R_RULE(2)
ARM3R_RULE(3)
ARM3R_RULE(5)
ARM3R_RULE(7)

}  // namespace arm3r
