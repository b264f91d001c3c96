// Everything about the widths of vector registers: which functions are compiled for which instructions, and which packs
// a build has.
#pragma once

#include <algorithm>

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/numbers/registers.hpp"

// Functions with ARM3R_FOR_FOUR and ARM3R_FOR_EIGHT may be called only if the processor has registers for packs of 4 or 8
// (has_registers_for); all functions that they call are inlined. Without such variants (ARM3R_WIDE_PACKS 0) packs have 2
// lanes. ARM3R_HAS_FOUR and ARM3R_HAS_EIGHT: whether this build has them.
//
// ARM3R_LANES, where it is defined: the only width of packs that a batch has in this build (1: no packs), which compiles
// faster. Otherwise a build has packs of 2, 4 and 8.
#if defined(__x86_64__) && defined(__GNUC__) && defined(__OPTIMIZE__) && !(defined(ARM3R_LANES) && ARM3R_LANES <= 2)
#if defined(__clang__)  // by their names, because options of the command line win over an architecture
#define ARM3R_FOR_FOUR __attribute__((target("avx2,bmi,bmi2,fma")))
#define ARM3R_FOR_EIGHT __attribute__((target("avx512f,avx512bw,avx512cd,avx512dq,avx512vl,bmi,bmi2,fma")))
#else
#define ARM3R_FOR_FOUR __attribute__((target("arch=x86-64-v3")))
#define ARM3R_FOR_EIGHT __attribute__((target("arch=x86-64-v4")))
#endif
#define ARM3R_WIDE_PACKS 1
#else
#define ARM3R_FOR_FOUR
#define ARM3R_FOR_EIGHT
#define ARM3R_WIDE_PACKS 0
#endif
#if ARM3R_WIDE_PACKS && !(defined(ARM3R_LANES) && ARM3R_LANES == 8)
#define ARM3R_HAS_FOUR 1
#else
#define ARM3R_HAS_FOUR 0
#endif
#if ARM3R_WIDE_PACKS && !(defined(ARM3R_LANES) && ARM3R_LANES == 4)
#define ARM3R_HAS_EIGHT 1
#else
#define ARM3R_HAS_EIGHT 0
#endif

// X(T) for each pack of the lanes of a batch; of a row block, which has at most four lanes, because eight take twice as
// long: more numbers than registers; and of both.
#if !ARM3R_WIDE_PACKS
#if defined(ARM3R_LANES) && ARM3R_LANES == 1
#define ARM3R_LANE_PACKS(X)
#else
#define ARM3R_LANE_PACKS(X) X(arm3r::Pack<2>)
#endif
#define ARM3R_ROW_PACKS(X) X(arm3r::Pack<2>)
#define ARM3R_PACKS(X) X(arm3r::Pack<2>)
#elif !defined(ARM3R_LANES)
#define ARM3R_LANE_PACKS(X) X(arm3r::Pack<2>) X(arm3r::Pack<4>) X(arm3r::Pack<8>)
#define ARM3R_ROW_PACKS(X) X(arm3r::Pack<2>) X(arm3r::Pack<4>)
#define ARM3R_PACKS(X) ARM3R_LANE_PACKS(X)
#elif ARM3R_LANES == 4
#define ARM3R_LANE_PACKS(X) X(arm3r::Pack<4>)
#define ARM3R_ROW_PACKS(X) X(arm3r::Pack<4>)
#define ARM3R_PACKS(X) X(arm3r::Pack<4>)
#else
#define ARM3R_LANE_PACKS(X) X(arm3r::Pack<8>)
#define ARM3R_ROW_PACKS(X) X(arm3r::Pack<4>)
#define ARM3R_PACKS(X) X(arm3r::Pack<4>) X(arm3r::Pack<8>)
#endif
// X(T) for each T that a lane run may have.
#define ARM3R_LANE_TYPES(X) X(double) ARM3R_LANE_PACKS(X)

