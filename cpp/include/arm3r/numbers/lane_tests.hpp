// Whether a mask holds in any lane or in all, as any() and all() say: by the one instruction for it, which g++ 12 does not
// find (it takes eight or ten), and so in functions alone that are compiled for the registers of the mask (Outlined).
#pragma once

#include "arm3r/numbers/elementary.hpp"
#include "arm3r/numbers/widths.hpp"

namespace arm3r {

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

// sincos_near of several angles; a single test decides for all of them.
template <class T, std::size_t count>
ARM3R_INLINE std::array<SinCos<T>, count> sincos_near_each(const std::array<T, count>& base_angle,
                                                           const std::array<SinCos<T>, count>& base,
                                                           const std::array<T, count>& angle) {
    std::array<SinCos<T>, count> result;
    T farthest(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const T delta = angle[i] - base_angle[i];
        farthest = i == 0 ? abs(delta) : max(farthest, abs(delta));
        result[i] = sincos_rotated(base[i], delta);
    }
    if (!in_all_lanes(farthest <= T(sincos_near_limit)))
        for (std::size_t i = 0; i < count; ++i) result[i] = sincos_near(base_angle[i], base[i], angle[i]);
    return result;
}

}  // namespace arm3r
