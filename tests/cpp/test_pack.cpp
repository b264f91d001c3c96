#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/numbers/widths.hpp"
#include "check.hpp"

namespace arm3r {

TEST_SUITE(pack)

static constexpr int results_per_input = 23;

template <class T>
ARM3R_INLINE void every_function(const T& x, const T& y, T* out) {
    const auto full = sincos(x);
    const auto near = sincos_near(y, sincos(y), T(y + 0.06 * tanh(x)));
    const auto rotated = sincos_rotated(full, T(0.03 * tanh(y)));
    const T results[results_per_input] = {full.sin,
                                          full.cos,
                                          near.sin,
                                          near.cos,
                                          rotated.sin,
                                          rotated.cos,
                                          tanh(y),
                                          atan2(y, x),
                                          acos(x),
                                          hypot2(x, y),
                                          sqrt(abs(x)),
                                          min(x, y),
                                          max(x, y),
                                          copysign(x, y),
                                          fifth_root(abs(y) + 1e-300),
                                          exp(x),
                                          log(x),
                                          power(x, y),
                                          power(abs(x), 1.5),
                                          x + 2.0 * y,
                                          x / (1.0 - y),
                                          -x,
                                          select((x < y && !(y <= T(0.0))) || x == y, x, y)};
    for (int k = 0; k < results_per_input; ++k) out[k] = results[k];
}

using Run = void (*)(const double* x, const double* y, double* out);

template <int N>
ARM3R_INLINE void run_lanes(const double* x, const double* y, double* out) {
    Pack<N> results[results_per_input];
    every_function(Pack<N>::load(x), Pack<N>::load(y), results);
    for (int k = 0; k < results_per_input; ++k) results[k].store(out + k * N);
}

template <int N>
void baseline(const double* x, const double* y, double* out) {
    run_lanes<N>(x, y, out);
}
#ifdef __x86_64__
template <int N>
__attribute__((target("avx2"))) void avx2(const double* x, const double* y, double* out) {
    run_lanes<N>(x, y, out);
}
template <int N>
__attribute__((target("avx512f"))) void avx512(const double* x, const double* y, double* out) {
    run_lanes<N>(x, y, out);
}
#endif

struct Variant {
    const char* name;
    int lanes;
    Run run;
};

static std::vector<Variant> variants() {
    std::vector<Variant> all{{"baseline", 2, baseline<2>},
                             {"baseline", 4, baseline<4>},
                             {"baseline", 8, baseline<8>},
                             {"baseline", 16, baseline<16>}};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2"))
        all.insert(all.end(), {{"avx2", 2, avx2<2>}, {"avx2", 4, avx2<4>}, {"avx2", 8, avx2<8>}});
    if (__builtin_cpu_supports("avx512f"))
        all.insert(all.end(), {{"avx512", 2, avx512<2>}, {"avx512", 4, avx512<4>}, {"avx512", 8, avx512<8>}});
#endif
    return all;
}

// Ordinary angles, the whole range, every exponent, edges of quadrants, special values: so that lanes differ.
static std::vector<double> inputs(std::size_t count) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0), exponent(-300.0, 300.0);
    const double special[] = {0.0,
                              -0.0,
                              1.0,
                              -1.0,
                              M_PI,
                              -M_PI_2,
                              5e-324,
                              -1e-310,
                              1e300,
                              -1e300,
                              0.03,
                              std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()};
    std::vector<double> x(count);
    for (std::size_t i = 0; i < count; ++i) {
        switch (random() % 6) {
            case 0: x[i] = special[random() % std::size(special)]; break;
            case 1: x[i] = std::nextafter(M_PI_4 * double(random() % 120000), unit(random) < 0 ? -1e9 : 1e9); break;
            case 2: x[i] = std::copysign(std::pow(10.0, exponent(random)), unit(random)); break;
            case 3: x[i] = 1e5 * unit(random); break;
            case 4: x[i] = unit(random); break;
            default: x[i] = 10.0 * unit(random);
        }
    }
    return x;
}

