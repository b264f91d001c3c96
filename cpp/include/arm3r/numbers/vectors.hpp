#pragma once
// Vectors and matrices of any number type, with sums in a fixed order, so that every type and width rounds alike.

#include <Eigen/Core>

#include "arm3r/numbers/real.hpp"

namespace arm3r {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3, Eigen::RowMajor>;

template <class T>
ARM3R_INLINE T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
ARM3R_INLINE Vec3<T> plus(const Vec3<T>& a, const Vec3<T>& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class T>
ARM3R_INLINE Vec3<T> minus(const Vec3<T>& a, const Vec3<T>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// A gain per axis times a vector.
template <class P, class T>
ARM3R_INLINE Vec3<T> cwise_product(const Vec3<P>& gain, const Vec3<T>& v) {
    return {gain[0] * v[0], gain[1] * v[1], gain[2] * v[2]};
}
template <class T>
ARM3R_INLINE Vec3<T> scaled(const T& factor, const Vec3<T>& v) {
    return {factor * v[0], factor * v[1], factor * v[2]};
}

template <class T>
ARM3R_INLINE Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T>
ARM3R_INLINE Vec3<T> times(const Mat3<T>& R, const Vec3<T>& v) {
    Vec3<T> out;
    for (int i = 0; i < 3; ++i) out[i] = R(i, 0) * v[0] + R(i, 1) * v[1] + R(i, 2) * v[2];
    return out;
}

template <class T>
ARM3R_INLINE Vec3<T> transposed_times(const Mat3<T>& R, const Vec3<T>& v) {
    Vec3<T> out;
    for (int i = 0; i < 3; ++i) out[i] = R(0, i) * v[0] + R(1, i) * v[1] + R(2, i) * v[2];
    return out;
}

template <class T>
ARM3R_INLINE Mat3<T> from_rows(const Vec3<T>& first, const Vec3<T>& second, const Vec3<T>& third) {
    Mat3<T> m;
    for (int j = 0; j < 3; ++j) {
        m(0, j) = first[j];
        m(1, j) = second[j];
        m(2, j) = third[j];
    }
    return m;
}

// A vector of parameters in the number type of the state.
template <class T, class P>
ARM3R_INLINE Vec3<T> broadcast(const Vec3<P>& v) {
    return {T(v[0]), T(v[1]), T(v[2])};
}

}  // namespace arm3r
