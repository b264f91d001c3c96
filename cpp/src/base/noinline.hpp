#pragma once
// Runs f in a function that is not inlined and that is compiled for the vector width of T, so that rare code does not
// spill registers in the hot loop.

#include "arm3r/numbers/pack.hpp"

namespace arm3r {

template <class T>
struct Outlined {
    template <class F>
    [[gnu::noinline]] static void run(F f) {
        f();
    }
};

#if ARM3R_WIDE_PACKS
template <>
struct Outlined<Pack<4>> {
    template <class F>
    [[gnu::noinline]] ARM3R_FOR_FOUR static void run(F f) {
        f();
    }
};

template <>
struct Outlined<Pack<8>> {
    template <class F>
    [[gnu::noinline]] ARM3R_FOR_EIGHT static void run(F f) {
        f();
    }
};
#endif

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
