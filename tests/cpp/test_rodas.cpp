#include "arm3r/ode/rodas.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "linear_algebra.hpp"

namespace arm3r {

TEST_SUITE(rodas)

// ---- the coefficients: every condition that order 4 of a Rosenbrock method asks, also where f depends on the time

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// The method in the symbols of its theory: k_i = h f(y + sum alpha_ij k_j) + h J sum gamma_ij k_j, y1 = y + sum b_i k_i.
struct Classical {
    Matrix6 alpha, gamma, beta;

    Classical() {
        Matrix6 a = Matrix6::Zero(), c = Matrix6::Zero();
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j < i; ++j) {
                a(i, j) = rodas4::a[i][j];
                c(i, j) = rodas4::c[i][j];
            }
        }
        gamma = inverse(Matrix6::Identity() / rodas4::gamma - c);
        alpha = a * gamma;
        beta = alpha + gamma;
    }

    Vector6 weights(const Vector6& of_u) const { return gamma.transpose() * of_u; }
};

// The residuals of the eight order conditions for the weights b of a solution at theta; the first four are those of
// order 3.
static std::array<double, 8> misses(const Classical& m, const Vector6& b, double theta) {
    const Vector6 one = Vector6::Ones(), alpha = m.alpha * one, beta = m.beta * one;
    const Vector6 alpha2 = alpha.cwiseProduct(alpha);
    const double t2 = theta * theta, t3 = t2 * theta, t4 = t2 * t2;
    return {b.sum() - theta,
            b.dot(beta) - t2 / 2,
            b.dot(alpha2) - t3 / 3,
            b.dot(m.beta * beta) - t3 / 6,
            b.dot(alpha2.cwiseProduct(alpha)) - t4 / 4,
            b.dot(alpha.cwiseProduct(m.alpha * beta)) - t4 / 8,
            b.dot(m.beta * alpha2) - t4 / 12,
            b.dot(m.beta * (m.beta * beta)) - t4 / 24};
}

static Vector6 row(const double* numbers, int count) {
    Vector6 v = Vector6::Zero();
    for (int i = 0; i < count; ++i) v[i] = numbers[i];
    return v;
}

TEST_CASE(the_step_meets_all_conditions_of_order_4) {
    const Classical m;
    for (const double miss : misses(m, m.weights(row(rodas4::a[6], 6)), 1)) CHECK(std::abs(miss) <= 1e-14);
}

TEST_CASE(the_embedded_step_meets_those_of_order_3_and_no_more) {
    const Classical m;
    const std::array<double, 8> miss = misses(m, m.weights(row(rodas4::a[5], 5)), 1);
    for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(miss[i]) <= 1e-14);
    for (std::size_t i = 4; i < 8; ++i) CHECK(std::abs(miss[i]) > 1e-3);
}

TEST_CASE(the_solution_within_a_step_meets_those_of_order_3) {
    const Classical m;
    for (const double theta : {0.1, 0.35, 0.6, 0.85}) {
        const Vector6 of_u =
            theta * row(rodas4::a[6], 6) + theta * (1 - theta) * (row(rodas4::d[0], 5) + theta * row(rodas4::d[1], 5));
        const std::array<double, 8> miss = misses(m, m.weights(of_u), theta);
        for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(miss[i]) <= 1e-14);
    }
}

// Then time is a component of the state like any other.
TEST_CASE(the_instants_of_the_stages_are_the_row_sums) {
    const Classical m;
    for (int i = 0; i < 6; ++i) {
        CHECK(std::abs(m.alpha.row(i).sum() - rodas4::alpha[i]) <= 1e-14);
        CHECK(std::abs(m.gamma.row(i).sum() - rodas4::gamma_sum[i]) <= 1e-14);
    }
}

// ---- problems: right-hand sides over any number type

struct Problem {
    template <class S>
    void begin_step(const S&) {}
};

// Two components of motion, a quadrature, three components of memory of which two are used; coupled, nonlinear, driven,
// and with a known solution.
struct Driven : Problem {
    static constexpr std::size_t size = 6, motion = 2, quadratures = 1, memory = 2;

