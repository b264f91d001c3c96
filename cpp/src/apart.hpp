#pragma once
// A piece of a long function as a function of its own, compiled for the registers that hold T: what is not always needed
// stays out of the way of what is.

#include "arm3r/pack.hpp"

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

}  // namespace arm3r
