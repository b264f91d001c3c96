#pragma once
// A piece of a long function as a function of its own, compiled for the registers that hold T: what is not always needed
// stays out of the way of what is.

#include "arm3r/numbers/pack.hpp"

namespace arm3r {

template <class T>
struct Apart {
    template <class F>
    [[gnu::noinline]] static void run(F f) {
        f();
    }
};

#if ARM3R_WIDE_PACKS
template <>
struct Apart<Pack<4>> {
    template <class F>
    [[gnu::noinline]] ARM3R_FOR_FOUR static void run(F f) {
        f();
    }
};

template <>
struct Apart<Pack<8>> {
    template <class F>
    [[gnu::noinline]] ARM3R_FOR_EIGHT static void run(F f) {
        f();
    }
};
#endif

// A right-hand side that the stages of a step call, instead of each holding a copy of it.
template <class T, class F>
struct Called {
    const F& f;
    template <class Y>
    ARM3R_INLINE void operator()(const T& t, const Y& y, Y& dy) const {
        Apart<T>::run([&]() ARM3R_INLINE_LAMBDA { f(t, y, dy); });
    }
};
template <class T, class F>
ARM3R_INLINE Called<T, F> called(const F& f) {
    return {f};
}

}  // namespace arm3r