static bool same(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

// How many results of one pack differ from those of its lanes in double.
static std::size_t differing(const Variant& variant, const double* x, const double* y,
                             const double (*expected)[results_per_input]) {
    double out[results_per_input * 16];
    variant.run(x, y, out);
    std::size_t count = 0;
    for (int lane = 0; lane < variant.lanes; ++lane)
        for (int k = 0; k < results_per_input; ++k) count += !same(out[k * variant.lanes + lane], expected[lane][k]);
    return count;
}

TEST_CASE(each_lane_equals_the_double_bit_for_bit_on_1e6_values) {
    constexpr std::size_t count = 1 << 20, widest = 16;
    const std::vector<double> x = inputs(count + 1), y(x.rbegin(), x.rend());
    const std::vector<Variant> all = variants();
    std::vector<std::size_t> differences(all.size());
    for (std::size_t i = 0; i < count; i += widest) {
        double expected[widest][results_per_input];
        for (std::size_t j = 0; j < widest; ++j) every_function(x[i + j], y[i + j], expected[j]);
        for (std::size_t v = 0; v < all.size(); ++v)
            for (std::size_t j = 0; j < widest; j += std::size_t(all[v].lanes))
                differences[v] += differing(all[v], &x[i + j], &y[i + j], expected + j);
    }
    for (std::size_t v = 0; v < all.size(); ++v)
        CHECK(differences[v] == 0u,
              all[v].name << " with " << all[v].lanes << " lanes differs in " << differences[v] << " results");
}

TEST_CASE(sincos_pair_equals_two_single_calls) {
    const std::vector<double> x = inputs(100001);
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        const auto [first, second] = sincos_pair(x[i], x[i + 1]);
        const auto a = sincos(x[i]), b = sincos(x[i + 1]);
        REQUIRE((same(first.sin, a.sin) && same(first.cos, a.cos)));
        REQUIRE((same(second.sin, b.sin) && same(second.cos, b.cos)));
    }
}

TEST_CASE(any_and_all_look_at_every_lane) {
    for (int lane = 0; lane < 8; ++lane) {
        Pack<8> x(0.0);
        x.set(lane, 1.0);
        CHECK(any(x > Pack<8>(0.5)));
        CHECK(!all(x > Pack<8>(0.5)));
        CHECK((x > Pack<8>(0.5))[lane]);
    }
    CHECK(all(Pack<8>(1.0) > Pack<8>(0.5)));
    CHECK(!any(Pack<8>(1.0) < Pack<8>(0.5)));
    CHECK(all(PackMask<4>(true)));
    CHECK(!any(PackMask<4>(false)));
}

// In functions for the registers of a mask, as any() and all() say elsewhere.
template <class T>
static void check_lane_tests() {
    using Mask = typename Lanes<T>::Mask;
    constexpr int lanes = Lanes<T>::count;
    for (int pattern = 0; pattern < 1 << lanes; ++pattern) {
        Mask mask = false;
        for (int lane = 0; lane < lanes; ++lane) Lanes<T>::mark(mask, lane, (pattern >> lane & 1) != 0);
        bool in_any = false, in_all = false;
        Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { in_any = in_any_lane(mask), in_all = in_all_lanes(mask); });
        CHECK(in_any == (pattern != 0), lanes << " lanes, pattern " << pattern);
        CHECK(in_all == (pattern == (1 << lanes) - 1), lanes << " lanes, pattern " << pattern);
    }
}

TEST_CASE(lane_tests_look_at_every_lane) {
    check_lane_tests<double>();
#define ARM3R_CHECK(T) \
    if (has_registers_for(Lanes<T>::count)) check_lane_tests<T>();
    ARM3R_PACKS(ARM3R_CHECK)
#undef ARM3R_CHECK
}

template <class T>
static void check_marked_lanes() {
    typename Lanes<T>::Mask mask = true;
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        Lanes<T>::mark(mask, lane, false);
        for (int other = 0; other < Lanes<T>::count; ++other)
            CHECK(Lanes<T>::is(mask, other) == (other > lane), "lane " << other);
    }
    CHECK(!any(mask));
    Lanes<T>::mark(mask, Lanes<T>::count - 1, true);
    CHECK(any(mask));
}

TEST_CASE(a_lane_is_marked_alone) {
    check_marked_lanes<double>(), check_marked_lanes<Pack<2>>();
    check_marked_lanes<Pack<4>>(), check_marked_lanes<Pack<8>>();
}

TEST_CASE(a_broadcast_keeps_the_sign_of_zero) {
    CHECK(std::signbit(Pack<4>(-0.0)[3]));
    CHECK(!std::signbit(Pack<4>(0.0)[3]));
}

template <class T>
static T eigen_formula(const T& x, const T& y) {
    Eigen::Matrix<T, 3, 3> m = Eigen::Matrix<T, 3, 3>::Identity() * 2.0;
    m(0, 1) = x;
    m(1, 2) = y;
    const Eigen::Matrix<T, 3, 1> v = m * Eigen::Matrix<T, 3, 1>(x, y, T(1.0)) + 0.5 * m.col(1);
    return v.dot(m.transpose() * v) / v.norm() + (Eigen::Matrix3d::Identity() * v).sum();
}

TEST_CASE(eigen_matrices_of_packs_round_like_those_of_doubles) {
    Pack<4> x(0.0), y(0.0);
    for (int lane = 0; lane < 4; ++lane) {
        x.set(lane, 0.3 + lane);
        y.set(lane, 0.7 - 2 * lane);
    }
    const Pack<4> result = eigen_formula(x, y);
    for (int lane = 0; lane < 4; ++lane) CHECK(result[lane] == eigen_formula(x[lane], y[lane]));
}

TEST_SUITE_END()

}  // namespace arm3r
