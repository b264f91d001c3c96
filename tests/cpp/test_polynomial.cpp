#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "arm3r/numbers/pack.hpp"
#include "arm3r/numbers/polynomial.hpp"
#include "check.hpp"

namespace arm3r {

TEST_SUITE(polynomial)

using Poly = Polynomial<double>;
using Wide = Polynomial<long double>;

static constexpr double resolution = 1e-12;
static constexpr double epsilon = std::numeric_limits<double>::epsilon();

// ---- polynomials to try

static std::mt19937_64 rng(7);
static double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(rng); }
static int uniform_degree(int low, int high) { return low + int(rng() % std::uint64_t(high - low + 1)); }

static Poly power_form(const std::vector<double>& c) {
    Poly p{int(c.size()) - 1, {}};
    std::copy(c.begin(), c.end(), p.c.begin());
    return p;
}

static Wide times(const Wide& p, const std::vector<long double>& factor) {
    Wide product{p.degree + int(factor.size()) - 1, {}};
    for (int i = 0; i <= p.degree; ++i)
        for (std::size_t k = 0; k < factor.size(); ++k) product.c[i + int(k)] += p.c[i] * factor[k];
    return product;
}

static Poly rounded(const Wide& p) {
    Poly q{p.degree, {}};
    std::copy(p.c.begin(), p.c.end(), q.c.begin());
    return q;
}

// Product of (theta - root), positive at 0, filled up to `degree` with quadratics that have no root near [0, 1].
static Poly with_roots(const std::vector<double>& roots, int degree, double sign = 1) {
    Wide p{0, {sign}};
    for (const double root : roots) p = times(p, {-root, 1});
    for (; p.degree + 2 <= degree; p = times(p, {1.0L, uniform(-0.4, 0.4), uniform(0.1, 0.4)})) {
    }
    return rounded(p);
}

static Poly random_coefficients(int degree) {
    Poly p{degree, {}};
    for (int i = 0; i <= degree; ++i) p.c[i] = uniform(-1, 1);
    return p;
}

// ---- what they are, in long double

static long double exact(const Poly& p, long double theta) {
    long double sum = 0;
    for (int i = p.degree; i >= 0; --i) sum = sum * theta + p.c[i];
    return sum;
}

static double rounding_of(const Poly& p) {
    double sum = 0;
    for (int i = 0; i <= p.degree; ++i) sum += std::abs(p.c[i]);
    return p.degree * epsilon * sum;
}

// Is what first_crossing says true? For a g that is not below zero at `from`.
static bool is_first_fall(const Poly& g, double from, const std::optional<double>& fall) {
    const double noise = 2 * rounding_of(g);
    const double end = fall ? *fall - 1.01 * resolution : 1.0;
    constexpr int samples = 500;
    for (int i = 0; i <= samples && end > from; ++i)
        if (exact(g, from + (end - from) * (double(i) / samples)) < -noise) return false;
    return !fall || (*fall > from && *fall <= 1 && exact(g, *fall) <= noise);
}

static void expect_fall(const Poly& g, double from, double root, double tolerance = resolution) {
    const auto fall = first_crossing(g, from, resolution);
    REQUIRE(fall.has_value(), "no fall found at " << root);
    CHECK(std::abs(*fall - root) <= tolerance, *fall << " instead of " << root << ", off " << *fall - root);
    CHECK(value(g, *fall) <= rounding_of(g));
}

static void expect_no_fall(const Poly& g, double from = 0) {
    const auto fall = first_crossing(g, from, resolution);
    CHECK(!fall, "fall found at " << fall.value_or(0));
}

// ---- values

TEST_CASE(value_slope_derivative_and_integral_of_a_known_cubic) {
    const Poly p = power_form({2, -3, 0.5, 4});
    CHECK(value(p, 0.5) == 2 - 1.5 + 0.125 + 0.5);
    CHECK(slope(p, 0.5) == -3 + 0.5 + 3);
    CHECK(derivative(p).degree == 2);
    CHECK(value(derivative(p), 0.5) == slope(p, 0.5));
    CHECK(std::abs(integral(p, 0.0, 1.0) - (2 - 1.5 + 0.5 / 3 + 1)) <= 1e-15);
    CHECK(integral(p, 1.0, 0.0) == -integral(p, 0.0, 1.0));
    CHECK(integral(p, 0.3, 0.3) == 0);

    const Poly constant = power_form({5});
    CHECK(value(constant, 0.3) == 5);
    CHECK(slope(constant, 0.3) == 0);
    CHECK(derivative(constant).degree == 0);
    CHECK(value(derivative(constant), 0.3) == 0);
    CHECK(integral(constant, 0.25, 0.75) == 2.5);
}

