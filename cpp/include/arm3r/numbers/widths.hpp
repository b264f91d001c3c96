// Everything about the widths of vector registers: which functions are compiled for which instructions, and which packs
// a build has.
#pragma once

#include "arm3r/numbers/lane_access.hpp"

// ARM3R_WIDEST: a function of packs that is compiled for several instruction sets; the widest one of the CPU is chosen
// at run time, and all give the same bits. All functions that it calls are inlined. Functions with ARM3R_FOR_FOUR and
// ARM3R_FOR_EIGHT may be called only if the processor has registers for packs of 4 or 8 (max_lanes); without such
// variants (ARM3R_WIDE_PACKS 0) packs have 2 lanes.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) && !defined(ARM3R_NARROW)
#define ARM3R_WIDEST __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#define ARM3R_WIDEST_SCALARS __attribute__((target_clones("default", "arch=x86-64-v3")))
#define ARM3R_FOR_FOUR __attribute__((target("arch=x86-64-v3")))
#define ARM3R_FOR_EIGHT __attribute__((target("arch=x86-64-v4")))
#define ARM3R_WIDE_PACKS 1
#else
#define ARM3R_WIDEST
#define ARM3R_WIDEST_SCALARS
#define ARM3R_FOR_FOUR
#define ARM3R_FOR_EIGHT
#define ARM3R_WIDE_PACKS 0
#endif
#ifndef ARM3R_ONE_LANE
#define ARM3R_ONE_LANE 0  // 1: a batch has no packs, to compile faster while developing
#endif

// X(T) for each pack of this build, and for each T that a lane run may have.
#if ARM3R_WIDE_PACKS
#define ARM3R_PACKS(X) X(arm3r::Pack<2>) X(arm3r::Pack<4>) X(arm3r::Pack<8>)
#else
#define ARM3R_PACKS(X) X(arm3r::Pack<2>)
#endif
#if ARM3R_ONE_LANE
#define ARM3R_LANE_TYPES(X) X(double)
#else
#define ARM3R_LANE_TYPES(X) X(double) ARM3R_PACKS(X)
#endif

namespace arm3r {

// The same as lists of types; a row block has at most four lanes, because eight take twice as long: more numbers than
// registers.
template <class... T>
struct TypeList {};
#if ARM3R_WIDE_PACKS
using RowTypes = TypeList<Pack<2>, Pack<4>>;
#else
using RowTypes = TypeList<Pack<2>>;
#endif
#if ARM3R_ONE_LANE
using LaneTypes = TypeList<double>;
#elif ARM3R_WIDE_PACKS
using LaneTypes = TypeList<double, Pack<2>, Pack<4>, Pack<8>>;
#else
using LaneTypes = TypeList<double, Pack<2>>;
#endif

// The number of lanes in the widest registers of this processor.
inline int max_lanes() {
#if ARM3R_ONE_LANE
    return 1;
#elif ARM3R_WIDE_PACKS
    if (__builtin_cpu_supports("x86-64-v4")) return 8;
    if (__builtin_cpu_supports("x86-64-v3")) return 4;
#endif
    return 2;
}

// Functions that are not inlined and that are compiled for the registers that hold T. run(f) calls f, so that rare code
// does not spill registers in a hot loop; call<F> is the function of a class without data, for a function pointer.
template <class T>
struct Outlined {
    template <class F>
    [[gnu::noinline]] static void run(F f) {
        f();
    }
    template <class F, class... A>
    [[gnu::noinline]] static void call(A... arguments) {
        F{}(arguments...);
    }
};

template <>
struct Outlined<Pack<4>> {
    template <class F>
    [[gnu::noinline]] ARM3R_FOR_FOUR static void run(F f) {
        f();
    }
    template <class F, class... A>
    [[gnu::noinline]] ARM3R_FOR_FOUR static void call(A... arguments) {
        F{}(arguments...);
    }
};

template <>
struct Outlined<Pack<8>> {
    template <class F>
    [[gnu::noinline]] ARM3R_FOR_EIGHT static void run(F f) {
        f();
    }
    template <class F, class... A>
    [[gnu::noinline]] ARM3R_FOR_EIGHT static void call(A... arguments) {
        F{}(arguments...);
    }
};

// Calls f<T>() with the type of `lanes` lanes, compiled for its registers.
template <class... T, class F>
void run_at_width(TypeList<T...>, int lanes, F f) {
    const auto run = [&]<class One>() {
        if (Lanes<One>::count == lanes) Outlined<One>::run([&]() ARM3R_INLINE_LAMBDA { f.template operator()<One>(); });
    };
    (run.template operator()<T>(), ...);
}

// A right-hand side as a function call, so that the stages of a step do not each contain a copy of it.
template <class T, class F>
struct OutlinedFunction {
    const F& f;
    template <class Y>
    ARM3R_INLINE void operator()(const T& t, const Y& y, Y& dy) const {
        Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { f(t, y, dy); });
    }
};
template <class T, class F>
ARM3R_INLINE OutlinedFunction<T, F> outlined(const F& f) {
    return {f};
}

}  // namespace arm3r
