#pragma once
// The wall's stiffness, position and speed from force and position alone: least squares with forgetting of
// f = k s - k s0 + k v t (8.7), kept as a triangular factor that each sample is rotated into, so that the condition of
// the answer is that of the data and not its square. What remains of the samples after the rotations tells how far the
// stiffness may be from the truth.

#include <array>
#include <limits>

#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

template <class T>
struct WallEstimate {
    T stiffness;    // N/m
    T face, speed;  // m along the pressing direction at the first sample, m/s towards the arm
    T condition;    // of the data, columns scaled to the same size; infinite if the force does not depend on position
    T sigma;        // N/m, standard deviation of the stiffness; infinite or NaN where the samples do not tell it
};

// What is known of the errors of a fit: the variance of a force, N^2; and the damping of the wall, N s/m, whose force the
// fit of a spring takes for a part of the spring's.
template <class T>
struct FitErrors {
    T force, damping;
};

template <class T>
class Estimator {
public:
    // Starts again; clear(x) sets a number to zero.
    template <class Clear>
    void reset(bool wall_moves, Clear clear) {
        size_ = wall_moves ? 3 : 2;
        for (T& x : numbers_) clear(x);
    }

    // s: m along the pressing direction; f: N; t: s since the first sample; variance: of s, m^2.
    ARM3R_INLINE void add(const T& s, const T& t, const T& f, const T& variance, const T& forgetting) {
        const T weight = sqrt(forgetting);
        std::array<T, 4> row{s, T(1.0), size_ == 3 ? t : f, f}, again = row;
        rotate_in(row, fit_at, size_ + 1, weight);
        rotate_in(again, spread_at, size_, forgetting);
        add_residual(row[size_], forgetting);
        add_speed(s, t, forgetting);
        numbers_[variances] = forgetting * numbers_[variances] + variance;
    }

    // The sample enters only where `due`.
    template <class M>
    ARM3R_INLINE void add_where(const M& due, const T& s, const T& t, const T& f, const T& variance,
                                const T& forgetting) {
        Estimator after = *this;
        after.add(s, t, f, variance, forgetting);
        for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i] = select(due, after.numbers_[i], numbers_[i]);
    }

    // Forgets all samples where `lost`.
    template <class M>
    ARM3R_INLINE void forget_where(const M& lost) {
        for (T& x : numbers_) x = select(lost, T(0.0), x);
    }

    ARM3R_INLINE WallEstimate<T> solve(const FitErrors<T>& errors) const {
        std::array<T, 3> x{T(0.0), T(0.0), T(0.0)};
        for (int i = size_ - 1; i >= 0; --i) {
            T rest = fit(i, size_);
            for (int j = i + 1; j < size_; ++j) rest = rest - fit(i, j) * x[j];
            x[i] = rest / fit(i, i);
        }
        const T condition = this->condition();
        const auto none = !(abs(x[0] * fit(0, 0)) > rounding * (condition * force()));
        const T o(0.0), stiffness = select(none, T(1.0), x[0]);
        return {select(none, o, x[0]), select(none, o, T(-x[1] / stiffness)), select(none, o, T(x[2] / stiffness)),
                select(none, T(infinite), condition), sigma(x[0], condition, errors)};
    }

