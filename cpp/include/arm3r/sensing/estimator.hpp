#pragma once
// The wall's stiffness, position and speed from force and position alone: least squares with forgetting of
// f = k s - k s0 + k v t (8.7), kept as a triangular factor that each sample is rotated into, so that the condition of
// the answer is that of the data and not its square.

#include <array>
#include <limits>

#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

template <class T>
struct WallEstimate {
    T stiffness;    // N/m
    T face, speed;  // m along the pressing direction at the first sample, m/s towards the arm
    T condition;    // of the data, columns scaled to the same size; infinite if the force does not depend on position
};

template <class T>
class Estimator {
public:
    // Starts again; clear(x) sets a number to zero.
    template <class Clear>
    void reset(bool wall_moves, Clear clear) {
        size_ = wall_moves ? 3 : 2;
        for (T& x : factor_) clear(x);
    }

    // s: m along the pressing direction; f: N; t: s since the first sample.
    ARM3R_INLINE void add(const T& s, const T& t, const T& f, const T& forgetting) {
        const T weight = sqrt(forgetting);
        for (int i = 0; i < size_; ++i)
            for (int j = i; j <= size_; ++j) at(i, j) = weight * at(i, j);
        std::array<T, 4> row{s, T(1.0), size_ == 3 ? t : f, f};
        for (int i = 0; i < size_; ++i) rotate_in(row, i);
    }

    // The sample enters only where `due`.
    template <class M>
    ARM3R_INLINE void add_where(const M& due, const T& s, const T& t, const T& f, const T& forgetting) {
        Estimator after = *this;
        after.add(s, t, f, forgetting);
        for (std::size_t i = 0; i < factor_.size(); ++i) factor_[i] = select(due, after.factor_[i], factor_[i]);
    }

    ARM3R_INLINE WallEstimate<T> solve() const {
        std::array<T, 3> x{T(0.0), T(0.0), T(0.0)};
        for (int i = size_ - 1; i >= 0; --i) {
            T rest = at(i, size_);
            for (int j = i + 1; j < size_; ++j) rest = rest - at(i, j) * x[j];
            x[i] = rest / at(i, i);
        }
        const T condition = this->condition();
        const auto none = !(abs(x[0] * at(0, 0)) > rounding * (condition * force()));
        const T o(0.0), stiffness = select(none, T(1.0), x[0]);
        return {select(none, o, x[0]), select(none, o, T(-x[1] / stiffness)), select(none, o, T(x[2] / stiffness)),
                select(none, T(infinite), condition)};
    }

private:
    ARM3R_INLINE T& at(int i, int j) { return factor_[4 * i + j]; }
    ARM3R_INLINE const T& at(int i, int j) const { return factor_[4 * i + j]; }

    ARM3R_INLINE void rotate_in(std::array<T, 4>& row, int i) {
        const T length = sqrt(at(i, i) * at(i, i) + row[i] * row[i]);
        const auto empty = length == T(0.0);
        const T divisor = select(empty, T(1.0), length);
        const T c = select(empty, T(1.0), T(at(i, i) / divisor)), d = select(empty, T(0.0), T(row[i] / divisor));
        for (int j = i; j <= size_; ++j) {
            const T kept = c * at(i, j) + d * row[j];
            row[j] = c * row[j] - d * at(i, j);
            at(i, j) = kept;
        }
    }

    // The length of the column of forces, N.
    ARM3R_INLINE T force() const {
        T square(0.0);
        for (int i = 0; i < size_; ++i) square = square + at(i, size_) * at(i, size_);
        return sqrt(square);
    }

    // Norm times norm of the inverse (Frobenius), columns scaled to length one.
    ARM3R_INLINE T condition() const {
        std::array<T, 9> r, inverse;
        for (int j = 0; j < size_; ++j) {
            T square(0.0);
            for (int i = 0; i <= j; ++i) square = square + at(i, j) * at(i, j);
            for (int i = 0; i < size_; ++i) r[3 * i + j] = i <= j ? T(at(i, j) / sqrt(square)) : T(0.0);
        }
        T forward(0.0), backward(0.0);
        for (int j = 0; j < size_; ++j)
            for (int i = j; i >= 0; --i) {
                T rest(i == j ? 1.0 : 0.0);
                for (int k = i + 1; k <= j; ++k) rest = rest - r[3 * i + k] * inverse[3 * k + j];
                inverse[3 * i + j] = rest / r[3 * i + i];
                forward = forward + r[3 * i + j] * r[3 * i + j];
                backward = backward + inverse[3 * i + j] * inverse[3 * i + j];
            }
        return sqrt(forward * backward);
    }

    // A force depends on position if position explains at least this share of it, times the condition of the data: a
    // thousand rounding errors.
    static constexpr double rounding = 1e3 * std::numeric_limits<double>::epsilon();

    int size_ = 3;
    std::array<T, 12> factor_{};  // row by row: triangular, with the right-hand side behind it
};

}  // namespace arm3r
