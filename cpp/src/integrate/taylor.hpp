#pragma once
// The motion as a Taylor series in the time since an instant; docs/model.md (5.5). Its recurrences are derived from the
// recorded formulas when arm3r is built (derive_taylor.cpp).

#include <limits>

#include "arm3r/numbers/approximate_root.hpp"
#include "arm3r/numbers/pack.hpp"
#include "arm3r/numbers/polynomial.hpp"
#include "integrate/taylor_recipes.hpp"

namespace arm3r {

// Quantity j is the sum of c[i][j] h^i, i = 0..order, at h seconds after the instant: q, qd and the quadratures, then
// depth, across1, across2 if there is a wall, else zero; then the work of each torque since the instant.
template <class T>
struct Expansion {
    int order;
    alignas(64) T c[max_degree + 1][quantities];
};

enum class Kernel : std::size_t {};  // a place in the list of recipes

// The kernel for a plant. `pressed`: the wall's force acts. With a stiffness of zero its motion is that without a
// force.
Kernel kernel_of(const Plant<double>& plant, bool pressed);

// The series about the state y at t, whose pose is p. 1 <= order <= max_degree. The plant has no more than the kernel; a
// control of type none has torque zero. T: double, or Pack<2>, Pack<4>, Pack<8> up to max_lanes().
template <class T>
void expand(Kernel kernel, const Plant<T>& plant, const T& t, const State<T, state_size>& y, const Pose<T>& p,
            int order, Expansion<T>& expansion);

// The order that costs least for a tolerance of each step, 2 to max_degree.
int order_of(double tol);

// 1/x for a power of two, between 1/x and 2/x elsewhere.
template <class T>
ARM3R_INLINE T inverse_power(const T& x) {
    return with_bits(
        x, [](auto& i) ARM3R_INLINE_LAMBDA { i = (std::int64_t{2046} << 52) - (i & (std::int64_t{2047} << 52)); });
}

// The step for which the last two orders are within the tolerance, s: infinite if they are zero. tol is relative where
// a quantity of the state exceeds 1, else absolute, and absolute for the signals.
template <class T>
ARM3R_INLINE T step_of(const Expansion<T>& e, const T& tol) {
    T before(0.0), last(0.0);
    for (std::size_t j = 0; j < works_at; ++j) {
        const T scale = j < state_size ? inverse_power(max(T(1.0), abs(e.c[0][j]))) : T(1.0);
        before = max(before, T(abs(e.c[e.order - 1][j]) * scale));
        last = max(last, T(abs(e.c[e.order][j]) * scale));
    }
    const T unbounded(infinite);
    const auto trusted = [&](const T& size, int k) ARM3R_INLINE_LAMBDA {
        return select(size > T(0.0), approximate_root(T(tol / size), k), unbounded);
    };
    return min(trusted(last, e.order), e.order > 1 ? trusted(before, e.order - 1) : unbounded);
}

// Whether all coefficients that a step depends on are finite.
template <class T>
ARM3R_INLINE auto is_finite(const Expansion<T>& e) {
    T zero(0.0);
    for (std::size_t j = 0; j < works_at; ++j) zero = zero + e.c[e.order][j] * 0.0;
    return zero == T(0.0);
}

// value() of each quantity of the state, all at once: their sums stay in registers.
template <class T>
ARM3R_INLINE State<T, state_size> state_after(const Expansion<T>& e, const T& h) {
    State<T, state_size> sum;
    for (std::size_t j = 0; j < state_size; ++j) sum[j] = e.c[e.order][j];
    for (int i = e.order - 1; i >= 0; --i)
        for (std::size_t j = 0; j < state_size; ++j) sum[j] = sum[j] * h + e.c[i][j];
    return sum;
}

template <class T>
ARM3R_INLINE T value(const Expansion<T>& e, std::size_t quantity, const T& h) {
    T sum = e.c[e.order][quantity];
    for (int i = e.order - 1; i >= 0; --i) sum = sum * h + e.c[i][quantity];
    return sum;
}

}  // namespace arm3r
