#pragma once
// The state of a run, and the solution within a step; docs/model.md, section 5.

#include <algorithm>
#include <array>

#include "arm3r/numbers/polynomial.hpp"
#include "arm3r/plant.hpp"

namespace arm3r {

inline constexpr double smallest_rate = 1e-140;  // rad/s: below it products would be subnormal, and slow

// With room for a controller's memory, whether there is one or not.
using FullState = State<double, full_size>;

// The solution within a step, for any method: an interpolant, or a power series in the seconds since its begin.
struct Inside {
    double t0 = 0, h = 0;
    int order = -1;                 // of the series; < 0: an interpolant
    std::size_t size = state_size;  // components that there are
    std::array<FullState, most_degree + 1> c;

    template <std::size_t N>
    void take(const Interpolant<double, N>& from) {
        t0 = from.t0;
        h = from.h;
        order = -1;
        size = N;
        for (std::size_t i = 0; i < from.c.size(); ++i) std::copy(from.c[i].begin(), from.c[i].end(), c[i].begin());
    }

    // One component at theta, the share of the step: at one instant or at several side by side.
    template <class S>
    ARM3R_INLINE S component(std::size_t i, const S& theta) const {
        return order < 0 ? interpolated(c, i, theta) : summed(i, S(theta * h));
    }

    FullState operator()(double theta) const {
        FullState y{};
        for (std::size_t i = 0; i < size; ++i) y[i] = component(i, theta);
        return y;
    }

private:
    template <class S>
    ARM3R_INLINE S summed(std::size_t i, const S& seconds) const {
        S sum(c[order][i]);
        for (int k = order - 1; k >= 0; --k) sum = sum * seconds + c[k][i];
        return sum;
    }
};

inline Vec3<double> angles(const FullState& y) { return {y[0], y[1], y[2]}; }
inline Vec3<double> rates(const FullState& y) { return {y[3], y[4], y[5]}; }

}  // namespace arm3r
