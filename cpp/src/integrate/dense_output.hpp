#pragma once
// The state of a run, and the solution within a step; docs/model.md, section 5.

#include <algorithm>
#include <array>
#include <cmath>

#include "arm3r/numbers/polynomial.hpp"
#include "arm3r/plant.hpp"

namespace arm3r {

inline constexpr double min_rate = 1e-140;  // rad/s

// A smaller rate is set to 0: its products would be subnormal, and slow.
template <class T>
ARM3R_INLINE T without_tiny_rate(const T& rate) {
    return select(abs(rate) < T(min_rate), T(0.0), rate);
}

// The state with room for a controller's memory, whether there is one or not.
using FullState = State<double, full_size>;

// The dense output of a step, for any method: an interpolant, or a power series in the seconds since its start.
struct DenseOutput {
    double t0 = 0, h = 0;
    int order = -1;                 // of the series; < 0: an interpolant
    std::size_t size = state_size;  // components in use
    std::array<FullState, max_degree + 1> c;

    template <std::size_t N>
    void assign(const Interpolant<double, N>& from) {
        t0 = from.t0;
        h = from.h;
        order = -1;
        size = N;
        for (std::size_t i = 0; i < from.c.size(); ++i) std::copy(from.c[i].begin(), from.c[i].end(), c[i].begin());
    }

    bool is_series() const { return order >= 0; }

    // One component at theta in [0, 1] of the step: at one instant or at several in one pack.
    template <class S>
    ARM3R_INLINE S component(std::size_t i, const S& theta) const {
        return is_series() ? summed(i, S(theta * h)) : interpolated(c, i, theta);
    }

    // A bound of what a component changes by within the step.
    double most_change(std::size_t i) const {
        double sum = 0, power = 1;
        for (int k = 1; k <= (is_series() ? order : 4); ++k) sum += std::abs(c[k][i]) * (is_series() ? power *= h : 1);
        return (1 + 1e-9) * sum;  // with its rounding errors
    }

    FullState operator()(double theta) const { return first(size, theta); }
    // Angles and rates; the other components are 0.
    FullState motion(double theta) const { return first(motion_size, theta); }

private:
    FullState first(std::size_t count, double theta) const {
        FullState y{};
        for (std::size_t i = 0; i < count; ++i) y[i] = component(i, theta);
        return y;
    }
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
