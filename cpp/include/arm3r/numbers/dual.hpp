// A number with its N exact first derivatives. Its value has the same bits as the double computation.
#pragma once

#include <array>

#include "arm3r/numbers/real.hpp"

namespace arm3r {

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
    friend Dual operator/(const Dual& a, const Dual& b) {
        const double quotient = a.number / b.number;
        return chain(quotient, a, 1.0 / b.number, b, -quotient / b.number);
    }
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
        const double flip = copysign(1.0, magnitude.number) * copysign(1.0, sign.number);
        return chain(copysign(magnitude.number, sign.number), magnitude, flip);
    }

    friend Dual nearest_integer(const Dual& x) {
        return Dual(arm3r::nearest_integer(x.number));
    }  // its derivative is 0 except at the jumps

    // If the derivative is infinite or undefined, it is set to 0: this happens at a clamped argument only, which does
    // not move.
    friend Dual sqrt(const Dual& x) {
        const double root = sqrt(x.number);
        return chain(root, x, root > 0.0 ? 0.5 / root : 0.0);
    }
    friend SinCos<Dual> sincos(const Dual& x) {
        const auto [sine, cosine] = sincos(x.number);
        return {chain(sine, x, cosine), chain(cosine, x, -sine)};
    }
    friend Dual tanh(const Dual& x) {
        const double result = tanh(x.number);
        return chain(result, x, (1.0 - result) * (1.0 + result));
    }
    friend Dual atan2(const Dual& y, const Dual& x) {
        const double square = x.number * x.number + y.number * y.number;
        const double by_y = square > 0.0 ? x.number / square : 0.0, by_x = square > 0.0 ? -y.number / square : 0.0;
        return chain(atan2(y.number, x.number), y, by_y, x, by_x);
    }
    friend Dual fifth_root(const Dual& x) {
        const double root = fifth_root(x.number);
        return chain(root, x, root / (5.0 * x.number));
    }
    friend Dual exp(const Dual& x) {
        const double result = exp(x.number);
        return chain(result, x, result);
    }
    friend Dual log(const Dual& x) { return chain(log(x.number), x, 1.0 / x.number); }
    // For p >= 1 the derivatives are finite down to x = 0, where they are those of x > 0.
    friend Dual power(const Dual& x, const Dual& p) {
        const double result = power(x.number, p.number);
        const double of_less = p.number == 1.0 ? 1.0 : power(x.number, p.number - 1.0);
        const double by_x = x.number < 0.0 ? 0.0 : p.number * of_less;
        return chain(result, x, by_x, p, result > 0.0 ? result * log(x.number) : 0.0);
    }

private:
    // Two derivatives at a time share a register.
    typedef double Two __attribute__((vector_size(16)));
    static Two two(const Dual& x, int i) {
        Two pair;
        __builtin_memcpy(&pair, &x.slope[i], sizeof pair);
        return pair;
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
