// A number with its N exact first derivatives. Its value has the same bits as the double computation.
#pragma once

#include <array>

#include "arm3r/numbers/real.hpp"

namespace arm3r {

// ---- functions with their partial derivatives

// f(a) and df/da.
template <class T>
struct OfOne {
    T result, by_a;
};
// f(a, b), df/da and df/db.
template <class T>
struct OfTwo {
    T result, by_a, by_b;
};

template <class T>
ARM3R_INLINE OfTwo<T> divide_and_slopes(const T& a, const T& b) {
    const T quotient = a / b;
    return {quotient, 1.0 / b, -quotient / b};
}
template <class T>
ARM3R_INLINE OfOne<T> copysign_and_slopes(const T& magnitude, const T& sign) {
    const T one(1.0);
    return {copysign(magnitude, sign), copysign(one, magnitude) * copysign(one, sign)};
}
// If the derivative is infinite or undefined, it is set to 0: this happens at a clamped argument only, which does not
// move.
template <class T>
ARM3R_INLINE OfOne<T> sqrt_and_slopes(const T& x) {
    const T root = sqrt(x);
    return {root, select(root > T(0.0), T(0.5 / root), T(0.0))};
}
template <class T>
ARM3R_INLINE OfOne<T> tanh_and_slopes(const T& x) {
    const T result = tanh(x);
    return {result, (1.0 - result) * (1.0 + result)};
}
template <class T>
ARM3R_INLINE OfTwo<T> atan2_and_slopes(const T& y, const T& x) {
    const T square = x * x + y * y, zero(0.0);
    const auto turns = square > zero;
    return {atan2(y, x), select(turns, T(x / square), zero), select(turns, T(-y / square), zero)};
}
template <class T>
ARM3R_INLINE OfOne<T> fifth_root_and_slopes(const T& x) {
    const T root = fifth_root(x);
    return {root, root / (5.0 * x)};
}
template <class T>
ARM3R_INLINE OfOne<T> exp_and_slopes(const T& x) {
    const T result = exp(x);
    return {result, result};
}
template <class T>
ARM3R_INLINE OfOne<T> log_and_slopes(const T& x) {
    return {log(x), 1.0 / x};
}
// For p >= 1 the derivatives are finite down to x = 0, where they are those of x > 0.
template <class T>
ARM3R_INLINE OfTwo<T> power_and_slopes(const T& x, const T& p) {
    const T result = power(x, p), zero(0.0), one(1.0);
    const T of_less = select(p == one, one, power(x, T(p - 1.0)));
    return {result, select(x < zero, zero, T(p * of_less)), select(result > zero, T(result * log(x)), zero)};
}

// ---- the number

template <int N>
struct Dual {
    double number = 0.0;
    std::array<double, N> slope{};

    Dual() = default;
    Dual(double constant) : number(constant) {}
    Dual(double number, const std::array<double, N>& slope) : number(number), slope(slope) {}

    // The i-th of the N variables of differentiation.
    static Dual variable(double number, int i) {
        Dual x(number);
        x.slope[i] = 1.0;
        return x;
    }

    friend double value(const Dual& x) { return x.number; }

    friend Dual operator+(const Dual& a, const Dual& b) { return chain(a.number + b.number, a, 1.0, b, 1.0); }
    friend Dual operator-(const Dual& a, const Dual& b) { return chain(a.number - b.number, a, 1.0, b, -1.0); }
    friend Dual operator*(const Dual& a, const Dual& b) { return chain(a.number * b.number, a, b.number, b, a.number); }
    friend Dual operator/(const Dual& a, const Dual& b) { return chain(divide_and_slopes(a.number, b.number), a, b); }
    friend Dual operator-(const Dual& a) { return chain(-a.number, a, -1.0); }
    Dual& operator+=(const Dual& b) { return *this = *this + b; }
    Dual& operator-=(const Dual& b) { return *this = *this - b; }
    Dual& operator*=(const Dual& b) { return *this = *this * b; }
    Dual& operator/=(const Dual& b) { return *this = *this / b; }

