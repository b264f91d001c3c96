
#include "check.hpp"
#include "fixtures.hpp"
#include "run/scalar_search.hpp"

namespace arm3r {

TEST_SUITE(scalar_searches)

namespace {

// A bracket in [0, 1] and a place within it.
struct Place {
    double a, b, at;
};

Place random_place(Random& random) {
    const double a = random.in(0, 0.4), b = random.in(0.6, 1);
    return {a, b, random.in(a, b)};
}

using scalar_search::maximum_resolution, scalar_search::zero_resolution;

constexpr int sections = 29, halvings = 40;  // what golden sections and halves alone take

// The places where the search begins are known to who searches.
template <class F>
Maximum maximum_of(F f, double a, double b, double noise = 0) {
    const double middle = 0.5 * (a + b);
    return find_maximum(f, {a, f(a)}, {middle, f(middle)}, {b, f(b)}, noise);
}
template <class F>
double zero_of(F f, double a, double b) {
    return find_zero(f, {a, f(a)}, {b, f(b)});
}

}  // namespace

TEST_CASE(a_smooth_maximum_is_found_in_less_than_half_of_the_sections) {
    Random random(91);
    int calls = 0, searches = 0;
    for (; searches < 2000; ++searches) {
        const auto [a, b, at] = random_place(random);
        const double width = random.in(0.2, 2), height = random.in(-3, 3), lean = random.in(-0.3, 0.3);
        const int before = calls;
        const auto f = [&, top = at](double x) {
            ++calls;
            const double u = (x - top) / width;
            return height - u * u * (1 + lean * u) / (1 + u * u);
        };
        const Maximum most = maximum_of(f, a, b);
        CHECK(std::abs(most.position - at) <= 2 * maximum_resolution);
        CHECK(most.value == f(most.position));
        CHECK(most.value <= height);
        CHECK(height - most.value <= std::pow(2 * maximum_resolution / width, 2) + 1e-15);
        CHECK(calls - before <= 63);
    }
    CHECK(calls <= searches * sections / 2);
}

// Rounding errors far above those of its size, as a small difference of large positions has them, do not lead the search.
TEST_CASE(a_noisy_maximum_takes_no_more_than_a_smooth_one) {
    Random random(95);
    int calls = 0, searches = 0;
    double missed_by = 0;  // in noises
    for (; searches < 2000; ++searches) {
        const auto [a, b, at] = random_place(random);
        const double bend = std::exp(random.in(-12, 3)), lean = random.in(-0.3, 0.3);
        const double noise = bend * std::exp(random.in(-25, -14));
        const auto smooth = [=, top = at](double x) { return -bend * (x - top) * (x - top) * (1 + lean * (x - top)); };
        const auto f = [&](double x) {
            ++calls;
            return smooth(x) + noise * random.in(-0.5, 0.5);
        };
        const Maximum most = maximum_of(f, a, b, noise);
        CHECK(-smooth(most.position) <= 200 * noise);  // where the noise hides on which side the maximum lies
        missed_by += -smooth(most.position) / noise;
    }
    CHECK(missed_by <= 0.2 * searches);
    CHECK(calls <= searches * sections / 3);
}

// A corner and a rise up to the end have no parabola: sections find them.
TEST_CASE(a_maximum_without_a_parabola_is_found_too) {
    Random random(92);
    for (int trial = 0; trial < 500; ++trial) {
        const auto [a, b, at] = random_place(random);
        const double left = random.in(0.1, 5), right = random.in(0.1, 5), top = at;
        const auto corner = [=](double x) { return x < top ? left * (x - top) : right * (top - x); };
        CHECK(std::abs(maximum_of(corner, a, b).position - at) <= 4 * maximum_resolution);
        CHECK(std::abs(maximum_of([](double x) { return x; }, a, b).position - b) <= 4 * maximum_resolution);
        CHECK(std::abs(maximum_of([](double x) { return -x; }, a, b).position - a) <= 4 * maximum_resolution);
        const double level = maximum_of([](double) { return 4.0; }, a, b).value;
        CHECK(level == 4.0);
    }
}

TEST_CASE(a_smooth_zero_is_found_in_a_third_of_the_halvings) {
    Random random(93);
    int calls = 0, searches = 0;
    for (; searches < 2000; ++searches) {
        const auto [a, b, at] = random_place(random);
        const double bend = random.in(-2, 2), scale = std::exp(random.in(-20, 20));
        const auto f = [&, root = at](double x) {
            ++calls;
            return scale * (root - x) * std::exp(bend * x);
        };
        const double zero = zero_of(f, a, b);
        CHECK(f(zero) <= 0);
        CHECK(std::abs(zero - at) <= 2 * zero_resolution);
    }
    CHECK(calls <= searches * halvings / 3);
}

// Where a torque reaches its limit the function jumps; then it takes halves.
TEST_CASE(a_jump_is_found_by_halves) {
    Random random(94);
    for (int trial = 0; trial < 500; ++trial) {
        const auto [a, b, at] = random_place(random);
        const double place = at;
        int calls = 0;
        const auto jump = [&](double x) { return ++calls, x < place ? 1.0 : -1.0; };
        const double zero = zero_of(jump, a, b);
        CHECK(zero >= place);
        CHECK(zero - place <= 2 * zero_resolution);
        CHECK(calls <= halvings + 5);
        CHECK(zero_of([](double) { return -1.0; }, a, a) == a);
    }
}

TEST_SUITE_END()

}  // namespace arm3r
