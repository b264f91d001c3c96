// Elementary functions from + - * / and sqrt alone: the same bits on every machine, in every lane, at every
// optimisation level. One source for double and Pack; no fma, no libm, no branch on a value.
#pragma once

#include <limits>
#include <type_traits>

#include "arm3r/numbers/primitives.hpp"

namespace arm3r {

// If this is added to a number below 2^51, the number is rounded to an integer, which then is in the low bits.
inline constexpr double round_magic = 0x1.8p52;

template <class T>
ARM3R_INLINE T nearest_integer(const T& x) {
    return (x + round_magic) - round_magic;
}

// Above this many radians the argument reduction of sincos loses digits: a run ends there, a function reports an error.
inline constexpr double sincos_limit = 1e5;

// For |x| <= sincos_limit. The angle is n quarter turns plus a remainder r within pi/4. pi/2 is the sum of three parts
// of 37, 37 and 53 bits, so that n times the first two is exact. The quarter turns enter as an exact rotation by (cos,
// sin) of n pi/2, which are 0 or +-1. The sums are arranged so that the chain of dependent operations is short.
template <Lanewise T>
ARM3R_INLINE SinCos<T> sincos(const T& x) {
    const T magnitude = abs(x);
    const T n = (magnitude * 0x1.45f306dc9c883p-1 + round_magic) - round_magic;
    const T coarse = (magnitude - n * 0x1.921fb54440000p+0) - n * 0x1.68c234c4c0000p-39;
    const T r = coarse - n * 0x1.98a2e03707345p-77;

    const T z = coarse * coarse;
    const T z2 = z * z;
    const T z4 = z2 * z2;
    const T sine_tail = ((-0x1.5555555555549p-3 + z * 0x1.111111110f8a6p-7) +
                         z2 * (-0x1.a01a019c161d5p-13 + z * 0x1.71de357b1fe7dp-19)) +
                        z4 * (-0x1.ae5e68a2b9cebp-26 + z * 0x1.5d93a5acfd57cp-33);
    const T cosine_tail = ((0x1.555555555554cp-5 + z * -0x1.6c16c16c15177p-10) +
                           z2 * (0x1.a01a019cb1590p-16 + z * -0x1.27e4f809c52adp-22)) +
                          z4 * (0x1.1ee9ebdb4b1c4p-29 + z * -0x1.8fae9be8838d4p-37);
    const T sine = r + (r * z) * sine_tail;
    const T cosine = (1.0 - 0.5 * z) + z2 * cosine_tail;

    const T quarters = n - ((n + 4.0 * round_magic) - 4.0 * round_magic);  // -2, -1, 0, 1, 2
    const T turn_cosine = 1.0 - abs(quarters);
    const T turn_sine = quarters * (1.0 + turn_cosine);
    const T sign = copysign(T(1.0), x);
    return {(turn_sine * sign) * cosine + (turn_cosine * sign) * sine, turn_cosine * cosine - turn_sine * sine};
}

// sin and cos of (angle + delta) from those of angle, for |delta| <= sincos_near_limit: absolute error below 3e-16. The
// last coefficient of the cosine makes up for most of the next one, 1/40320.
inline constexpr double sincos_near_limit = 0.045;

template <class T>
ARM3R_INLINE SinCos<T> sincos_rotated(const SinCos<T>& base, const T& delta) {
    const T z = delta * delta;
    const T z2 = z * z;
    const T sine = delta + (delta * z) * (((-1.0 / 6) + z * (1.0 / 120)) + z2 * (-1.0 / 5040));
    const T cosine_less_1 = z * ((-0.5 + z * (1.0 / 24)) + z2 * (-1.0 / 720 + 4.638e-8));
    return {base.sin + (base.cos * sine + base.sin * cosine_less_1),
            base.cos + (base.cos * cosine_less_1 - base.sin * sine)};
}

// sincos(angle), cheaper in each lane where base = sincos(base_angle) is near. The result of a lane does not depend on
// other lanes.
template <class T>
ARM3R_INLINE SinCos<T> sincos_near(const T& base_angle, const SinCos<T>& base, const T& angle) {
    const T delta = angle - base_angle;
    const auto near = abs(delta) <= T(sincos_near_limit);
    const SinCos<T> rotated = sincos_rotated(base, delta);
    if (all(near)) return rotated;
    const SinCos<T> full = sincos(angle);
    return {select(near, rotated.sin, full.sin), select(near, rotated.cos, full.cos)};
}

// tanh = E / (E + 2) with E = expm1(2|x|) = 2^k expm1(r) + (2^k - 1), r = 2|x| - k ln 2.
template <Lanewise T>
ARM3R_INLINE T tanh(const T& x) {
    const T u = 2.0 * min(abs(x), T(22.0));
    const T rounded = u * 0x1.71547652b82fep+0 + round_magic;
    const T k = rounded - round_magic;
    const T r = (u - k * 0x1.62e42fefa3800p-1) - k * 0x1.ef35793c76730p-45;
    const T power = with_bits(rounded, [](auto& i) ARM3R_INLINE_LAMBDA { i = (i + 1023) << 52; });

    const T z = r * r;
    const T z2 = z * z;
    const T tail = ((1.0 / 6) + r * (1.0 / 24)) + z * ((1.0 / 120) + r * (1.0 / 720)) +
                   z2 * (((1.0 / 5040) + r * (1.0 / 40320)) + z * ((1.0 / 362880) + r * (1.0 / 3628800)) +
                         z2 * ((1.0 / 39916800) + r * ((1.0 / 479001600) + r * (1.0 / 6227020800))));
    const T e = power * (r + (0.5 * z + (r * z) * tail)) + (power - 1.0);
    return copysign(e / (e + 2.0), x);
}

// Angle of the finite vector (x, y) in [-pi, pi]; signed zeros as in C. The octant leaves an arctangent within
// tan(pi/8); the answer is a multiple of pi/4 (high part exact for up to 4 of them) plus or minus it.
template <Lanewise T>
ARM3R_INLINE T atan2(const T& y, const T& x) {
    const T ax = abs(x), ay = abs(y);
    const auto steep = ay > ax;
    const T low = select(steep, ax, ay);
    const T high = select(steep, ay, ax);
    const auto far = low > 0x1.a827999fcef32p-2 * high;
    const T numerator = select(far, low - high, low);
    const T denominator = select(high == T(0.0), T(1.0), select(far, low + high, high));
    const T t = numerator / denominator;

    const T z = t * t;
    const T z2 = z * z;
    const T z4 = z2 * z2;
    const T tail =
        ((-0x1.555555555550dp-2 + z * 0x1.999999998ebc4p-3) + z2 * (-0x1.24924920083ffp-3 + z * 0x1.c71c6fe231671p-4)) +
        z4 * (((-0x1.745cdc54c206ep-4 + z * 0x1.3b0f2af749a6dp-4) +
               z2 * (-0x1.10d66a0d03d51p-4 + z * 0x1.dde2d52defd9ap-5)) +
              z4 * ((-0x1.97b4b24760debp-5 + z * 0x1.2b4442c6a6c2fp-5) - z2 * 0x1.0ad3ae322da11p-6));
    const T arc = t + (t * z) * tail;

    const auto left = copysign(T(1.0), x) < T(0.0);
    T eighths = select(far, T(1.0), T(0.0));
    T signed_arc = arc;
    eighths = select(steep, 2.0 - eighths, eighths);
    signed_arc = select(steep, -signed_arc, signed_arc);
    eighths = select(left, 4.0 - eighths, eighths);
    signed_arc = select(left, -signed_arc, signed_arc);
    return copysign(eighths * 0x1.921fb54442d18p-1 + (signed_arc + eighths * 0x1.1a62633145c07p-55), y);
}

template <class T>
ARM3R_INLINE T acos(const T& x) {
    return 2.0 * atan2(sqrt(1.0 - x), sqrt(1.0 + x));
}

template <class T>
ARM3R_INLINE T hypot2(const T& x, const T& y) {
    return sqrt(x * x + y * y);
}

// x^(1/5) of a normal positive x; zero gives a tiny positive number. The first guess divides the exponent by five
// in the upper half of the bits, two Halley steps and one of Newton follow.
template <Lanewise T>
ARM3R_INLINE T fifth_root(const T& x) {
    const T upper = with_bits(x,
                              [](auto& i) ARM3R_INLINE_LAMBDA {
                                  i = ((i >> 32) & 0x7fffffff) | 0x4330000000000000;  // the double 2^52 + that half
                              }) -
                    0x1p52;
    T y = with_bits(upper * 0.2 + (0x1p52 + 0.8 * 1023 * 0x1p20), [](auto& i) ARM3R_INLINE_LAMBDA { i = i << 32; });
    for (int i = 0; i < 2; ++i) {
        const T ratio = x / ((y * y) * (y * y) * y);
        y = y * (3.0 * ratio + 2.0) / (2.0 * ratio + 3.0);
    }
    return y + y * ((x / ((y * y) * (y * y) * y) - 1.0) * 0.2);
}

// e^(high + low) for |low| <= 1e-6 (1 + |high|): the sum is n ln 2 + r + rest. ln 2 is the sum of two parts of 42 and
// 53 bits, so that n times the first is exact. The scale 2^n is applied in two factors, for results at the ends of the
// range.
template <Lanewise T>
ARM3R_INLINE T exp_of_sum(const T& high, const T& low) {
    const T x = min(max(high, T(-746.0)), T(710.0));
    const T rounded = x * 0x1.71547652b82fep+0 + round_magic;
    const T n = rounded - round_magic;
    const T coarse = x - n * 0x1.62e42fefa3800p-1;
    const T fine = low - n * 0x1.ef35793c76730p-45;
    const T r = coarse + fine;
    const T rest = fine - (r - coarse);

    const T z = r * r;
    const T z2 = z * z;
    const T tail =
        ((0x1.555555555555ap-3 + r * 0x1.5555555555530p-5) + z * (0x1.111111110efbcp-7 + r * 0x1.6c16c16c27019p-10)) +
        z2 * (((0x1.a01a01b26bcc5p-13 + r * 0x1.a01a0152714f5p-16) +
               z * (0x1.71ddf26930834p-19 + r * 0x1.27e58cfe16d7dp-22)) +
              z2 * (0x1.af686d6c0edfep-26 + r * 0x1.1e6710052bdd7p-29));
    const T sum = 1.0 + r;
    const T rounding = r - (sum - 1.0);
    const T result = sum + (rounding + (0.5 * z + ((r * z) * tail + (rest + rest * r))));

    const T half = n * 0.5 + round_magic;
    const auto power_of_two = [](auto& i) ARM3R_INLINE_LAMBDA { i = (i + 1023) << 52; };
    return (result * with_bits(half, power_of_two)) * with_bits(rounded - (half - round_magic), power_of_two);
}

// e^x of every number: 0 below -745.2, infinite above 709.8.
template <Lanewise T>
ARM3R_INLINE T exp(const T& x) {
    return exp_of_sum(x, T(0.0));
}

// An unevaluated sum of two numbers (double-double); the second is a correction of the first.
template <class T>
struct DoubleDouble {
    T high, low;
};

// x without its lowest 27 bits: the product of two such numbers is exact.
template <Lanewise T>
ARM3R_INLINE T leading_bits(const T& x) {
    return with_bits(x, [](auto& i) ARM3R_INLINE_LAMBDA { i = i & -(std::int64_t{1} << 27); });
}

// ln x of a normal positive x, its error below 2^-57. x = 2^n m, sqrt(1/2) <= m < sqrt(2); ln m = 2 artanh(s) with
// s = (m - 1)/(m + 1): its leading bits, and by division the rest, for what the leading bits leave of m - 1 is exact.
template <Lanewise T>
ARM3R_INLINE DoubleDouble<T> log_double_double(const T& x) {
    const T n =
        with_bits(x, [](auto& i) ARM3R_INLINE_LAMBDA { i = ((i + 0x00095f619980c433) >> 52) | 0x4330000000000000; }) -
        (0x1p52 + 1023);  // the sum carries into the exponent from sqrt(1/2) = 0x3fe6a09e667f3bcd on
    const T m = with_bits(x, [](auto& i) ARM3R_INLINE_LAMBDA {
        i = ((i + 0x00095f619980c433) & 0x000fffffffffffff) + 0x3fe6a09e667f3bcd;
    });
    const T f = m - 1.0;
    const T inverse = 1.0 / (2.0 + f);
    const T s = f * inverse;
    const T s_leading = leading_bits(s), f_leading = leading_bits(f);
    const T left = ((f - 2.0 * s_leading) - s_leading * f_leading) - s_leading * (f - f_leading);

    const T z = s * s;
    const T z2 = z * z;
    const T tail =
        ((0x1.5555555555555p-1 + z * 0x1.9999999999dffp-2) + z2 * (0x1.249249242b407p-2 + z * 0x1.c71c7258fe812p-3)) +
        (z2 * z2) * ((0x1.745cde356497cp-3 + z * 0x1.3b20ab9872949p-3) +
                     z2 * (0x1.0f5cc84fc80b8p-3 + z * 0x1.0f6317ca7aeefp-3));
    const T twice = 2.0 * s_leading;
    const T turns = n * 0x1.62e42fefa3800p-1;
    const T high = turns + twice;
    return {high, (twice - (high - turns)) + (n * 0x1.ef35793c76730p-45 + (2.0 * (left * inverse) + (s * z) * tail))};
}

// ln x of every positive number, those below 2^-1022 counting as 2^-1022; of 0 it is -infinity, below there is none.
template <Lanewise T>
ARM3R_INLINE T log(const T& x) {
    constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    const DoubleDouble<T> sum = log_double_double(max(x, T(0x1p-1022)));
    const T positive = select(x < T(infinity), sum.high + sum.low, x);
    return select(x > T(0.0), positive, select(x == T(0.0), T(-infinity), T(nan)));
}

// x^p for 0 < x < infinity and any p; 0 for x <= 0, where p > 0 is meant. x^1 is x; otherwise an x below 2^-1022 counts
// as 2^-1022. The leading bits of p and ln x multiply exactly: up to the cube nearly all error is the exponential's.
template <Lanewise T>
ARM3R_INLINE T power(const T& x, const std::type_identity_t<T>& p) {
    const DoubleDouble<T> sum = log_double_double(max(x, T(0x1p-1022)));
    const T log = sum.high + sum.low;
    const T log_leading = leading_bits(log), p_leading = leading_bits(p);
    const T log_rest = (log - log_leading) + (sum.low - (log - sum.high));
    const T result = exp_of_sum(p_leading * log_leading, p * log_rest + (p - p_leading) * log_leading);
    return select(x > T(0.0), select(p == T(1.0), x, result), 0.0 * abs(x));
}

}  // namespace arm3r
