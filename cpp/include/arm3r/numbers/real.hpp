// The numbers that every formula is written for: double, and whatever offers the same functions (Pack, Dual, Expr).
#pragma once

#include "arm3r/numbers/elementary.hpp"

namespace arm3r {

template <class T>
concept Real = requires(const T a, const T b, const SinCos<T> s) {
    T(1.5);
    T((a + b) * (a - b) / -b);
    T(2.0 * a + 1.0);
    { any(a < b) };
    { all(a <= b) };
    T(select(a > b, a, b));
    T(sqrt(abs(min(a, max(a, b)))));
    T(copysign(a, b));
    SinCos<T>(sincos(a));
    SinCos<T>(sincos_near(a, s, b));
    T(tanh(atan2(a, acos(b))));
    T(hypot2(a, b));
    T(exp(log(power(a, b))));
};

static_assert(Real<double>);

// The greater of both where `mask`, else x: not select(mask, max(x, y), x) (README, g++ 3).
template <class M, class T>
ARM3R_INLINE T max_where(const M& mask, const T& x, const T& y) {
    return max(x, T(select(mask, y, x)));
}

}  // namespace arm3r
