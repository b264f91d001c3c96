// N doubles in N independent lanes: the compiler maps them to the registers that the calling function may use (its
// target attribute), with the same bits.
#pragma once

#include <array>

#include "arm3r/numbers/real.hpp"

namespace arm3r {

template <class Element, int N>
struct Register {
    typedef Element type __attribute__((vector_size(sizeof(Element) * N)));
    // Written out for the widths of registers (README, g++ 1).
    ARM3R_INLINE static void set_all(type& v, Element x) {
        if constexpr (N == 2) v = type{x, x};
        else if constexpr (N == 4) v = type{x, x, x, x};
#if __has_builtin(__builtin_shufflevector)
        else if constexpr (N == 8) {
            const typename Register<Element, 4>::type four{x, x, x, x};
            v = __builtin_shufflevector(four, four, 0, 0, 0, 0, 0, 0, 0, 0);
        }
#endif
        else
            for (int lane = 0; lane < N; ++lane) v[lane] = x;
    }
};

// One truth value per lane: all bits set, or none. No loop of unknown length may take one of 8 lanes from outside (README,
// g++ 2).
template <int N>
struct PackMask {
    using Vector = typename Register<std::int64_t, N>::type;
    Vector v;

    PackMask() = default;
    ARM3R_INLINE PackMask(const PackMask& other) : v(other.v) {}
    ARM3R_INLINE PackMask& operator=(const PackMask& other) {
        v = other.v;
        return *this;
    }
    ARM3R_INLINE explicit PackMask(const Vector& lanes) : v(lanes) {}
    ARM3R_INLINE PackMask(bool all_lanes) { Register<std::int64_t, N>::set_all(v, -std::int64_t{all_lanes}); }
    ARM3R_INLINE bool operator[](int lane) const { return v[lane] != 0; }
    ARM3R_INLINE void set(int lane, bool here) { v[lane] = -std::int64_t{here}; }

    ARM3R_INLINE friend PackMask operator&&(const PackMask& a, const PackMask& b) {
        PackMask both;
        both.v = a.v & b.v;
        return both;
    }
    ARM3R_INLINE friend PackMask operator||(const PackMask& a, const PackMask& b) {
        PackMask either;
        either.v = a.v | b.v;
        return either;
    }
    ARM3R_INLINE friend PackMask operator!(const PackMask& a) {
        PackMask opposite;
        opposite.v = ~a.v;
        return opposite;
    }

    ARM3R_INLINE friend bool any(const PackMask& a) {
        if constexpr (N == 2) {
            return (a.v[0] | a.v[1]) != 0;
        } else if constexpr (N == 8) {
            // Ones that the compiler cannot see (README, g++ 3).
            std::int64_t ones = -1;
            asm("" : "+r"(ones));
            typename Register<std::int8_t, 8>::type narrow = __builtin_convertvector(a.v & ones, decltype(narrow));
            std::int64_t lanes;
            __builtin_memcpy(&lanes, &narrow, sizeof lanes);
            return lanes != 0;
        } else {
            typename PackMask<N / 2>::Vector half[2];
            __builtin_memcpy(half, &a.v, sizeof half);
            return any(PackMask<N / 2>(half[0] | half[1]));
        }
    }
    ARM3R_INLINE friend bool all(const PackMask& a) { return !any(!a); }
};

// The copy constructor is written out so that a Pack travels by address wherever a call is not inlined: then callers
// and callees built for different instruction sets agree. Each operator fills its result in place (README, g++ 4).
template <int N>
struct Pack {
    using Vector = typename Register<double, N>::type;
    using Mask = PackMask<N>;
    using BitVector = typename Mask::Vector;
    Vector v;

    Pack() = default;
    ARM3R_INLINE Pack(const Pack& other) : v(other.v) {}
    ARM3R_INLINE Pack& operator=(const Pack& other) {
        v = other.v;
        return *this;
    }
    ARM3R_INLINE explicit Pack(const Vector& lanes) : v(lanes) {}
    ARM3R_INLINE Pack(double all_lanes) { Register<double, N>::set_all(v, all_lanes); }

    ARM3R_INLINE static Pack load(const double* from) {
        Pack result;
        __builtin_memcpy(&result.v, from, sizeof(Vector));
        return result;
    }
    ARM3R_INLINE void store(double* to) const { __builtin_memcpy(to, &v, sizeof(Vector)); }
    ARM3R_INLINE double operator[](int lane) const { return v[lane]; }
    ARM3R_INLINE void set(int lane, double x) { v[lane] = x; }

    ARM3R_INLINE friend Pack operator+(const Pack& a, const Pack& b) {
        Pack sum;
        sum.v = a.v + b.v;
        return sum;
    }
    ARM3R_INLINE friend Pack operator-(const Pack& a, const Pack& b) {
        Pack difference;
        difference.v = a.v - b.v;
        return difference;
    }
    ARM3R_INLINE friend Pack operator*(const Pack& a, const Pack& b) {
        Pack product;
        product.v = a.v * b.v;
        return product;
    }
    ARM3R_INLINE friend Pack operator/(const Pack& a, const Pack& b) {
        Pack quotient;
        quotient.v = a.v / b.v;
        return quotient;
    }
    ARM3R_INLINE friend Pack operator-(const Pack& a) {
        Pack negative;
        negative.v = -a.v;
        return negative;
    }
    ARM3R_INLINE Pack& operator+=(const Pack& b) {
        v += b.v;
        return *this;
    }
    ARM3R_INLINE Pack& operator-=(const Pack& b) {
        v -= b.v;
        return *this;
    }
    ARM3R_INLINE Pack& operator*=(const Pack& b) {
        v *= b.v;
        return *this;
    }
    ARM3R_INLINE Pack& operator/=(const Pack& b) {
        v /= b.v;
        return *this;
    }

