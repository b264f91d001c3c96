#pragma once
// The pose of the arm by sines and cosines. Slide convention.

#include "arm3r/numbers/pack.hpp"
#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

// Sines and cosines of q1 and of the absolute link angles q2 and q2 + q3.
template <class T>
struct Pose {
    T S1, C1, S2, C2, S23, C23;
};

template <class T>
struct IkResult {
    Vec3<T> q;
    T cos_q3;  // outside [-1, 1] the point is out of reach; of an elbow arm: of the bend
};

// sin q3
template <class T>
ARM3R_INLINE T sin_q3(const Pose<T>& p) {
    return p.S23 * p.C2 - p.C23 * p.S2;
}

template <class T>
ARM3R_INLINE Pose<T> pose(const Vec3<T>& q) {
    const T sum = q[1] + q[2];
    const T added = sum - q[1];
    // the rounding error of the sum, exactly; the rotation below corrects it
    const T lost = (q[1] - (sum - added)) + (q[2] - added);
    const SinCos<T> first = sincos(q[0]);
    const auto [second, third] = sincos_pair(q[1], sum);
    return {first.sin, first.cos, second.sin, second.cos, third.sin + lost * third.cos, third.cos - lost * third.sin};
}

}  // namespace arm3r
