#include "run/performance.hpp"

#include <algorithm>
#include <cmath>

#include "arm3r/numbers/eigen_traits.hpp"
#include "control/compiled_laws.hpp"

namespace arm3r {
namespace {

Vec3<double> torque_at(const StepView& view, double t, const FullState& y, const Pose<double>& p,
                       const WallState<double>& wall, const Vec3<double>& f_on_tip) {
    if (view.held) return *view.held;
    const Plant<double>& plant = view.setup.plant;
    const Vec3<double> q = angles(y);
    if (!has_memory(plant)) return limited(plant.arm, control(plant.controller, q, p), plant.controller.saturation);
    RightHandSide<double, double> rhs(plant);
    rhs.law_function = compiled_law<double, double>();
    rhs.contact = view.contact;
    rhs.force_phase = view.force_phase;
    FullState rates;
    return rhs.torque(t, wall, p, q, arm3r::rates(y), f_on_tip, y, rates);
}

// Where f is largest between a and b, which it rises from and falls to: by golden sections.
template <class F>
Maximum summit(F f, double a, double b) {
    constexpr double golden = 0.6180339887498949;
    constexpr int cuts = 48;
    double x = b - golden * (b - a), y = a + golden * (b - a), at_x = f(x), at_y = f(y);
    for (int i = 0; i < cuts; ++i) {
        if (at_x < at_y) {
            a = x, x = y, at_x = at_y, y = a + golden * (b - a), at_y = f(y);
        } else {
            b = y, y = x, at_y = at_x, x = b - golden * (b - a), at_x = f(x);
        }
    }
    return at_x < at_y ? Maximum{y, at_y} : Maximum{x, at_x};
}

// Where f comes down to zero, above which it is at a and not at b.
template <class F>
double descent(F f, double a, double b) {
    constexpr int halvings = 50;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (a + b);
        (f(middle) > 0 ? a : b) = middle;
    }
    return b;
}

// One passage, at the places of its rule and between them; places are shares of the passage.
template <std::size_t n>
class CloserLook {
public:
    CloserLook(const Rule<n>& rule, const Passage<double>& passage, const StepView& view, double a, double b)
        : rule_(rule), passage_(passage), view_(view), a_(a), b_(b) {}

    void judge(const Looks& looks, Tally<double>& tally) const {
        if (looks.force) {
            if (passage_.touching) judge_force(tally);
            judge_rest(tally);
        }
        if (looks.path) include_summits(&path_error_2_of, 0, tally.largest_path_2);
        if (looks.limits) judge_limits(tally);
    }

private:
    using Quantity = double (*)(const Sight<double>&);

    static double path_error_2_of(const Sight<double>& sight) { return sight.path_error_2; }
    static double shortfall_of(const Sight<double>& sight) { return miss_of(sight); }
    static double excess_of(const Sight<double>& sight) { return -miss_of(sight); }
    static double unrest(const Sight<double>& sight) { return unrest_of(sight); }

    Sight<double> at(double place) const { return view_(a_ + (b_ - a_) * place); }
    auto along(Quantity quantity) const {
        return [this, quantity](double place) { return quantity(at(place)); };
    }
    double known(Quantity quantity, std::size_t j) const { return quantity(passage_.sights[j]); }

    // Summits after `from` that exceed the largest value so far.
    void include_summits(Quantity quantity, double from, double& largest) const {
        for (std::size_t j = 1; j + 1 < n; ++j)
            if (rule_.place[j + 1] > from && top_around(rule_, passage_, quantity, j) > largest)
                largest = std::max(
                    largest, summit(along(quantity), std::max(from, rule_.place[j - 1]), rule_.place[j + 1]).value);
    }

    void judge_force(Tally<double>& tally) const {
        include_summits(&excess_of, 0, tally.overshoot);
        double from = 0;
        if (!(tally.reached > 0)) {
            const std::optional<double> reached = first_reach();
            if (!reached) return;
            from = *reached;
            tally.reached = 1;
            for (std::size_t j = 0; j < n; ++j)
                if (rule_.place[j] >= from)
                    tally.largest_miss = std::max(tally.largest_miss, std::abs(known(&shortfall_of, j)));
        }
        include_summits(&shortfall_of, from, tally.largest_miss);
        include_summits(&excess_of, from, tally.largest_miss);
    }

    // Where the force first is what is wanted.
    std::optional<double> first_reach() const {
        for (std::size_t j = 0; j < n; ++j) {
            if (known(&shortfall_of, j) <= 0)
                return j == 0 ? 0 : descent(along(&shortfall_of), rule_.place[j - 1], rule_.place[j]);
            if (j == 0 || j + 1 == n || top_around(rule_, passage_, &excess_of, j) < 0) continue;
            const Maximum top = summit(along(&excess_of), rule_.place[j - 1], rule_.place[j + 1]);
            if (top.value >= 0) return descent(along(&shortfall_of), rule_.place[j - 1], top.place);
        }
        return std::nullopt;
    }