    template <class T>
    static State<T, size> exact(const T& t) {
        const SinCos<T> s = sincos(t);
        const T rise = exponential(s.sin);
        return {rise, 1.0 / (1.0 + t * t), rise * rise, s.cos * s.sin, s.cos, T(0.25)};
    }
    // y' of the solution plus terms that vanish on it, so that every component depends on every other one but the
    // quadrature.
    template <class T>
    void operator()(const T& t, const State<T, size>& y, State<T, size>& dy) const {
        const State<T, size> e = exact(t);
        const SinCos<T> s = sincos(t);
        dy[0] = y[0] * s.cos + (y[1] * y[3] - e[1] * e[3]);
        dy[1] = -2.0 * t * y[1] * y[1] + (y[0] * y[4] - e[0] * e[4]) - 3.0 * (y[1] * y[1] * y[1] - e[1] * e[1] * e[1]);
        dy[2] = 2.0 * y[0] * y[0] * s.cos + (y[1] * y[3] - e[1] * e[3]) * y[4];
        dy[3] = 2.0 * y[4] * y[4] - 1.0 + (y[0] * y[1] - e[0] * e[1]) - 2.0 * (y[3] - e[3]);
        dy[4] = -s.sin + (y[3] * y[3] - e[3] * e[3]) * y[1];
        dy[5] = T(1e300);  // of idle memory, must not be seen
    }

private:
    template <class T>
    static T exponential(const T& x) {  // (1 + tanh(x/2)) / (1 - tanh(x/2))
        const T half = tanh(T(0.5 * x));
        return (1.0 + half) / (1.0 - half);
    }
};

// Relaxation oscillations, by the slow time.
struct VanDerPol : Problem {
    static constexpr std::size_t size = 2, motion = 2, quadratures = 0, memory = 0;
    double mu;

    explicit VanDerPol(double mu) : mu(mu) {}
    template <class T>
    void operator()(const T&, const State<T, size>& y, State<T, size>& dy) const {
        dy = {y[1], mu * ((1.0 - y[0] * y[0]) * y[1] - y[0])};
    }
};

// Three species; the product is a quadrature of what the others lose.
struct Robertson : Problem {
    static constexpr std::size_t size = 3, motion = 2, quadratures = 1, memory = 0;

    template <class T>
    void operator()(const T&, const State<T, size>& y, State<T, size>& dy) const {
        const T third = 1.0 - y[0] - y[1];
        const T slow = 0.04 * y[0], back = 1e4 * y[1] * third, fast = 3e7 * y[1] * y[1];
        dy = {back - slow, slow - back - fast, fast};
    }
};

template <class P>
class Solver {
public:
    using Y = State<double, P::size>;
    Rodas4<double, P::size, P::motion, P::quadratures> stepper;

    explicit Solver(const P& problem) : problem_(problem) { stepper.memory = P::memory; }

    bool step(double t, const Y& y, double h) {
        linearize<P::motion, P::quadratures, 3>(problem_, t, y, P::memory, f0_, slopes_[0]);
        return stepper.step(problem_, true, slopes_, t, y, f0_, h);
    }

    // Equal steps from the exact solution on: the largest error of every component on the way.
    Y march(double start, double stop, int steps) {
        const double h = (stop - start) / steps;
        Y y = P::exact(start), largest{};
        for (int i = 0; i < steps; ++i) {
            REQUIRE(step(start + i * h, y, h));
            y = stepper.y1;
            const Y truth = P::exact(start + (i + 1) * h);
            for (std::size_t k = 0; k < P::size; ++k) largest[k] = std::max(largest[k], std::abs(y[k] - truth[k]));
        }
        return largest;
    }

    Y control_steps(Y y, double stop, double tolerance, double h) {
        double t = 0;
        for (taken = 0; t < stop; ++taken) {
            REQUIRE(taken < 100000);
            h = std::min(h, stop - t);
            const double error = step(t, y, h) ? stepper.error(y, tolerance, tolerance * 1e-6) : HUGE_VAL;
            if (error < 1) {
                t = h == stop - t ? stop : t + h;
                y = stepper.y1;
            }
            h *= stepper.step_factor(error);
        }
        return y;
    }

    int taken = 0;

private:
    P problem_;
    Y f0_;
    std::array<Linearization<P::size>, 1> slopes_;
};

// ---- order

// Least-squares slope of log2(error) over halved steps.
static double order(const std::vector<double>& errors) {
    double sum = 0, weight = 0;
    const double middle = (double(errors.size()) - 1) / 2;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        sum -= (double(i) - middle) * std::log2(errors[i]);
        weight += (double(i) - middle) * (double(i) - middle);
    }
    return sum / weight;
}

TEST_CASE(every_component_converges_with_order_4) {
    std::array<std::vector<double>, Driven::size> errors;
    for (int steps = 100; steps <= 800; steps *= 2) {
        const auto largest = Solver(Driven()).march(0.3, 2.3, steps);
        for (std::size_t i = 0; i < 5; ++i) errors[i].push_back(largest[i]);
        CHECK(largest[5] == 0.0);
    }
    for (std::size_t i = 0; i < 5; ++i)
        CHECK(std::abs(order(errors[i]) - 4) <= 0.15, "component " << i << ": " << order(errors[i]));
}