private:
    // Where the numbers lie: two triangular factors, row by row, the first with the right-hand side behind it and with
    // weights w of the squares, the second with weights w^2; then sums over the residuals.
    enum : int {
        fit_at = 0,
        spread_at = 12,
        weights_at = 24,
        squared_weights,
        squares,
        products,
        recent,
        speeds,
        last_position,
        last_time,
        variances,
        number_count
    };

    ARM3R_INLINE const T& fit(int i, int j) const { return numbers_[fit_at + 4 * i + j]; }
    ARM3R_INLINE const T& spread(int i, int j) const { return numbers_[spread_at + 4 * i + j]; }

    // Rotates a row into the factor that begins at `start`, whose rows before it come to weigh less. What remains in
    // the row's columns behind the triangle is its residual.
    ARM3R_INLINE void rotate_in(std::array<T, 4>& row, int start, int columns, const T& weight) {
        const auto at = [&](int i, int j) ARM3R_INLINE_LAMBDA -> T& { return numbers_[start + 4 * i + j]; };
        for (int i = 0; i < size_; ++i)
            for (int j = i; j < columns; ++j) at(i, j) = weight * at(i, j);
        for (int i = 0; i < size_; ++i) {
            const T length = sqrt(at(i, i) * at(i, i) + row[i] * row[i]);
            const auto empty = length == T(0.0);
            const T divisor = select(empty, T(1.0), length);
            const T c = select(empty, T(1.0), T(at(i, i) / divisor)), d = select(empty, T(0.0), T(row[i] / divisor));
            for (int j = i; j < columns; ++j) {
                const T kept = c * at(i, j) + d * row[j];
                row[j] = c * row[j] - d * at(i, j);
                at(i, j) = kept;
            }
        }
    }

    ARM3R_INLINE void add_residual(const T& residual, const T& forgetting) {
        const auto add_to = [&](int sum, const T& factor, const T& x)
                                ARM3R_INLINE_LAMBDA { numbers_[sum] = factor * numbers_[sum] + x; };
        add_to(weights_at, forgetting, T(1.0));
        add_to(squared_weights, T(forgetting * forgetting), T(1.0));
        add_to(squares, forgetting, T(residual * residual));
        add_to(products, forgetting, T(residual * numbers_[recent]));
        numbers_[recent] = memory * (numbers_[recent] + residual);
    }

    // Of the tip since the sample before.
    ARM3R_INLINE void add_speed(const T& s, const T& t, const T& forgetting) {
        const auto is_first = numbers_[weights_at] == T(1.0);
        const T way = select(is_first, T(0.0), T(s - numbers_[last_position]));
        const T speed = way / select(is_first, T(1.0), T(t - numbers_[last_time]));
        numbers_[speeds] = forgetting * numbers_[speeds] + speed * speed;
        numbers_[last_position] = s;
        numbers_[last_time] = t;
    }

    // (8.7)
    ARM3R_INLINE T sigma(const T& stiffness, const T& condition, const FitErrors<T>& errors) const {
        const std::array<T, 9> inverse = inverse_of_fit();
        T position(0.0), spread_of_k(0.0), fitted(0.0);
        for (int j = 0; j < size_; ++j) position = position + inverse[j] * inverse[j];
        for (int i = 0; i < size_; ++i) {
            T along(0.0);
            for (int j = i; j < size_; ++j) {
                T m(0.0);
                for (int k = i; k <= j; ++k) m = m + spread(i, k) * inverse[3 * k + j];
                fitted = fitted + m * m;
                along = along + m * inverse[j];
            }
            spread_of_k = spread_of_k + along * along;
        }
        const T weights = numbers_[weights_at], freedom = weights - fitted;
        const T samples = freedom * weights / numbers_[squared_weights], least = rounding * force();
        const T square = stiffness * stiffness, residual = numbers_[squares] / freedom;
        const T variance = numbers_[variances] / weights;
        const T expected = errors.force + square * variance + least * least;
        const T moved = 1.0 / (weights * position);
        const T most = expected * (1.0 + 4.0 * sqrt(T(2.0 / samples))) + square * moved * (misfit * misfit);
        const T repeats =
            1.0 + 2.0 * max(T(0.0), T(numbers_[products] / (numbers_[squares] + weights * expected * 1e-3)));
        const T independent = max(T(samples / repeats), T(2.0));
        const T by_noise =
            max(residual, T(0.5 * expected)) * spread_of_k * repeats * (independent / (independent - 2.0));
        const T by_position = stiffness * variance / moved, by_rounding = rounding * condition * stiffness;
        const T by_damping = errors.damping * errors.damping * numbers_[speeds] / (weights * moved);
        const T sigma = sqrt(T(by_noise + by_position * by_position + by_rounding * by_rounding + by_damping));
        return select(residual <= most, sigma, T(infinite));
    }

    ARM3R_INLINE std::array<T, 9> inverse_of_fit() const {
        std::array<T, 9> inverse;
        for (int j = 0; j < size_; ++j)
            for (int i = j; i >= 0; --i) {
                T rest(i == j ? 1.0 : 0.0);
                for (int k = i + 1; k <= j; ++k) rest = rest - fit(i, k) * inverse[3 * k + j];
                inverse[3 * i + j] = rest / fit(i, i);
            }
        return inverse;
    }

    // The length of the column of forces, N.
    ARM3R_INLINE T force() const {
        T square(0.0);
        for (int i = 0; i < size_; ++i) square = square + fit(i, size_) * fit(i, size_);
        return sqrt(square);
    }

    // Norm times norm of the inverse (Frobenius), columns scaled to length one.
    ARM3R_INLINE T condition() const {
        std::array<T, 9> r, inverse;
        for (int j = 0; j < size_; ++j) {
            T square(0.0);
            for (int i = 0; i <= j; ++i) square = square + fit(i, j) * fit(i, j);
            for (int i = 0; i < size_; ++i) r[3 * i + j] = i <= j ? T(fit(i, j) / sqrt(square)) : T(0.0);
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

    // Residuals are compared with those before them, each of which weighs so much less than the next.
    static constexpr double memory = 15.0 / 16;
    // The part of the force's variation that the fit may leave beyond the errors of the samples.
    static constexpr double misfit = 1e-3;

    int size_ = 3;
    std::array<T, number_count> numbers_{};
};

}  // namespace arm3r
