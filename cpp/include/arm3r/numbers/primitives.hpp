// What a double offers to the generic formulas; Pack, Dual and Expr offer the same under the same names.
#pragma once

#include <cstdint>

// Wide registers must never cross a function call: a callee built for an older CPU would pass them differently.
#ifndef ARM3R_INLINE  // A build without wide packs may define it as `inline`, and ARM3R_INLINE_LAMBDA as nothing.
#define ARM3R_INLINE [[gnu::always_inline]] inline
#define ARM3R_INLINE_LAMBDA __attribute__((always_inline))
#endif
// A function of packs built for several instruction sets; the widest that the CPU has is taken, all with the same bits.
// All that it calls is inlined into it. ARM3R_FOR_FOUR and ARM3R_FOR_EIGHT: called only where the processor has registers
// for packs of 4 or 8 (widest_lanes); where nothing is built for these (ARM3R_WIDE_PACKS 0), packs have 2 lanes.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) && !defined(ARM3R_NARROW)
#define ARM3R_WIDEST __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#define ARM3R_WIDEST_SCALARS __attribute__((target_clones("default", "arch=x86-64-v3")))
#define ARM3R_FOR_FOUR __attribute__((target("arch=x86-64-v3")))
#define ARM3R_FOR_EIGHT __attribute__((target("arch=x86-64-v4")))
#define ARM3R_WIDE_PACKS 1
#else
#define ARM3R_WIDEST
#define ARM3R_WIDEST_SCALARS
#define ARM3R_WIDE_PACKS 0
#endif
#ifndef ARM3R_ONE_LANE
#define ARM3R_ONE_LANE 0  // 1: a batch has no packs, to compile faster while developing
#endif

namespace arm3r {

// How many lanes the registers of this processor hold.
inline int widest_lanes() {
#if ARM3R_ONE_LANE
    return 1;
#elif ARM3R_WIDE_PACKS
    if (__builtin_cpu_supports("x86-64-v4")) return 8;
    if (__builtin_cpu_supports("x86-64-v3")) return 4;
#endif
    return 2;
}

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

// What is long, and asked for in many places: a function of its own, but for numbers that live in wide registers, which
// must not cross a call, and for plain ones.
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