// One order above their own where a step starts on the solution.
TEST_CASE(the_solution_within_a_step_and_the_error_estimate_are_of_order_3) {
    std::array<std::vector<double>, Driven::size> errors;
    std::vector<double> estimates;
    for (double h = 0.04; h > 0.004; h /= 2) {
        std::array<double, Driven::size> largest{};
        double estimate = 0;
        for (double t = 0.3; t < 2; t += 0.1) {
            Solver<Driven> solver{Driven()};
            const auto start = Driven::exact(t);
            REQUIRE(solver.step(t, start, h));
            estimate = std::max(estimate, solver.stepper.error(start, 0.0, 1.0));
            const auto dense = solver.stepper.interpolant(t, start, h);
            for (const double theta : {0.2, 0.4, 0.6, 0.8}) {
                const auto truth = Driven::exact(t + theta * h);
                for (std::size_t i = 0; i < 5; ++i)
                    largest[i] = std::max(largest[i], std::abs(dense(theta)[i] - truth[i]));
                CHECK(dense(theta)[5] == 0.25);
            }
        }
        for (std::size_t i = 0; i < 5; ++i) errors[i].push_back(largest[i]);
        estimates.push_back(estimate);
    }
    for (std::size_t i = 0; i < 5; ++i)
        CHECK(std::abs(order(errors[i]) - 4) <= 0.15, "component " << i << ": " << order(errors[i]));
    CHECK(std::abs(order(estimates) - 4) <= 0.15, "estimate: " << order(estimates));
}

TEST_CASE(the_solution_within_a_step_meets_both_its_ends) {
    Solver<Driven> solver{Driven()};
    const auto start = Driven::exact(0.7);
    REQUIRE(solver.step(0.7, start, 0.1));
    const auto dense = solver.stepper.interpolant(0.7, start, 0.1);
    for (std::size_t i = 0; i < Driven::size; ++i) {
        CHECK(dense(0.0)[i] == start[i]);
        CHECK(std::abs(dense(1.0)[i] - solver.stepper.y1[i]) <= 4e-16 * std::abs(start[i]));
    }
}

// ---- error, and what a step is worth

TEST_CASE(the_error_is_the_largest_of_motion_and_memory_by_the_larger_end) {
    Rodas4<double, 6, 2, 1> stepper;
    stepper.memory = 2;
    stepper.y1 = {1.0, -4.0, 1.0, 1.0, 2.0, 1.0};
    const State<double, 6> y{3.0, 1.0, 1.0, 1.0, -5.0, 1.0};
    const auto error = [&](const State<double, 6>& estimate) {
        stepper.u.back() = estimate;
        return stepper.error(y, 1e-2, 1e-3);
    };
    CHECK(std::abs(error({1e-3, -2e-3, 0, 0, 0, 0}) - 2e-3 / (1e-3 + 1e-2 * 4)) <= 1e-15);
    CHECK(std::abs(error({9e-3, -2e-3, 0, 1e-5, 0, 0}) - 9e-3 / (1e-3 + 1e-2 * 3)) <= 1e-15);
    CHECK(std::abs(error({1e-9, 1e-9, 0, 0, -7e-3, 0}) - 7e-3 / (1e-3 + 1e-2 * 5)) <= 1e-15);
    CHECK(error({0, 0, 1e9, 0, 0, 1e9}) == 0);  // a quadrature, and unused memory
}

TEST_CASE(the_next_step_follows_the_fourth_root_of_the_error_between_its_bounds) {
    using Stepper = Rodas4<double, 2, 2, 0>;
    for (const double error : {1e-3, 1e-2, 0.3, 1.0, 7.0, 300.0})
        CHECK(std::abs(Stepper::step_factor(error) - 0.9 / std::pow(error, 0.25)) <= 1e-14);
    for (const double error : {0.0, 1e-300, 1e-5}) CHECK(Stepper::step_factor(error) == 6);
    for (const double error : {1e9, HUGE_VAL}) CHECK(Stepper::step_factor(error) == 0.2);
}

// 1 - h gamma df/dy = 0; a derivative that is NaN; a stage that is NaN, of the motion or of a quadrature.
TEST_CASE(a_step_without_an_end_is_reported) {
    const auto is_taken = [](double df_dy, double value, double book) {
        const auto f = [&](double, const State<double, 2>&, State<double, 2>& dy) { dy = {value, book}; };
        const Linearization<2> linearization{{State<double, 2>{df_dy, 0.0}, State<double, 2>{0.0, 0.0}}, {0.0, 0.0}};
        Rodas4<double, 2, 1, 1> stepper;
        return stepper.step(f, true, {linearization}, 0.0, {1.0, 1.0}, {1.0, 1.0}, 0.5);
    };
    CHECK(is_taken(-1, 1, 1));
    CHECK(!is_taken(1 / (0.5 * rodas4::gamma), 1, 1));
    CHECK(!is_taken(std::nan(""), 1, 1));
    CHECK(!is_taken(HUGE_VAL, 1, 1));
    CHECK(!is_taken(-1, std::nan(""), 1));
    CHECK(!is_taken(-1, 1, HUGE_VAL));
}