    friend bool operator<(const Dual& a, const Dual& b) { return a.number < b.number; }
    friend bool operator>(const Dual& a, const Dual& b) { return a.number > b.number; }
    friend bool operator<=(const Dual& a, const Dual& b) { return a.number <= b.number; }
    friend bool operator>=(const Dual& a, const Dual& b) { return a.number >= b.number; }
    friend bool operator==(const Dual& a, const Dual& b) { return a.number == b.number; }
    friend bool operator!=(const Dual& a, const Dual& b) { return a.number != b.number; }

    friend Dual select(bool mask, const Dual& a, const Dual& b) { return mask ? a : b; }
    friend Dual min(const Dual& a, const Dual& b) { return b < a ? b : a; }
    friend Dual max(const Dual& a, const Dual& b) { return a < b ? b : a; }
    friend Dual abs(const Dual& x) { return copysign(x, Dual(1.0)); }
    friend Dual copysign(const Dual& magnitude, const Dual& sign) {
        return chain(copysign_and_slopes(magnitude.number, sign.number), magnitude);
    }

    friend Dual nearest_integer(const Dual& x) {
        return Dual(arm3r::nearest_integer(x.number));
    }  // its derivative is 0 except at the jumps

    friend Dual sqrt(const Dual& x) { return chain(sqrt_and_slopes(x.number), x); }
    friend SinCos<Dual> sincos(const Dual& x) {
        const auto [sine, cosine] = sincos(x.number);
        return {chain(sine, x, cosine), chain(cosine, x, -sine)};
    }
    friend Dual tanh(const Dual& x) { return chain(tanh_and_slopes(x.number), x); }
    friend Dual atan2(const Dual& y, const Dual& x) { return chain(atan2_and_slopes(y.number, x.number), y, x); }
    friend Dual fifth_root(const Dual& x) { return chain(fifth_root_and_slopes(x.number), x); }
    friend Dual exp(const Dual& x) { return chain(exp_and_slopes(x.number), x); }
    friend Dual log(const Dual& x) { return chain(log_and_slopes(x.number), x); }
    friend Dual power(const Dual& x, const Dual& p) { return chain(power_and_slopes(x.number, p.number), x, p); }

private:
    // Two derivatives at a time share a register.
    typedef double Two __attribute__((vector_size(16)));
    static Two two(const Dual& x, int i) {
        Two pair;
        __builtin_memcpy(&pair, &x.slope[i], sizeof pair);
        return pair;
    }
    static Dual chain(const OfOne<double>& f, const Dual& a) { return chain(f.result, a, f.by_a); }
    static Dual chain(const OfTwo<double>& f, const Dual& a, const Dual& b) {
        return chain(f.result, a, f.by_a, b, f.by_b);
    }
    static Dual chain(double result, const Dual& a, double by_a) {
        Dual y(result);
        for (int i = 0; i + 1 < N; i += 2) {
            const Two pair = by_a * two(a, i);
            __builtin_memcpy(&y.slope[i], &pair, sizeof pair);
        }
        if constexpr (N % 2 != 0) y.slope[N - 1] = by_a * a.slope[N - 1];
        return y;
    }
    static Dual chain(double result, const Dual& a, double by_a, const Dual& b, double by_b) {
        Dual y(result);
        for (int i = 0; i + 1 < N; i += 2) {
            const Two pair = by_a * two(a, i) + by_b * two(b, i);
            __builtin_memcpy(&y.slope[i], &pair, sizeof pair);
        }
        if constexpr (N % 2 != 0) y.slope[N - 1] = by_a * a.slope[N - 1] + by_b * b.slope[N - 1];
        return y;
    }
};

template <int N>
inline constexpr bool is_heavy<Dual<N>> = true;

static_assert(Real<Dual<1>> && Real<Dual<6>>);

}  // namespace arm3r