namespace arm3r {

// The same as lists of types.
template <class... T>
struct TypeList {};
#define ARM3R_COMMA_BEFORE(T) , T
using LaneTypes = TypeList<double ARM3R_LANE_PACKS(ARM3R_COMMA_BEFORE)>;
using RowTypes = TypeList<double ARM3R_ROW_PACKS(ARM3R_COMMA_BEFORE)>;
#undef ARM3R_COMMA_BEFORE

template <class First, class... Rest>
TypeList<Rest...> without_first(TypeList<First, Rest...>);
using LanePacks = decltype(without_first(LaneTypes{}));

// Whether this processor has registers for as many lanes, and this build instructions for them.
inline bool has_registers_for(int lanes) {
#if ARM3R_WIDE_PACKS
    return lanes <= register_width();
#else
    return lanes <= 2;
#endif
}

// The most lanes of a type in the list that this processor has registers for, at most `limit`.
template <class... T>
int widest(TypeList<T...>, int limit) {
    const auto usable = [limit](int lanes) { return lanes <= limit && has_registers_for(lanes) ? lanes : 1; };
    return std::max({usable(Lanes<T>::count)...});
}

// The most lanes of a batch of this build on this processor.
inline int max_lanes() { return widest(LaneTypes{}, 8); }

// Functions that are not inlined and that are compiled for the registers that hold T. run(f) calls f, so that rare code
// does not spill registers in a hot loop; call<F> is the function of a class without data, for a function pointer.
template <class T>
struct Outlined {
    template <class F>
    [[gnu::noinline]] static void run(const F& f) {
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
    [[gnu::noinline]] ARM3R_FOR_FOUR static void run(const F& f) {
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
    [[gnu::noinline]] ARM3R_FOR_EIGHT static void run(const F& f) {
        f();
    }
    template <class F, class... A>
    [[gnu::noinline]] ARM3R_FOR_EIGHT static void call(A... arguments) {
        F{}(arguments...);
    }
};

// Calls f, compiled for each of the widths of this build, at the widest that the processor has registers for. All functions
// that f calls are inlined.
template <class F>
void run_at_widest(F f) {
#if ARM3R_HAS_EIGHT
    if (has_registers_for(8)) return Outlined<Pack<8>>::run(f);
#endif
#if ARM3R_HAS_FOUR
    if (has_registers_for(4)) return Outlined<Pack<4>>::run(f);
#endif
    Outlined<double>::run(f);
}

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

// Whether a mask holds in any lane or in all, as any() and all() say: by the one instruction for it (README, g++ 6), and so in
// functions alone that are compiled for the registers of the mask (Outlined).
ARM3R_INLINE bool in_any_lane(bool mask) { return mask; }
ARM3R_INLINE bool in_all_lanes(bool mask) { return mask; }

template <class Mask>
ARM3R_INLINE bool in_any_lane(const Mask& mask) {
    return any(mask);
}
template <class Mask>
ARM3R_INLINE bool in_all_lanes(const Mask& mask) {
    return all(mask);
}

#if ARM3R_WIDE_PACKS && !defined(__clang__)
// The highest bit of each lane.
ARM3R_INLINE unsigned high_bits(const PackMask<4>& mask) {
    unsigned bits;
    asm("vmovmskpd %1, %0" : "=r"(bits) : "x"(mask.v));
    return bits;
}
ARM3R_INLINE unsigned high_bits(const PackMask<8>& mask) {
    unsigned char bits;
    asm("vpmovq2m %1, %0" : "=Yk"(bits) : "v"(mask.v));
    return bits;
}

ARM3R_INLINE bool in_any_lane(const PackMask<4>& mask) { return high_bits(mask) != 0; }
ARM3R_INLINE bool in_all_lanes(const PackMask<4>& mask) { return high_bits(mask) == 0xf; }
ARM3R_INLINE bool in_any_lane(const PackMask<8>& mask) { return high_bits(mask) != 0; }
ARM3R_INLINE bool in_all_lanes(const PackMask<8>& mask) { return high_bits(mask) == 0xff; }
#endif

}  // namespace arm3r