    // Until when the force is outside its band, if it is inside at the end.
    void judge_rest(Tally<double>& tally) const {
        if (known(&unrest, n - 1) > 0) return;
        const auto note = [&](double from, double to) {
            tally.unsettled_until = passage_.start + passage_.duration * descent(along(&unrest), from, to);
        };
        for (std::size_t j = n - 1; j-- > 0;) {
            if (known(&unrest, j) > 0) return note(rule_.place[j], rule_.place[j + 1]);
            if (j == 0 || !(top_around(rule_, passage_, &unrest, j) > 0)) continue;
            const Maximum top = summit(along(&unrest), rule_.place[j - 1], rule_.place[j + 1]);
            if (top.value > 0) return note(top.place, rule_.place[j + 1]);
        }
    }

    // What add_passage() leaves out: a passage in part of which a torque is at its limit.
    void judge_limits(Tally<double>& tally) const {
        const auto saturated = [](const Sight<double>& sight) { return sight.saturated; };
        if (highest_of<n>(passage_, saturated) == -highest_of<n>(passage_, [](const auto& s) { return -s.saturated; }))
            return;
        double share = 0;
        for (std::size_t j = 1; j < n; ++j) {
            const double before = passage_.sights[j - 1].saturated, after = passage_.sights[j].saturated;
            const double from = rule_.place[j - 1], to = rule_.place[j];
            const auto is_as_before = [&](double place) { return at(place).saturated == before ? 1.0 : -1.0; };
            const double change = before == after ? to : descent(is_as_before, from, to);
            share += before * (change - from) + after * (to - change);
        }
        tally.saturated_time += passage_.duration * share;
    }

    const Rule<n>& rule_;
    const Passage<double>& passage_;
    const StepView& view_;
    const double a_, b_;
};

}  // namespace

Sight<double> StepView::operator()(double theta) const {
    const Plant<double>& plant = setup.plant;
    const double t = std::min(inside.t0 + theta * inside.h, latest);
    const FullState y = inside(theta);
    const Pose<double> p = pose(angles(y));
    WallState<double> wall = no_wall<double>();
    Indentation<double> in{};
    Vec3<double> f_on_tip(0, 0, 0);
    if (plant.has_wall) {
        wall = wall_at(plant.wall, t);
        in = tip_indentation(plant, wall, p, rates(y));
        if (pressed) f_on_tip = contact_force(plant.wall, wall, plant.contact, in, Grip::clipped).on_tip;
    }
    if (plant.load.on) f_on_tip = plus(f_on_tip, load_at(plant.load, t));
    Sight<double> sight;
    see_motion(Looks(setup), plant, plant.contact, setup.law(), t, p, wall, in, pressed, force_phase, sight);
    see_torque(plant.arm, torque_at(*this, t, y, p, wall, f_on_tip), rates(y), sight);
    return sight;
}

template <std::size_t n>
void look_closer(const Rule<n>& rule, const Passage<double>& passage, const StepView& view, double a, double b,
                 Tally<double>& tally) {
    CloserLook<n>(rule, passage, view, a, b).judge(Looks(view.setup), tally);
}

template <std::size_t n>
void add_alone(const Rule<n>& rule, bool touching, const StepView& view, double a, double b, Tally<double>& tally) {
    const Inside& inside = view.inside;
    Passage<double> passage{inside.t0 + a * inside.h, (b - a) * inside.h, touching, {}, {}};
    for (std::size_t j = 0; j < n; ++j) passage.sights[j] = view(a + (b - a) * rule.place[j]);
    for (std::size_t i = 0; i < 3; ++i)
        passage.work[i] =
            view.held ? (*view.held)[i] * (inside.component(i, b) - inside.component(i, a))
                      : passage.duration * mean_of(rule, passage, [i](const Sight<double>& s) { return s.power[i]; });
    if (add_passage(Looks(view.setup), rule, true, passage, tally)) look_closer(rule, passage, view, a, b, tally);
}

void tell_score(const Tally<double>& tally, const Setup& setup, Metrics& m) {
    const Controller<double>& controller = setup.law();
    const double duration = m.t_end - setup.start;
    if (wants_force(controller.type) && m.contacts > 0) {
        if (tally.touching_time > 0) m.force_error_rms = std::sqrt(tally.miss_2 / tally.touching_time);
        const bool is_constant = controller.setpoint.pressing == Pressing::constant;
        m.overshoot = is_constant ? std::max(0.0, m.peak_force - controller.setpoint.force) : tally.overshoot;
        if (tally.reached > 0) m.force_error_peak = std::max(tally.largest_miss, m.overshoot);
        if (tally.unsettled_until < m.t_end) m.settling_time = std::max(0.0, tally.unsettled_until - m.first_contact);
    }
    if (wants_path(controller.type) && duration > 0) {
        m.path_error_rms = std::sqrt(tally.path_2 / duration);
        m.path_error_max = std::sqrt(tally.largest_path_2);
    }
    m.saturation_share = duration > 0 ? tally.saturated_time / duration : 0;
    for (std::size_t i = 0; i < 3; ++i) m.work[i] = tally.work[i];
}

#define ARM3R_RULE(n)                                                                                  \
    template void look_closer(const Rule<n>&, const Passage<double>&, const StepView&, double, double, \
                              Tally<double>&);                                                         \
    template void add_alone(const Rule<n>&, bool, const StepView&, double, double, Tally<double>&);
ARM3R_RULE(2)
ARM3R_RULE(3)
ARM3R_RULE(5)
ARM3R_RULE(7)

}  // namespace arm3r