    ARM3R_INLINE friend Mask operator<(const Pack& a, const Pack& b) { return where(a.v < b.v); }
    ARM3R_INLINE friend Mask operator>(const Pack& a, const Pack& b) { return where(a.v > b.v); }
    ARM3R_INLINE friend Mask operator<=(const Pack& a, const Pack& b) { return where(a.v <= b.v); }
    ARM3R_INLINE friend Mask operator>=(const Pack& a, const Pack& b) { return where(a.v >= b.v); }
    ARM3R_INLINE friend Mask operator==(const Pack& a, const Pack& b) { return where(a.v == b.v); }
    ARM3R_INLINE friend Mask operator!=(const Pack& a, const Pack& b) { return where(a.v != b.v); }

    ARM3R_INLINE friend Pack select(const Mask& mask, const Pack& a, const Pack& b) {
        Pack chosen;
        chosen.v = mask.v ? a.v : b.v;
        return chosen;
    }
    ARM3R_INLINE friend Pack min(const Pack& a, const Pack& b) {
        Pack least;
        least.v = b.v < a.v ? b.v : a.v;
        return least;
    }
    ARM3R_INLINE friend Pack max(const Pack& a, const Pack& b) {
        Pack greatest;
        greatest.v = a.v < b.v ? b.v : a.v;
        return greatest;
    }

    template <class F>
    ARM3R_INLINE friend Pack with_bits(const Pack& x, F f) {
        auto i = (BitVector)x.v;
        f(i);
        return Pack((Vector)i);
    }
    ARM3R_INLINE friend Pack abs(const Pack& x) { return Pack((Vector)((BitVector)x.v & ~sign_bit)); }
    ARM3R_INLINE friend Pack copysign(const Pack& magnitude, const Pack& sign) {
        return Pack((Vector)(((BitVector)magnitude.v & ~sign_bit) | ((BitVector)sign.v & sign_bit)));
    }
    // Where there is no function for the roots of a vector, a marked loop takes them side by side (README, g++ 5).
    ARM3R_INLINE friend Pack sqrt(const Pack& x) {
#if __has_builtin(__builtin_elementwise_sqrt)
        return Pack(__builtin_elementwise_sqrt(x.v));
#else
        alignas(Vector) double root[N];
        x.store(root);
#if defined(ARM3R_MARKED_LOOPS)  // by a build with -fopenmp-simd
#pragma omp simd simdlen(N)
#endif
        for (int lane = 0; lane < N; ++lane) root[lane] = __builtin_sqrt(root[lane]);
        return load(root);
#endif
    }

private:
    static constexpr std::int64_t sign_bit = INT64_MIN;

    // A choice between numbers, and no bare comparison (README, g++ 3).
    template <class Comparison>
    ARM3R_INLINE static Mask where(const Comparison& holds) {
        if constexpr (N < 8) return Mask(holds);
        const Vector all_bits = (Vector)(BitVector{} - std::int64_t{1});
        return Mask((BitVector)(holds ? all_bits : Vector{}));
    }
};

static_assert(Real<Pack<2>> && Real<Pack<8>>);

ARM3R_INLINE Pack<2> side_by_side(double first, double second) { return Pack<2>(Pack<2>::Vector{first, second}); }

// Two halves, which are put together in registers (README, g++ 1).
ARM3R_INLINE Pack<4> side_by_side(double first, double second, double third, double fourth) {
#if __has_builtin(__builtin_shufflevector)
    const Pack<2>::Vector low{first, second}, high{third, fourth};
    return Pack<4>(__builtin_shufflevector(low, high, 0, 1, 2, 3));
#else
    return Pack<4>(Pack<4>::Vector{first, second, third, fourth});
#endif
}

ARM3R_INLINE std::array<SinCos<double>, 2> split(const SinCos<Pack<2>>& both) {
    return {SinCos<double>{both.sin[0], both.cos[0]}, SinCos<double>{both.sin[1], both.cos[1]}};
}

// sincos and sincos_near of two angles: for doubles in one register, in little more time than that of one angle.
template <class T>
ARM3R_INLINE std::array<SinCos<T>, 2> sincos_pair(const T& first, const T& second) {
    return {sincos(first), sincos(second)};
}

ARM3R_INLINE std::array<SinCos<double>, 2> sincos_pair(double first, double second) {
    return split(sincos(side_by_side(first, second)));
}

template <class T>
ARM3R_INLINE std::array<SinCos<T>, 2> sincos_near_pair(const T& first_base, const SinCos<T>& at_first, const T& first,
                                                       const T& second_base, const SinCos<T>& at_second,
                                                       const T& second) {
    return {sincos_near(first_base, at_first, first), sincos_near(second_base, at_second, second)};
}

ARM3R_INLINE std::array<SinCos<double>, 2> sincos_near_pair(double first_base, const SinCos<double>& at_first,
                                                            double first, double second_base,
                                                            const SinCos<double>& at_second, double second) {
    const SinCos<Pack<2>> bases{side_by_side(at_first.sin, at_second.sin), side_by_side(at_first.cos, at_second.cos)};
    return split(sincos_near(side_by_side(first_base, second_base), bases, side_by_side(first, second)));
}

}  // namespace arm3r
