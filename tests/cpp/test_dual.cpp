#include <cmath>
#include <functional>
#include <random>

#include "arm3r/numbers/eigen_traits.hpp"
#include "check.hpp"

namespace arm3r {

TEST_SUITE(dual)

using Two = Dual<2>;

// Checks f's value bits against f(double) and its slopes against central differences, at random points.
template <class F>
static void check(F f, double low, double high) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> unit(low, high);
    for (int i = 0; i < 1000; ++i) {
        const double x = unit(random), y = unit(random), h = 1e-5 * (1.0 + std::abs(x) + std::abs(y));
        const Two result = f(Two::variable(x, 0), Two::variable(y, 1));
        const double by_x = (f(x + h, y) - f(x - h, y)) / (2.0 * h);
        const double by_y = (f(x, y + h) - f(x, y - h)) / (2.0 * h);
        CHECK(value(result) == f(x, y));
        CHECK(std::abs(result.slope[0] - by_x) <= 1e-6 * (1.0 + std::abs(by_x)));
        CHECK(std::abs(result.slope[1] - by_y) <= 1e-6 * (1.0 + std::abs(by_y)));
    }
}

TEST_CASE(arithmetic) {
    check([](auto x, auto y) { return (2.0 * x - y * 3.0 + 1.0) * (x / (y + 4.0)) - -y / 2.0; }, -2.0, 2.0);
    check(
        [](auto x, auto y) {
            x += y;
            x *= y;
            x -= 2.0;
            x /= y + 5.0;
            return x;
        },
        -2.0, 2.0);
}

TEST_CASE(elementary_functions) {
    check(
        [](auto x, auto y) {
            const auto [s, c] = sincos(x * y);
            return s + 2.0 * c;
        },
        -3.0, 3.0);
    check([](auto x, auto y) { return tanh(x) * tanh(y); }, -3.0, 3.0);
    check([](auto x, auto y) { return atan2(y, x); }, 0.5, 3.0);
    check([](auto x, auto y) { return atan2(-y, -x); }, 0.5, 3.0);
    check([](auto x, auto y) { return acos(x * y); }, -0.9, 0.9);
    check([](auto x, auto y) { return hypot2(x, y) + sqrt(x) + fifth_root(y); }, 0.5, 3.0);
    check([](auto x, auto y) { return exp(x - y) * log(y); }, 0.5, 3.0);
    check([](auto x, auto y) { return power(x, y); }, 0.5, 3.0);
    check([](auto x, auto y) { return power(x, 1.5) - power(2.0, y); }, 0.1, 3.0);
    check([](auto x, auto y) { return power(x, 1.0) + power(y, 1.0); }, 0.1, 3.0);
    check([](auto x, auto y) { return power(x, 1.5) + power(x, 1.0) + y; }, -3.0, -0.1);
}

TEST_CASE(power_has_a_finite_slope_at_zero) {
    for (const auto& [exponent, slope] : {std::pair{1.0, 1.0}, {1.0 + 1e-15, 0.0}, {1.5, 0.0}, {2.0, 0.0}, {3.0, 0.0}})
        for (const double zero : {0.0, -0.0}) {
            const Two result = power(Two::variable(zero, 0), Two::variable(exponent, 1));
            CHECK(result.number == 0.0);
            CHECK(result.slope[0] == slope);
            CHECK(result.slope[1] == 0.0);
        }
}

TEST_CASE(choices_follow_the_chosen_branch) {
    check([](auto x, auto y) { return select(y > -2.0, x * y, x + y) + select(x < -2.0, x, y * y); }, -1.0, -0.1);
    check([](auto x, auto y) { return min(x, -y) - max(x * x, y + 10.0); }, -1.0, -0.1);
    check([](auto x, auto y) { return abs(x) + 2.0 * copysign(y, -x); }, -2.0, -0.1);
    check([](auto x, auto y) { return abs(x) + 2.0 * copysign(y, -x); }, 0.1, 2.0);
}

TEST_CASE(sincos_near_carries_the_slopes_through_the_rotation) {
    for (const double step : {0.01, 0.05}) {
        const auto f = [step](auto x, auto y) {
            const auto angle = x * y;
            const auto [s, c] = sincos_near(x, sincos(x), decltype(angle)(x + step * y));
            return s + 2.0 * c;
        };
        check(f, 0.1, 1.0);
    }
}

TEST_CASE(is_a_scalar_of_eigen) {
    const Eigen::Matrix<Two, 3, 1> v(Two::variable(3.0, 0), Two::variable(4.0, 1), Two(12.0));
    const Two length = v.norm();
    CHECK(length.number == 13.0);
    CHECK_CLOSE(length.slope[0], 3.0 / 13.0, 1e-15);
    CHECK((Eigen::Matrix3d::Identity() * v)[1].slope[1] == 1.0);
}

TEST_SUITE_END()

}  // namespace arm3r