TEST_CASE(the_integral_over_a_sliver_keeps_its_digits) {
    for (int degree = 1; degree <= max_degree; ++degree) {
        Poly p{degree, {}};
        for (int i = 0; i <= degree; ++i) p.c[i] = uniform(0.5, 1);
        const double a = uniform(0.1, 0.9), b = a + 0x1p-30;
        const long double middle = a + (b - a) / 2.0L;
        CHECK(std::abs(double(integral(p, a, b) / ((b - a) * exact(p, middle)) - 1)) <= 1e-14);
    }
}

TEST_CASE(the_hermite_cubic_meets_both_ends_and_their_slopes) {
    const Poly p = hermite_cubic(1.5, -2.0, 0.25, 4.0);
    CHECK(p.degree == 3);
    CHECK(value(p, 0.0) == 1.5);
    CHECK(slope(p, 0.0) == -2.0);
    CHECK(value(p, 1.0) == 0.25);
    CHECK(slope(p, 1.0) == 4.0);
}

// Summed up by their basis, C(n, j) theta^j (1 - theta)^(n - j), the coefficients give the polynomial back.
TEST_CASE(bernstein_coefficients_give_the_polynomial_back) {
    for (int degree = 0; degree <= max_degree; ++degree) {
        const Poly p = random_coefficients(degree);
        const auto b = bernstein(p);
        CHECK(b[0] == p.c[0]);
        for (const double theta : {0.0, 0.1, 0.37, 0.5, 0.92, 1.0}) {
            long double sum = 0, binomial = 1;
            for (int j = 0; j <= degree; binomial = binomial * (degree - j) / (j + 1), ++j)
                sum += b[j] * binomial * std::pow((long double)theta, j) * std::pow(1 - (long double)theta, degree - j);
            CHECK(std::abs(double(sum - exact(p, theta))) <= epsilon + rounding_of(p));
        }
    }
}

// ---- lanes

template <int N>
ARM3R_INLINE void run_lanes(const double* c, const double* ab, int degree, double* out) {
    Polynomial<Pack<N>> p;
    p.degree = degree;
    for (int i = 0; i <= degree; ++i) p.c[i] = Pack<N>::load(c + i * N);
    const Pack<N> a = Pack<N>::load(ab), b = Pack<N>::load(ab + N);
    const Coefficients<Pack<N>> coefficients = bernstein(p);
    const Pack<N> end = coefficients[degree];
    const Polynomial<Pack<N>> cubic = hermite_cubic(a, p.c[0], b, end);
    for (int i = 0; i <= degree; ++i) coefficients[i].store(out + i * N);
    value(p, a).store(out + 21 * N);
    slope(p, a).store(out + 22 * N);
    integral(p, a, b).store(out + 23 * N);
    value(p, 0.3).store(out + 24 * N);
    value(derivative(p), b).store(out + 25 * N);
    value(cubic, a).store(out + 26 * N);
}
static constexpr int results = 27;

using Run = void (*)(const double* c, const double* ab, int degree, double* out);

template <int N>
void baseline(const double* c, const double* ab, int degree, double* out) {
    run_lanes<N>(c, ab, degree, out);
}
#ifdef __x86_64__
template <int N>
__attribute__((target("avx2"))) void avx2(const double* c, const double* ab, int degree, double* out) {
    run_lanes<N>(c, ab, degree, out);
}
template <int N>
__attribute__((target("avx512f"))) void avx512(const double* c, const double* ab, int degree, double* out) {
    run_lanes<N>(c, ab, degree, out);
}
#endif

static void scalar(const double* c, const double* ab, int degree, int lanes, int lane, double* out) {
    Poly p{degree, {}};
    for (int i = 0; i <= degree; ++i) p.c[i] = c[i * lanes + lane];
    const double a = ab[lane], b = ab[lanes + lane];
    const auto coefficients = bernstein(p);
    const double values[] = {value(p, a),
                             slope(p, a),
                             integral(p, a, b),
                             value(p, 0.3),
                             value(derivative(p), b),
                             value(hermite_cubic(a, p.c[0], b, coefficients[degree]), a)};
    std::copy(coefficients.begin(), coefficients.end(), out);
    std::copy(std::begin(values), std::end(values), out + 21);
}

