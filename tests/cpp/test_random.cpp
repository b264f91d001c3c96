#include <cmath>
#include <vector>

#include "arm3r/numbers/random.hpp"
#include "check.hpp"

namespace arm3r {

TEST_SUITE(random_numbers)

using Numbers = std::vector<double>;
using Words = std::array<std::uint32_t, 4>;

static constexpr int count = 1 << 18;
static constexpr double expected_spread = 1.0 / 512;  // of the mean of that many numbers of variance 1

template <class F>
static Numbers drawn(F f) {
    Numbers x(count);
    for (int i = 0; i < count; ++i) x[std::size_t(i)] = f(std::uint64_t(i));
    return x;
}
static Numbers normals(std::uint64_t seed, std::uint32_t stream) {
    return drawn([=](std::uint64_t i) { return standard_normal(seed, stream, i); });
}
// Uniform, moved and stretched to mean 0 and variance 1.
static Numbers uniforms(std::uint64_t seed, std::uint32_t stream) {
    return drawn([=](std::uint64_t i) { return (uniform(seed, stream, i) - 0.5) * std::sqrt(12.0); });
}

// The mean of f over the numbers, in units of what chance leaves of it where each f has mean 0 and variance 1.
template <class F>
static double deviation(F f) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += f(i);
    return sum / count / expected_spread;
}
static double correlation(const Numbers& x, const Numbers& y, std::size_t lag) {
    return deviation([&](std::size_t i) { return x[i] * y[(i + lag) % count]; });
}

// A test of 64 bins of equal probability: mean 63, standard deviation 11.2.
static double chi_square(const Numbers& probabilities) {
    int hits[64] = {};
    for (const double p : probabilities) ++hits[int(64 * p)];
    double sum = 0;
    for (const int n : hits) sum += (n - count / 64.0) * (n - count / 64.0) / (count / 64.0);
    return sum;
}

