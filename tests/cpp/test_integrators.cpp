
#include "arm3r/plant.hpp"
#include "check.hpp"
#include "fixtures.hpp"

namespace arm3r {

TEST_SUITE(integrators)

using Scalar = State<double, 1>;

// y' = y cos t, y(0) = 1: y = exp(sin t).
struct Swell {
    void begin_step(const Scalar&) {}
    void operator()(double t, const Scalar& y, Scalar& dy) const { dy[0] = y[0] * std::cos(t); }
    static double exact(double t) { return std::exp(std::sin(t)); }
};

// A fixed step of either method: the end, and the solution within.
struct Rk4 {
    template <std::size_t N, class F>
    static auto step(F& f, double t, const State<double, N>& y, double h) {
        State<double, N> f0, f1;
        f.begin_step(y);
        f(t, y, f0);
        const State<double, N> y1 = rk4_step(f, t, y, f0, h);
        f(t + h, y1, f1);
        return std::pair(y1, hermite(t, h, y, f0, y1, f1));
    }
};

struct Dp5 {
    template <std::size_t N, class F>
    static auto step(F& f, double t, const State<double, N>& y, double h) {
        State<double, N> f0;
        Dopri5<double, N, N> stepper;
        f.begin_step(y);
        f(t, y, f0);
        stepper.step(f, t, y, f0, h);
        return std::pair(stepper.y1, stepper.interpolant(t, y, h));
    }
};

template <class Method, std::size_t N, class F>
static State<double, N> end_of(F f, State<double, N> y, double stop, int steps) {
    const double h = stop / steps;
    for (int i = 0; i < steps; ++i) y = Method::step(f, i * h, y, h).first;
    return y;
}

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

template <class Method>
static double order_on_the_scalar() {
    std::vector<double> errors;
    for (int steps = 40; steps <= 320; steps *= 2)
        errors.push_back(std::abs(end_of<Method, 1>(Swell(), {1.0}, 3.0, steps)[0] - Swell::exact(3.0)));
    return order(errors);
}

TEST_CASE(order_on_a_scalar_of_known_solution) {
    const double rk4 = order_on_the_scalar<Rk4>(), dopri5 = order_on_the_scalar<Dp5>();
    CHECK(std::abs(rk4 - 4) <= 0.1, "rk4: " << rk4);
    CHECK(std::abs(dopri5 - 5) <= 0.1, "dopri5: " << dopri5);
}

// Largest error within one step that starts on the solution: one order above that of the interpolant.
template <class Method>
static double order_within_a_step() {
    std::vector<double> errors;
    for (double h = 0.2; h > 0.02; h /= 2) {
        double largest = 0;
        for (double t = 0; t < 6; t += 0.1) {
            Swell f;
            const auto dense = Method::step(f, t, Scalar{Swell::exact(t)}, h).second;
            for (const double theta : {0.2, 0.4, 0.6, 0.8})
                largest = std::max(largest, std::abs(dense(theta)[0] - Swell::exact(t + theta * h)));
        }
        errors.push_back(largest);
    }
    return order(errors);
}

TEST_CASE(the_solution_within_a_step_is_of_order_3_for_rk4_and_4_for_dopri5) {
    const double rk4 = order_within_a_step<Rk4>(), dopri5 = order_within_a_step<Dp5>();
    CHECK(std::abs(rk4 - 4) <= 0.1, "rk4: " << rk4);
    CHECK(std::abs(dopri5 - 5) <= 0.1, "dopri5: " << dopri5);
}

TEST_CASE(the_solution_within_a_step_meets_both_its_ends_and_their_slopes) {
    Swell f;
    const double t = 0.7, h = 0.1, d = 1e-6;
    const auto check = [&](const auto& result) {
        const auto& [y1, dense] = result;
        CHECK(dense(0.0)[0] == Swell::exact(t));
        CHECK(std::abs(dense(1.0)[0] - y1[0]) <= 1e-15);
        CHECK(std::abs((dense(d)[0] - dense(-d)[0]) / (2 * d * h) - Swell::exact(t) * std::cos(t)) <= 1e-8);
        CHECK(std::abs((dense(1 + d)[0] - dense(1 - d)[0]) / (2 * d * h) - y1[0] * std::cos(t + h)) <= 1e-8);
    };
    check(Rk4::step(f, t, Scalar{Swell::exact(t)}, h));
    check(Dp5::step(f, t, Scalar{Swell::exact(t)}, h));
}

TEST_CASE(the_error_estimate_is_of_order_5_and_counts_the_motion_alone) {
    std::vector<double> estimates;
    for (double h = 0.2; h > 0.02; h /= 2) {
        Swell f;
        Scalar f0;
        Dopri5<double, 1, 1> stepper;
        f(0.3, {Swell::exact(0.3)}, f0);
        stepper.step(f, 0.3, {Swell::exact(0.3)}, f0, h);
        estimates.push_back(stepper.error({Swell::exact(0.3)}, h, 0.0, 1.0));
    }
    CHECK(std::abs(order(estimates) - 5) <= 0.1, "estimate: " << order(estimates));

    const auto rough_book = [](double t, const State<double, 2>& y, State<double, 2>& dy) {
        dy = {y[0], 1e9 * std::sin(1e3 * t)};
    };
    Dopri5<double, 2, 1> stepper;
    stepper.step(rough_book, 0.0, {1.0, 0.0}, {1.0, 0.0}, 0.01);
    CHECK(stepper.error({1.0, 0.0}, 0.01, 1e-6, 1e-6) < 1);
}

// The larger value at the two ends of a step sets the tolerance.
TEST_CASE(the_tolerance_is_that_of_the_larger_end) {
    Dopri5<double, 1, 1> stepper;
    stepper.k = {Scalar{1.0}};
    stepper.f1 = {0.0};
    for (const auto& [y, y1] : {std::pair(1e-6, -4.0), std::pair(-4.0, 1e-6)}) {
        stepper.y1 = {y1};
        const double tolerance = 1e-3 + 1e-2 * 4;
        CHECK(std::abs(stepper.error({y}, 0.1, 1e-2, 1e-3) / (0.1 * 71 / 57600 / tolerance) - 1) <= 1e-14);
    }
}

// ---- the arm

using Motion6 = State<double, motion_size>;

static Plant<double> swinging_arm() {
    Params params = unequal_params()
                        .set("arm.damping", {0.1, 0.05, 0.02})
                        .set("arm.gravity", {0.3, -0.6, -3})
                        .set("arm.link1.inertia_axial", 0.3);
    return make_setup(params).plant;
}

template <class Method>
static double observed_order(int coarsest) {
    const Plant<double> plant = swinging_arm();
    const Motion6 start{0.4, 0.7, -0.9, 0.6, -0.5, 0.8};
    const auto end = [&]<class M>(M, int steps) {
        return end_of<M, motion_size>(RightHandSide<double, double>(plant), start, 1.0, steps);
    };
    const Motion6 truth = end(Dp5(), 5000);
    std::vector<double> errors;
    for (int i = 0; i < 4; ++i) {
        const Motion6 y = end(Method(), coarsest << i);
        double square = 0;
        for (std::size_t k = 0; k < motion_size; ++k) square += (y[k] - truth[k]) * (y[k] - truth[k]);
        errors.push_back(std::sqrt(square));
    }
    return order(errors);
}

TEST_CASE(order_on_the_arm) {
    const double rk4 = observed_order<Rk4>(200), dopri5 = observed_order<Dp5>(60);
    CHECK(std::abs(rk4 - 4) <= 0.1, "rk4: " << rk4);
    CHECK(std::abs(dopri5 - 5) <= 0.1, "dopri5: " << dopri5);
}

// ---- step control

TEST_CASE(the_next_step_follows_the_fifth_root_of_the_error_between_its_bounds) {
    for (const double error : {1e-4, 1e-2, 0.3, 1.0, 7.0, 1000.0})
        CHECK(std::abs(step_factor(error) - 0.9 / std::pow(error, 0.2)) <= 1e-14);
    CHECK(step_factor(0.0) == 10);
    CHECK(step_factor(1e-300) == 10);
    CHECK(step_factor(1e9) == 0.2);
    CHECK(step_factor(HUGE_VAL) == 0.2);
}

TEST_CASE(a_tolerance_a_hundred_thousand_times_finer_takes_ten_times_the_steps) {
    const auto steps = [](double rtol) {
        const Run run = unequal_params()
                            .set("solver.rtol", rtol)
                            .set("solver.atol", rtol / 100)
                            .set("time.stop", 5)
                            .set("arm.link1.inertia_axial", 0.3)
                            .run();
        CHECK(run.steps.rejected < run.steps.accepted / 3);
        CHECK(run.steps.evaluations == 2 + 6 * (run.steps.accepted + run.steps.rejected));
        return double(run.steps.accepted);
    };
    const double ratio = steps(1e-12) / steps(1e-7);
    CHECK(std::abs(ratio - 10) <= 1, ratio);
}

// Stiff friction rejects steps in a row: one that is rejected must not grow again at once.
TEST_CASE(a_step_does_not_grow_right_after_a_rejected_one) {
    Params params = unequal_params().set("initial.qd", {0.5, -0.4, 0.3}).set("arm.link1.inertia_axial", 0.3);
    params.set("arm.friction", {0.5, 0.4, 0.3}).set("arm.friction_velocity", 0.01).set("solver.rtol", 1e-6);
    const Run run = params.set("time.stop", 5).run();
    CHECK(run.steps.rejected > run.steps.accepted / 5);
    CHECK(run.steps.rejected < run.steps.accepted / 3);
}

TEST_SUITE_END()

}  // namespace arm3r
