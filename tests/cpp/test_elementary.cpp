#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "arm3r/numbers/real.hpp"
#include "check.hpp"

namespace arm3r {

// Accuracy over the whole range is measured by tests/python/model/test_elementary_ulp.py.
TEST_SUITE(elementary)

static bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

static const double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST_CASE(sincos_is_exact_at_zero_and_keeps_its_sign) {
    for (const double zero : {0.0, -0.0}) {
        const auto [sine, cosine] = sincos(zero);
        CHECK(same_bits(sine, zero));
        CHECK(cosine == 1.0);
    }
}

TEST_CASE(sincos_is_odd_and_even_bit_for_bit) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> angle(0.0, 1e5);
    for (int i = 0; i < 100000; ++i) {
        const double x = angle(random);
        const auto forth = sincos(x), back = sincos(-x);
        REQUIRE((same_bits(back.sin, -forth.sin) && same_bits(back.cos, forth.cos)));
    }
}

TEST_CASE(sincos_near_is_within_4e_16_inside_and_outside_its_reach) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> angle(-10.0, 10.0), step(-0.05, 0.05);
    for (int i = 0; i < 100000; ++i) {
        const double base = angle(random), x = base + step(random);
        const auto near = sincos_near(base, sincos(base), x);
        const auto full = sincos(x);
        REQUIRE(std::abs(near.sin - full.sin) < 4e-16);
        REQUIRE(std::abs(near.cos - full.cos) < 4e-16);
        if (std::abs(x - base) > sincos_near_limit) REQUIRE(same_bits(near.sin, full.sin));
    }
}

TEST_CASE(ends_of_the_ranges) {
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(tanh(infinity) == 1.0);
    CHECK(tanh(-infinity) == -1.0);
    CHECK(same_bits(tanh(-0.0), -0.0));
    CHECK(acos(1.0) == 0.0);
    CHECK(acos(-1.0) == M_PI);
    CHECK(acos(0.0) == M_PI / 2);
    CHECK(hypot2(3.0, -4.0) == 5.0);
    CHECK(fifth_root(1.0) == 1.0);
    CHECK(fifth_root(0.0) < 1e-60);
    CHECK(exp(0.0) == 1.0);
    CHECK(exp(-infinity) == 0.0);
    CHECK(exp(-746.0) == 0.0);
    CHECK(exp(-745.0) == 5e-324);
    CHECK(exp(709.0) == 8.218407461554972e307);
    CHECK(exp(709.8) == infinity);
    CHECK(exp(infinity) == infinity);
    CHECK(same_bits(log(1.0), 0.0));
    CHECK(log(0.0) == -infinity);
    CHECK(log(-0.0) == -infinity);
    CHECK(log(infinity) == infinity);
    CHECK(log(5e-324) == log(0x1p-1022));
}

TEST_CASE(power_at_the_ends_of_its_range) {
    for (const double p : {0.5, 1.0, 1.5, 3.0}) {
        CHECK(same_bits(power(0.0, p), 0.0));
        CHECK(same_bits(power(-0.0, p), 0.0));
        CHECK(same_bits(power(-2.0, p), 0.0));
        CHECK(power(1.0, p) == 1.0);
        CHECK(power(4.0, p) == std::pow(4.0, p));
    }
    CHECK(power(5e-324, 1.5) == 0.0);
    CHECK(power(1e300, 3.0) == std::numeric_limits<double>::infinity());
}

TEST_CASE(first_power_is_the_number_itself) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 100000; ++i) {
        const double x = std::bit_cast<double>(random() % 0x7ff0000000000000);
        REQUIRE(same_bits(power(x, 1.0), x));
    }
}

TEST_CASE(powers_rise_with_the_number_and_with_the_exponent) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> exponent(1.0, 3.0), decade(-12.0, 3.0);
    for (int i = 0; i < 100000; ++i) {
        const double x = std::pow(10.0, decade(random)), p = exponent(random);
        REQUIRE(power(x, p) <= power(x * (1.0 + 4e-16), p));
        REQUIRE((power(x, p) < power(x, p + 1e-9)) == (x > 1.0));
    }
}

TEST_CASE(not_a_number_stays_one) {
    CHECK(std::isnan(sincos(not_a_number).sin));
    CHECK(std::isnan(sincos(not_a_number).cos));
    CHECK(std::isnan(tanh(not_a_number)));
    CHECK(std::isnan(atan2(not_a_number, 1.0)));
    CHECK(std::isnan(atan2(1.0, not_a_number)));
    CHECK(std::isnan(atan2(not_a_number, not_a_number)));
    CHECK(std::isnan(acos(1.5)));
    CHECK(std::isnan(fifth_root(not_a_number)));
    CHECK(std::isnan(exp(not_a_number)));
    CHECK(std::isnan(log(not_a_number)));
    CHECK(std::isnan(log(-1.0)));
    CHECK(std::isnan(log(-std::numeric_limits<double>::infinity())));
    CHECK(std::isnan(power(not_a_number, 1.0)));
    CHECK(std::isnan(power(not_a_number, 1.5)));
    CHECK(std::isnan(power(2.0, not_a_number)));
}

TEST_SUITE_END()

}  // namespace arm3r