// The known answers that come with the authors' Random123.
TEST_CASE(philox_gives_the_published_answers) {
    CHECK((philox({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    CHECK((philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
           Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    CHECK((philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
           Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

// The bits are those of randomgen.Philox(counter=counter + 2^64 stream, key=seed, number=4, width=32), the rest follows
// from them in 40-digit arithmetic.
TEST_CASE(every_bit_of_seed_stream_and_counter_has_its_place) {
    const struct {
        std::uint64_t seed;
        std::uint32_t stream;
        std::uint64_t counter, bits;
        double uniform, normal;
    } known[] = {
        {0, 0, 0, 0xe169c58d6627e8d5, 0.8805201978886142, -0.39766753844418234},
        {1, 0, 0, 0xe50a0ebce3e80670, 0.8946847163350925, -0.11368019704496898},
        {0, 1, 0, 0xf08d6eaa844515e1, 0.939658085470246, -0.35114099469195015},
        {0, 0, 1, 0x5cb200dbf8e4cca4, 0.36209111566940344, 1.3868444271028377},
        {0x100000000, 0, 0, 0xfa7e58b6fdde3e0b, 0.978490395236684, 0.1193806046722776},
        {0, 0, 0x100000000, 0xea2362496ad0c5ec, 0.9146024159661607, 0.41579172862720515},
        {0x123456789abcdef, 0xfedcba98, 0xf1e2d3c4b5a6978, 0x4650d13f73f196c8, 0.2746706752695388, 1.4880586073826723},
        {UINT64_MAX, UINT32_MAX, UINT64_MAX, 0xe4c1e0f1eec03824, 0.89358335405882, -0.3349665017119171},
    };
    for (const auto& k : known) {
        CHECK(random_bits(k.seed, k.stream, k.counter) == k.bits);
        CHECK(uniform(k.seed, k.stream, k.counter) == k.uniform);
        CHECK(std::abs(standard_normal(k.seed, k.stream, k.counter) - k.normal) < 4e-15);
    }
}

TEST_CASE(uniform_is_never_0_or_1_and_uses_53_bits) {
    CHECK(open_unit(0) == 0x1p-53);
    CHECK(open_unit(UINT64_MAX) == 1.0 - 0x1p-53);
    CHECK(open_unit(UINT64_MAX / 2) == 0.5 - 0x1p-53);
    CHECK(open_unit(UINT64_MAX / 2 + 1) == 0.5 + 0x1p-53);
    CHECK(open_unit(1 << 12) == 0x3p-53);
}

TEST_CASE(box_muller_reaches_the_tails_and_the_middle) {
    CHECK(std::abs(box_muller(0x1p-53, 0.5) + 8.571674348652905) < 4e-15);
    CHECK(std::abs(box_muller(1.0 - 0x1p-53, 0x1p-53) - 0x1p-26) < 1e-22);
    CHECK(std::abs(box_muller(std::exp(-2.0), 1.0 / 3) + 1.0) < 1e-15);
    CHECK(std::abs(box_muller(0.3, 0.25)) < 1e-15);
}

TEST_CASE(each_of_the_64_bits_is_set_half_the_time) {
    int set[64] = {};
    for (int i = 0; i < count; ++i)
        for (int bit = 0; bit < 64; ++bit) set[bit] += random_bits(11, 3, std::uint64_t(i)) >> bit & 1;
    for (const int n : set) CHECK(std::abs(n - count / 2) < 4 * 256);  // 256 = sqrt(count)/2
}

TEST_CASE(moments_of_the_uniform) {
    const Numbers x = uniforms(1, 0);
    CHECK(std::abs(deviation([&](std::size_t i) { return x[i]; })) < 4);
    CHECK(std::abs(deviation([&](std::size_t i) { return (x[i] * x[i] - 1) / std::sqrt(4.0 / 5); })) < 4);
}

TEST_CASE(moments_of_the_normal) {
    const Numbers x = normals(2, 0);
    const auto moment = [&](int k, double mean, double variance) {
        return deviation([&](std::size_t i) { return (std::pow(x[i], k) - mean) / std::sqrt(variance); });
    };
    CHECK(std::abs(moment(1, 0, 1)) < 4);
    CHECK(std::abs(moment(2, 1, 2)) < 4);
    CHECK(std::abs(moment(3, 0, 15)) < 4);
    CHECK(std::abs(moment(4, 3, 96)) < 4);
}

TEST_CASE(chi_square_is_neither_too_large_nor_too_small) {
    for (std::uint32_t stream = 0; stream < 8; ++stream) {
        const Numbers flat = drawn([=](std::uint64_t i) { return uniform(3, stream, i); });
        const Numbers bell =
            drawn([=](std::uint64_t i) { return 0.5 * std::erfc(-standard_normal(3, stream, i) * M_SQRT1_2); });
        for (const Numbers& p : {flat, bell}) {
            CHECK(chi_square(p) < 63 + 4 * 11.2);
            CHECK(chi_square(p) > 63 - 3.5 * 11.2);
        }
    }
}

TEST_CASE(a_number_is_independent_of_the_next_ones) {
    for (const Numbers& x : {uniforms(4, 5), normals(4, 5)})
        for (std::size_t lag = 1; lag <= 32; ++lag) CHECK(std::abs(correlation(x, x, lag)) < 4.5, "lag " << lag);
}

TEST_CASE(neighbouring_streams_and_seeds_are_independent) {
    const Numbers x = normals(6, 0);
    for (std::uint32_t i = 1; i <= 8; ++i)
        for (const Numbers& y : {normals(6, i), normals(6 + i, 0), normals(6 ^ 0x100000000 * i, 0)})
            for (std::size_t lag = 0; lag < 3; ++lag) CHECK(std::abs(correlation(x, y, lag)) < 4.5);
}

TEST_SUITE_END()

}  // namespace arm3r
