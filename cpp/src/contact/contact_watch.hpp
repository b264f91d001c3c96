#pragma once
// The contact within a step, in every lane: the tip along the dense output, the impulse of its force, and whether the
// contact may change; a lane in which it may is searched alone (contact_search.hpp); docs/model.md (4.8), (5.3).

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/plant.hpp"

namespace arm3r {

inline constexpr int samples_per_step = 9;  // of the depth, ends included

// The tip at theta of a step.
template <class P, class Dense, class T>
ARM3R_INLINE Indentation<T> indentation_at(const Plant<P>& plant, const Dense& dense, const T& theta) {
    const auto y = [&](std::size_t i) ARM3R_INLINE_LAMBDA { return dense.component(i, theta); };
    const Pose<T> p = pose(Vec3<T>(y(0), y(1), y(2)));
    const WallState<T> wall = wall_at(plant.wall, T(dense.t0 + theta * dense.h));
    return tip_indentation(plant, wall, p, Vec3<T>(y(3), y(4), y(5)));
}

// The integral of the normal contact force from theta = a to b, N s: Gauss and Legendre, five points.
template <class P, class Dense, class T>
ARM3R_INLINE T impulse_by_gauss(const Plant<P>& plant, const Contact<P>& law, const Dense& dense, const T& a,
                                const T& b) {
    constexpr double place[] = {0, 0.53846931010568309, 0.90617984593866399};
    constexpr double weight[] = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
    T force[5];
#pragma GCC unroll 1
    for (int i = 0; i < 5; ++i) {
        const double x = i < 3 ? place[i] : -place[i - 2];
        force[i] = normal_force(law, indentation_at(plant, dense, T(0.5 * ((a + b) + (b - a) * x))));
    }
    T sum = weight[0] * force[0];
    for (int i = 1; i < 3; ++i) sum = sum + weight[i] * (force[i + 2] + force[i]);
    return 0.5 * (b - a) * dense.h * sum;
}

// Where the tangents of a signal at both ends of an interval meet: beyond a maximum or minimum that lies between them. The
// rates have opposite signs.
template <class T>
ARM3R_INLINE T tangents_meet(const T& a, const T& rate_a, const T& b, const T& rate_b, const T& duration) {
    return a + rate_a * (((b - a) - rate_b * duration) / (rate_a - rate_b));
}

// Of the signals that a contact mode watches: whether one may cross zero between two samples, or the force have a maximum.
template <class T>
class ContactWatch {
public:
    using Mask = typename Lanes<T>::Mask;

    // touching: whose force is looked at; `held`: where contact ends when the depth falls to zero; duration: s, between
    // samples.
    ARM3R_INLINE ContactWatch(const Wall<T>& wall, const Mask& free, const Mask& touching, const Mask& held,
                              const T& duration)
        : wall_(wall), free_(free), touching_(touching), held_(held), duration_(duration) {}

    // `most`: the depth, m, of the largest force so far.
    ARM3R_INLINE Mask may_change(const Indentation<T>& a, const Indentation<T>& b, const T& most) const {
        const T o(0.0), turns_at = tangents_meet(a.depth, a.rate, b.depth, b.rate, duration_);
        const Mask rises_and_falls = a.rate > o && b.rate < o, falls_and_rises = a.rate < o && b.rate > o;
        const Mask may = (free_ && (b.depth > o || (rises_and_falls && turns_at > o))) ||
                         (held_ && (b.depth <= o || (falls_and_rises && turns_at <= o))) ||
                         (touching_ && rises_and_falls && turns_at >= most);
        if (!wall_.has_outline) return may;
        const auto may_leave = [&](const T& half, const T& across_a, const T& slip_a, const T& across_b,
                                   const T& slip_b) ARM3R_INLINE_LAMBDA {
            const Mask turns = (slip_a > o && slip_b < o) || (slip_a < o && slip_b > o);
            return half - abs(across_b) < o ||
                   (turns && half - abs(tangents_meet(across_a, slip_a, across_b, slip_b, duration_)) < o);
        };
        return may || (touching_ && (may_leave(wall_.half1, a.across1, a.slip1, b.across1, b.slip1) ||
                                     may_leave(wall_.half2, a.across2, a.slip2, b.across2, b.slip2)));
    }

private:
    const Wall<T>& wall_;
    const Mask free_, touching_, held_;
    const T duration_;
};

}  // namespace arm3r