// ---- stiffness

// y' = A y with A = h lambda and its conjugate: the step multiplies by R(h lambda).
static Eigen::Matrix2d stability_function(double re, double im) {
    struct Linear : Problem {
        double re, im;
        void operator()(double, const State<double, 2>& y, State<double, 2>& dy) const {
            dy = {re * y[0] - im * y[1], im * y[0] + re * y[1]};
        }
    } f;
    f.re = re;
    f.im = im;
    const Linearization<2> linearization{{State<double, 2>{re, -im}, State<double, 2>{im, re}}, {0.0, 0.0}};
    Eigen::Matrix2d R;
    for (std::size_t column = 0; column < 2; ++column) {
        State<double, 2> y{}, f0;
        y[column] = 1;
        f(0.0, y, f0);
        Rodas4<double, 2, 2, 0> stepper;
        REQUIRE(stepper.step(f, true, {linearization}, 0.0, y, f0, 1.0));
        R.col(Eigen::Index(column)) << stepper.y1[0], stepper.y1[1];
    }
    return R;
}

static double growth(double re, double im) { return stability_function(re, im).norm() / std::sqrt(2.0); }

// |R| <= 1 on the axis bounds it on the whole left half plane.
TEST_CASE(nothing_that_decays_or_turns_can_grow_and_what_decays_at_once_is_gone) {
    for (double w = 1e-3; w < 1e9; w *= 1.3) CHECK(growth(0, w) <= 1 + 1e-12, w);
    CHECK(growth(-1e8, 0) <= 1e-7);
    CHECK(growth(-1e4, 1e8) <= 1e-7);
    CHECK(std::abs(growth(-0.1, 0) - std::exp(-0.1)) <= 1e-8);
}

struct VanDerPolEnd {
    double mu, y, slope;  // at t = 2 from (2, 0): Radau IIA of order 5, rtol 3e-13
};

TEST_CASE(van_der_pol_with_jumps_between_slow_branches) {
    for (const VanDerPolEnd& end :
         {VanDerPolEnd{1e3, 1.7632345402034, -0.8356886816777}, VanDerPolEnd{1e4, 1.7185872080192, -0.8796821912416},
          VanDerPolEnd{1e5, 1.7084078214179, -0.8904134976480}, VanDerPolEnd{1e6, 1.7061677321704, -0.8928097010248}}) {
        int coarse_steps = 0;
        for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
            Solver<VanDerPol> solver{VanDerPol(end.mu)};
            const auto y = solver.control_steps({2.0, 0.0}, 2.0, tolerance, 1e-4 / end.mu);
            const double error = std::max(std::abs(y[0] / end.y - 1), std::abs(y[1] / end.slope - 1));
            LOG_MESSAGE("van der Pol " << end.mu << " tol " << tolerance << " steps " << solver.taken << " error "
                                       << error);
            CHECK(error <= 100 * tolerance, end.mu << ", " << tolerance << ": " << error);
            if (coarse_steps == 0) coarse_steps = solver.taken;
        }
        CHECK(coarse_steps < 1000);  // an explicit method takes about mu of them
    }
}

struct RobertsonEnd {
    double t, first, second, third;  // by the same
};

TEST_CASE(robertson_over_five_decades) {
    for (const RobertsonEnd& end : {RobertsonEnd{0.4, 0.98517211386099, 3.38639537897491e-5, 0.01479402218522},
                                    RobertsonEnd{40, 0.71582706871941, 9.1855347645578e-6, 0.28416374574583},
                                    RobertsonEnd{4e4, 0.038983377085491, 1.62176831591004e-7, 0.96101646073768}}) {
        for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
            Solver<Robertson> solver{Robertson()};
            const auto y = solver.control_steps({1.0, 0.0, 0.0}, end.t, tolerance, 1e-6);
            const double error = std::max(
                {std::abs(y[0] / end.first - 1), std::abs(y[1] / end.second - 1), std::abs(y[2] / end.third - 1)});
            LOG_MESSAGE("Robertson " << end.t << " tol " << tolerance << " steps " << solver.taken << " error "
                                     << error);
            CHECK(error <= 10 * tolerance, end.t << ", " << tolerance << ": " << error);
            CHECK(solver.taken < 5000);
        }
    }
}

TEST_SUITE_END()

}  // namespace arm3r
