#pragma once
// A k-th root for step sizes: by polynomials for log2 and exp2, with the same bits everywhere.

#include "arm3r/numbers/elementary.hpp"

namespace arm3r {

// x^(1/k) of a normal positive x, to a relative 1e-3.
template <Lanewise T>
ARM3R_INLINE T approximate_root(const T& x, int k) {
    const T exponent = with_bits(x, [](auto& i) ARM3R_INLINE_LAMBDA { i = (i >> 52) | 0x4330000000000000; }) -
                       (0x1p52 + 1023);  // the integer i is read as the low bits of the double 2^52 + i
    const T m = with_bits(x, [](auto& i) ARM3R_INLINE_LAMBDA { i = (i & 0x000fffffffffffff) | 0x3ff0000000000000; });
    const T log = exponent + ((-2.14494063 + m * 3.02947821) + (m * m) * (-1.03925816 + m * 0.15544586));
    const T y = log * (1.0 / k);
    const T rounded = y + round_magic;
    const T f = y - (rounded - round_magic);
    const T power = with_bits(rounded, [](auto& i) ARM3R_INLINE_LAMBDA { i = (i + 1023) << 52; });
    return power * ((0.99992448 + f * 0.69312103) + (f * f) * (0.24264008 + f * 0.05592204));
}

}  // namespace arm3r
