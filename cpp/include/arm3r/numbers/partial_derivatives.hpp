// The results of the functions that formulas use, with their partial derivatives: what Dual and ForwardSweep have in common.
#pragma once

#include "arm3r/numbers/real.hpp"

namespace arm3r {

// f(a) and df/da.
template <class T>
struct OfOne {
    T result, by_a;
};
// f(a, b), df/da and df/db.
template <class T>
struct OfTwo {
    T result, by_a, by_b;
};

template <class T>
ARM3R_INLINE OfTwo<T> divide_and_slopes(const T& a, const T& b) {
    const T quotient = a / b;
    return {quotient, 1.0 / b, -quotient / b};
}
template <class T>
ARM3R_INLINE OfOne<T> copysign_and_slopes(const T& magnitude, const T& sign) {
    const T one(1.0);
    return {copysign(magnitude, sign), copysign(one, magnitude) * copysign(one, sign)};
}
// If the derivative is infinite or undefined, it is set to 0: this happens at a clamped argument only, which does not
// move.
template <class T>
ARM3R_INLINE OfOne<T> sqrt_and_slopes(const T& x) {
    const T root = sqrt(x);
    return {root, select(root > T(0.0), T(0.5 / root), T(0.0))};
}
template <class T>
ARM3R_INLINE OfOne<T> tanh_and_slopes(const T& x) {
    const T result = tanh(x);
    return {result, (1.0 - result) * (1.0 + result)};
}
template <class T>
ARM3R_INLINE OfTwo<T> atan2_and_slopes(const T& y, const T& x) {
    const T square = x * x + y * y, zero(0.0);
    const auto turns = square > zero;
    return {atan2(y, x), select(turns, T(x / square), zero), select(turns, T(-y / square), zero)};
}
template <class T>
ARM3R_INLINE OfOne<T> fifth_root_and_slopes(const T& x) {
    const T root = fifth_root(x);
    return {root, root / (5.0 * x)};
}
template <class T>
ARM3R_INLINE OfOne<T> exp_and_slopes(const T& x) {
    const T result = exp(x);
    return {result, result};
}
template <class T>
ARM3R_INLINE OfOne<T> log_and_slopes(const T& x) {
    return {log(x), 1.0 / x};
}
// For p >= 1 the derivatives are finite down to x = 0, where they are those of x > 0.
template <class T>
ARM3R_INLINE OfTwo<T> power_and_slopes(const T& x, const T& p) {
    const T result = power(x, p), zero(0.0), one(1.0);
    const T of_less = select(p == one, one, power(x, T(p - 1.0)));
    return {result, select(x < zero, zero, T(p * of_less)), select(result > zero, T(result * log(x)), zero)};
}

}  // namespace arm3r