static int differences(Run run, int lanes) {
    int count = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const int degree = uniform_degree(0, max_degree);
        double c[21 * 8], ab[16], out[results * 8] = {}, expected[results] = {};
        std::generate(std::begin(c), std::end(c), [] { return uniform(-1, 1); });
        std::generate(std::begin(ab), std::end(ab), [] { return uniform(0, 1); });
        run(c, ab, degree, out);
        for (int lane = 0; lane < lanes; ++lane) {
            scalar(c, ab, degree, lanes, lane, expected);
            for (int k = 0; k < results; ++k)
                if (k <= degree || k >= 21)
                    count += std::bit_cast<std::uint64_t>(out[k * lanes + lane]) !=
                             std::bit_cast<std::uint64_t>(expected[k]);
        }
    }
    return count;
}

TEST_CASE(each_lane_equals_the_double_bit_for_bit) {
    CHECK(differences(baseline<2>, 2) == 0);
    CHECK(differences(baseline<4>, 4) == 0);
    CHECK(differences(baseline<8>, 8) == 0);
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) {
        CHECK(differences(avx2<4>, 4) == 0);
        CHECK(differences(avx2<8>, 8) == 0);
    }
    if (__builtin_cpu_supports("avx512f")) CHECK(differences(avx512<8>, 8) == 0);
#endif
}

// ---- first_crossing

TEST_CASE(one_simple_root_of_any_degree_is_found_to_the_resolution) {
    for (int trial = 0; trial < 5000; ++trial) {
        const double root = uniform(0.001, 1);
        const Poly g = with_roots({root}, uniform_degree(1, max_degree), -1);
        const double steep = std::abs(slope(g, root));
        expect_fall(g, 0, root, resolution + rounding_of(g) / steep);
        expect_fall(g, 0.9 * root, root, resolution + rounding_of(g) / steep);
    }
}

TEST_CASE(the_finest_resolution_ends_and_a_coarse_one_is_kept) {
    for (int trial = 0; trial < 1000; ++trial) {
        const double root = uniform(0, 1);
        const Poly g = with_roots({root}, 12, -1);
        for (const double fine : {0.0, 1e-300, 1e-16, -1.0, std::numeric_limits<double>::quiet_NaN()})
            CHECK(std::abs(first_crossing(g, 0, fine).value() - root) <= 1e-14);
        const double coarse = first_crossing(g, 0, 1e-3).value();
        CHECK(std::abs(coarse - root) <= 1e-3);
        CHECK(value(g, coarse) < 0);
    }
}

TEST_CASE(several_roots_give_the_first_fall_after_from) {
    const Poly g = with_roots({0.2, 0.4, 0.6, 0.8}, 8);  // falls at 0.2 and 0.6
    expect_fall(g, 0, 0.2);
    expect_fall(g, 0.1, 0.2);
    expect_fall(g, 0.45, 0.6);
    expect_fall(g, 0.3999999, 0.6);  // starts below zero and comes up
    expect_no_fall(g, 0.85);
    expect_no_fall(g, 1);
    expect_no_fall(power_form({1, -2}), 1);
    expect_fall(with_roots({0.2, 0.4, 0.6, 0.8}, 8, -1), 0.65, 0.8);
}

// Roots anywhere, clusters of up to four of them, and arbitrary coefficients, against samples in long double.
TEST_CASE(random_polynomials_fall_where_samples_say) {
    int found = 0, none = 0;
    for (int trial = 0; trial < 12000; ++trial) {
        const int degree = uniform_degree(3, max_degree);
        Poly g = random_coefficients(degree);
        if (trial % 2) {
            std::vector<double> roots;
            for (int i = uniform_degree(1, std::min(degree, 6)); i > 0; --i) roots.push_back(uniform(-0.2, 1.3));
            const int cluster = uniform_degree(0, std::min(degree - int(roots.size()), 3));
            const double width = std::pow(10.0, uniform(-8, -1));
            for (int i = 0; i < cluster; ++i) roots.push_back(roots[0] + width * uniform(-1, 1));
            g = with_roots(roots, degree);
        }
        const double from = trial % 3 ? 0.0 : uniform(0, 0.9);
        if (exact(g, from) < 0)
            for (int i = 0; i <= g.degree; ++i) g.c[i] = -g.c[i];
        const auto fall = first_crossing(g, from, resolution);
        REQUIRE(is_first_fall(g, from, fall),
                "trial " << trial << ", degree " << g.degree << ", from " << from << ": " << fall.value_or(-1));
        ++(fall ? found : none);
    }
    CHECK(found > 3000);
    CHECK(none > 1000);
}

