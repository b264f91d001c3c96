#include <bit>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "arm3r/numbers/real.hpp"

namespace arm3r {

// Accuracy over the whole range is measured by tests/python/test_elementary_ulp.py.
BOOST_AUTO_TEST_SUITE(elementary)

static bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

static const double not_a_number = std::numeric_limits<double>::quiet_NaN();

BOOST_AUTO_TEST_CASE(sincos_is_exact_at_zero_and_keeps_its_sign) {
    for (const double zero : {0.0, -0.0}) {
        const auto [sine, cosine] = sincos(zero);
        BOOST_TEST(same_bits(sine, zero));
        BOOST_TEST(cosine == 1.0);
    }
}

BOOST_AUTO_TEST_CASE(sincos_is_odd_and_even_bit_for_bit) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> angle(0.0, 1e5);
    for (int i = 0; i < 100000; ++i) {
        const double x = angle(random);
        const auto forth = sincos(x), back = sincos(-x);
        BOOST_REQUIRE(same_bits(back.sin, -forth.sin) && same_bits(back.cos, forth.cos));
    }
}

BOOST_AUTO_TEST_CASE(sincos_near_is_within_4e_16_inside_and_outside_its_reach) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> angle(-10.0, 10.0), step(-0.05, 0.05);
    for (int i = 0; i < 100000; ++i) {
        const double base = angle(random), x = base + step(random);
        const auto near = sincos_near(base, sincos(base), x);
        const auto full = sincos(x);
        BOOST_REQUIRE_SMALL(near.sin - full.sin, 4e-16);
        BOOST_REQUIRE_SMALL(near.cos - full.cos, 4e-16);
        if (std::abs(x - base) > sincos_near_limit) BOOST_REQUIRE(same_bits(near.sin, full.sin));
    }
}

BOOST_AUTO_TEST_CASE(ends_of_the_ranges) {
    const double infinity = std::numeric_limits<double>::infinity();
    BOOST_TEST(tanh(infinity) == 1.0);
    BOOST_TEST(tanh(-infinity) == -1.0);
    BOOST_TEST(same_bits(tanh(-0.0), -0.0));
    BOOST_TEST(acos(1.0) == 0.0);
    BOOST_TEST(acos(-1.0) == M_PI);
    BOOST_TEST(acos(0.0) == M_PI / 2);
    BOOST_TEST(hypot2(3.0, -4.0) == 5.0);
    BOOST_TEST(fifth_root(1.0) == 1.0);
    BOOST_TEST(fifth_root(0.0) < 1e-60);
    BOOST_TEST(exp(0.0) == 1.0);
    BOOST_TEST(exp(-infinity) == 0.0);
    BOOST_TEST(exp(-746.0) == 0.0);
    BOOST_TEST(exp(-745.0) == 5e-324);
    BOOST_TEST(exp(709.0) == 8.218407461554972e307);
    BOOST_TEST(exp(709.8) == infinity);
    BOOST_TEST(exp(infinity) == infinity);
    BOOST_TEST(same_bits(log(1.0), 0.0));
    BOOST_TEST(log(0.0) == -infinity);
    BOOST_TEST(log(-0.0) == -infinity);
    BOOST_TEST(log(infinity) == infinity);
    BOOST_TEST(log(5e-324) == log(0x1p-1022));
}

BOOST_AUTO_TEST_CASE(power_at_the_ends_of_its_range) {
    for (const double p : {0.5, 1.0, 1.5, 3.0}) {
        BOOST_TEST(same_bits(power(0.0, p), 0.0));
        BOOST_TEST(same_bits(power(-0.0, p), 0.0));
        BOOST_TEST(same_bits(power(-2.0, p), 0.0));
        BOOST_TEST(power(1.0, p) == 1.0);
        BOOST_TEST(power(4.0, p) == std::pow(4.0, p));
    }
    BOOST_TEST(power(5e-324, 1.5) == 0.0);
    BOOST_TEST(power(1e300, 3.0) == std::numeric_limits<double>::infinity());
}

BOOST_AUTO_TEST_CASE(first_power_is_the_number_itself) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 100000; ++i) {
        const double x = std::bit_cast<double>(random() % 0x7ff0000000000000);
        BOOST_REQUIRE(same_bits(power(x, 1.0), x));
    }
}

BOOST_AUTO_TEST_CASE(powers_rise_with_the_number_and_with_the_exponent) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> exponent(1.0, 3.0), decade(-12.0, 3.0);
    for (int i = 0; i < 100000; ++i) {
        const double x = std::pow(10.0, decade(random)), p = exponent(random);
        BOOST_REQUIRE(power(x, p) <= power(x * (1.0 + 4e-16), p));
        BOOST_REQUIRE((power(x, p) < power(x, p + 1e-9)) == (x > 1.0));
    }
}

BOOST_AUTO_TEST_CASE(not_a_number_stays_one) {
    BOOST_TEST(std::isnan(sincos(not_a_number).sin));
    BOOST_TEST(std::isnan(sincos(not_a_number).cos));
    BOOST_TEST(std::isnan(tanh(not_a_number)));
    BOOST_TEST(std::isnan(atan2(not_a_number, 1.0)));
    BOOST_TEST(std::isnan(atan2(1.0, not_a_number)));
    BOOST_TEST(std::isnan(atan2(not_a_number, not_a_number)));
    BOOST_TEST(std::isnan(acos(1.5)));
    BOOST_TEST(std::isnan(fifth_root(not_a_number)));
    BOOST_TEST(std::isnan(exp(not_a_number)));
    BOOST_TEST(std::isnan(log(not_a_number)));
    BOOST_TEST(std::isnan(log(-1.0)));
    BOOST_TEST(std::isnan(log(-std::numeric_limits<double>::infinity())));
    BOOST_TEST(std::isnan(power(not_a_number, 1.0)));
    BOOST_TEST(std::isnan(power(not_a_number, 1.5)));
    BOOST_TEST(std::isnan(power(2.0, not_a_number)));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace arm3r
