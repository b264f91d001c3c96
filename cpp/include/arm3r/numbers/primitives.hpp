// The operations on double that the generic formulas use; Pack, Dual and Expr offer the same under the same names.
#pragma once

#include <cstdint>
#include <limits>

// Wide registers must never cross a function call: a callee built for an older CPU would pass them differently.
#ifndef ARM3R_INLINE  // A build without wide packs may define it as `inline`.
#define ARM3R_INLINE [[gnu::always_inline]] inline
#endif
#ifndef ARM3R_INLINE_LAMBDA  // And a file without them this as nothing.
#define ARM3R_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace arm3r {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

template <class T>
struct SinCos {
    T sin, cos;
};

// x with its bits, seen as a 64-bit integer, changed by f; for a Pack, in all lanes at once.
template <class F>
ARM3R_INLINE double with_bits(double x, F f) {
    auto i = __builtin_bit_cast(std::int64_t, x);
    f(i);
    return __builtin_bit_cast(double, i);
}

ARM3R_INLINE bool any(bool mask) { return mask; }
ARM3R_INLINE bool all(bool mask) { return mask; }
ARM3R_INLINE double select(bool mask, double a, double b) { return mask ? a : b; }

ARM3R_INLINE double sqrt(double x) { return __builtin_sqrt(x); }
ARM3R_INLINE double abs(double x) { return __builtin_fabs(x); }
ARM3R_INLINE double min(double a, double b) { return b < a ? b : a; }
ARM3R_INLINE double max(double a, double b) { return a < b ? b : a; }
ARM3R_INLINE double copysign(double magnitude, double sign) { return __builtin_copysign(magnitude, sign); }

// Runs a long f that is used in many places: in a function of its own for heavy number types (Dual), inlined for
// double, and for packs, which must not cross a call.
template <class T>
inline constexpr bool is_heavy = false;
template <class T, class F>
[[gnu::noinline]] auto call(const F& f) {
    return f();
}
template <class T, class F>
ARM3R_INLINE auto shared(const F& f) {
    if constexpr (is_heavy<T>) return call<T>(f);
    else return f();
}

// The number without its derivatives.
ARM3R_INLINE double value(double x) { return x; }

// A number whose bits can be reached: double and Pack. The elementary functions are written for these.
template <class T>
concept Lanewise = requires(T x) { with_bits(x, [](auto&) {}); };

}  // namespace arm3r