// What the lanes of Taylor's method do for all at once, against the search of one.
TEST_CASE(polynomials_side_by_side_fall_where_each_falls_alone_to_the_bit) {
    using namespace zero_crossing;
    using T = Pack<2>;
    int once = 0, never = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const int degree = uniform_degree(2, max_degree);
        const double fine = std::pow(10.0, uniform(-15, -3));
        std::array<Poly, 2> alone;
        Polynomial<T> p{degree, {}};
        for (int lane = 0; lane < 2; ++lane) {
            alone[lane] = trial % 2 ? random_coefficients(degree) : with_roots({uniform(-0.5, 1.5)}, degree);
            alone[lane].degree = degree;
            if (alone[lane].c[0] < 0) alone[lane] = negative(alone[lane]);
            for (int i = 0; i <= degree; ++i) p.c[i].set(lane, alone[lane].c[i]);
        }
        const Falls<T> falls = falls_of(bernstein(p), degree, rounding(p));
        const T root = refine_root(p, Bracket<T>{T(0.0), T(1.0), falls.guess}, attainable(T(fine)), falls.one);
        for (int lane = 0; lane < 2; ++lane) {
            const auto fall = first_crossing(alone[lane], 0, fine);
            if (falls.one[lane]) CHECK((fall && *fall == root[lane]), "degree " << degree << ", trial " << trial);
            if (falls.none[lane]) CHECK(!fall, "degree " << degree << ", trial " << trial);
            once += falls.one[lane], never += falls.none[lane];
        }
    }
    CHECK(once > 1000);
    CHECK(never > 1000);
}

TEST_CASE(a_dip_of_any_width_is_found_and_a_touch_is_none) {
    for (int trial = 0; trial < 3000; ++trial) {
        const int degree = uniform_degree(2, max_degree);
        const double root = uniform(0.01, 0.9), width = std::pow(10.0, uniform(-6, -1.1));
        Poly dip = with_roots({root, root + width}, degree);
        const double steep = std::abs(slope(dip, root));
        expect_fall(dip, 0, root, resolution + rounding_of(dip) / steep);

        const double lowest = double(exact(dip, root + 0.5 * width));
        Poly touch = with_roots({root, root}, degree);
        expect_no_fall(touch);
        touch.c[0] += std::abs(lowest);
        expect_no_fall(touch);
    }
}

TEST_CASE(the_width_of_a_dip_decides_not_where_the_halving_cuts) {
    for (int trial = 0; trial < 1000; ++trial) {
        const double root = uniform(0.01, 0.9), coarse = std::pow(10.0, uniform(-4, -2));
        const auto fall = first_crossing(with_roots({root, root + 1.01 * coarse}, 6), 0, coarse);
        REQUIRE(fall.has_value());
        CHECK(std::abs(*fall - root) <= coarse);
        expect_no_fall(with_roots({root, root + 1e-9}, 6));  // not as deep as the rounding of the coefficients
    }
}

TEST_CASE(exact_touches_and_roots_at_the_ends) {
    expect_no_fall(power_form({0.25, -1, 1}));      // (theta - 1/2)^2
    expect_no_fall(power_form({0.0625, -0.5, 1}));  // (theta - 1/4)^2
    expect_no_fall(power_form({1, -2, 1}));         // (theta - 1)^2
    expect_no_fall(power_form({0, 0, 1}));          // theta^2
    expect_no_fall(power_form({0, 1}));             // rises from zero
    expect_no_fall(power_form({1, -1}));            // reaches zero at the end, no further
    expect_no_fall(power_form({0, 1, -1}));         // theta (1 - theta)
    expect_no_fall(power_form({0}));
    expect_no_fall(power_form({0, 0, 0}));
    expect_fall(power_form({0, -1}), 0, 0);  // falls from zero
    expect_fall(power_form({0, 0, -1}), 0, 0);
    expect_fall(power_form({0, -1, 1}), 0, 0);           // theta (theta - 1)
    expect_fall(power_form({0, 0.5, -1.5, 1}), 0, 0.5);  // theta (theta - 1/2) (theta - 1)
    expect_fall(power_form({1 - 1e-9, -1}), 0, 1 - 1e-9);
    expect_fall(power_form({0.125, -0.75, 1.5, -1}), 0, 0.5, 1e-5);  // (1/2 - theta)^3, as flat as rounding there
}

TEST_CASE(the_place_found_has_fallen_where_the_root_is_a_double_itself) {
    CHECK(value(power_form({0.5, -1}), first_crossing(power_form({0.5, -1}), 0, resolution).value()) < 0);
}

// Values drown in rounding as far as |theta - root|^k is below it.
TEST_CASE(a_root_of_odd_multiplicity_is_found_as_well_as_rounding_lets) {
    for (const double root : {0.1, 0.3, 0.7, 0.9})
        for (int k = 3; k <= 9; k += 2) {
            const Poly g = with_roots(std::vector<double>(std::size_t(k), root), k, -1);
            expect_fall(g, 0, root, 2 * std::pow(2 * rounding_of(g), 1.0 / k));
        }
}

// Flat starts: theta^k (root - theta), lifted or lowered by less than rounding.
TEST_CASE(a_long_flat_start_is_no_fall) {
    for (int k = 1; k < max_degree; ++k)
        for (const double start : {0.0, 1e-18, -1e-18}) {
            Poly g{k + 1, {}};
            g.c[0] = start;
            g.c[k] = 0.7;
            g.c[k + 1] = -1;
            expect_fall(g, 0, 0.7, resolution + 1e-15 / std::pow(0.7, k));
        }
}

TEST_CASE(a_start_below_zero_falls_at_once_unless_it_comes_up_without_sinking) {
    for (const double start : {-1e-17, -1e-13, -1e-3}) {
        const bool by_rounding = start > -1e-16;
        expect_no_fall(power_form({start, 1}));
        expect_no_fall(power_form({start, 1, -0.5}));
        expect_fall(power_form({start, 1, -2}), 0, (1 + std::sqrt(1 + 8 * start)) / 4);
        expect_fall(power_form({start, -1}), 0, 0);
        expect_fall(power_form({start, -1, 2}), 0, 0);  // sinks, then comes up
        expect_fall(power_form({start, 0, 0, -1}), 0, 0);
        if (!by_rounding) {
            CHECK(first_crossing(power_form({start, -1}), 0, resolution).value() == 0);
            CHECK(first_crossing(power_form({start, 0.5 * -start}), 0.25, resolution).value() == 0.25);
        }
    }
    CHECK(first_crossing(power_form({-1e-17}), 0, resolution).value() == 0);
}

TEST_CASE(a_scale_changes_nothing) {
    for (int trial = 0; trial < 500; ++trial) {
        const Poly g = random_coefficients(uniform_degree(3, max_degree));
        for (const double scale : {0x1p-900, 0x1p-60, 0x1p60, 0x1p900}) {
            Poly scaled = g;
            for (int i = 0; i <= g.degree; ++i) scaled.c[i] *= scale;
            CHECK((first_crossing(scaled, 0.1, resolution) == first_crossing(g, 0.1, resolution)));
        }
    }
}

TEST_CASE(what_is_not_finite_gives_nothing) {
    constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (int degree = 0; degree <= max_degree; ++degree)
        for (int i = 0; i <= degree; ++i)
            for (const double bad : {inf, -inf, nan}) {
                Poly g = random_coefficients(degree);
                g.c[i] = bad;
                expect_no_fall(g);
                expect_no_fall(g, 0.5);
                CHECK(!std::isfinite(max_value(g, 0, 1)));
            }
    expect_no_fall(power_form({1, -2}), nan);
}

// ---- largest

TEST_CASE(the_largest_of_known_curves) {
    CHECK(max_value(power_form({3}), 0, 1) == 3);
    CHECK(max_value(power_form({0, 1, -1}), 0, 1) == 0.25);
    CHECK(std::abs(max_value(power_form({0, 1, -1}), 0, 0.25) - 0.1875) <= 1e-16);
    CHECK(std::abs(max_value(power_form({0, 1, -1}), 0.75, 1) - 0.1875) <= 1e-16);
    CHECK(max_value(power_form({0.25, -1, 1}), 0, 1) == 0.25);
    CHECK(max_value(power_form({0.25, -1, 1}), 0.5, 0.5) == 0);
}

TEST_CASE(the_largest_is_that_of_dense_samples) {
    constexpr int samples = 2000;
    int inside = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const Poly p = trial % 2 ? random_coefficients(uniform_degree(1, max_degree))
                                 : with_roots({uniform(0, 1), uniform(0, 1), uniform(0, 1), uniform(0, 1)}, 12);
        const double a = trial % 3 ? 0.0 : uniform(0, 0.5), b = trial % 3 ? 1.0 : uniform(0.5, 1);
        long double most = -HUGE_VALL;
        double bend = 0;  // bounds the second derivative
        for (int i = 0; i <= samples; ++i) most = std::max(most, exact(p, a + (b - a) * (double(i) / samples)));
        for (int i = 2; i <= p.degree; ++i) bend += i * (i - 1) * std::abs(p.c[i]);
        const double gap = 0.5 * bend / (4.0 * samples * samples), found = max_value(p, a, b);
        const double noise = epsilon + rounding_of(p);
        CHECK(found >= double(most) - noise);
        CHECK(found <= double(most) + gap + noise);
        inside += found > std::max(value(p, a), value(p, b));
    }
    CHECK(inside > 500);
}

TEST_SUITE_END()

}  // namespace arm3r
