#include <map>

#include "arm3r/model/dynamics.hpp"
#include "arm3r/model/recursion.hpp"
#include "check.hpp"
#include "fixtures.hpp"

namespace arm3r {

TEST_SUITE(recursion)

// The largest error of each quantity, relative to 1 + its largest entry.
class Worst {
public:
    template <class M>
    void compare(const char* what, const M& a, const M& b) {
        note(what, (a - b).cwiseAbs().maxCoeff() / (1 + a.cwiseAbs().maxCoeff()));
    }
    void check(double limit) const {
        for (const auto& [what, error] : errors_) CHECK(error <= limit, what << ": " << error);
    }

private:
    void note(const char* what, double error) {
        double& worst = errors_[what];
        if (!(error <= worst)) worst = error;
    }
    std::map<std::string_view, double> errors_;
};

static const Vec3<double> zero(0, 0, 0);

static Arm<double> without_friction(Arm<double> arm) {
    arm.damping = zero;
    arm.has_damping = arm.has_dry_friction = false;
    return arm;
}

static Mat3<double> mass_matrix_by_recursion(const Arm<double>& arm, const Vec3<double>& q,
                                             const Vec3<double>& at_rest) {
    Mat3<double> M;
    for (int j = 0; j < 3; ++j)
        M.col(j) = recursion_inverse_dynamics<double, double>(arm, q, zero, Vec3<double>::Unit(j), zero) - at_rest;
    return M;
}

static void compare_state(Worst& worst, const Arm<double>& arm, const Arm<double>& frictionless, const Vec3<double>& q,
                          Random& random) {
    const Vec3<double> qd = random.vector(-3, 3), u = random.vector(-20, 20), f = random.vector(-20, 20);
    const Pose<double> p = pose(q);
    const Vec3<double> at_rest = recursion_gravity_torque(frictionless, q);
    const TipSensor<double> sensor = tip_sensor(arm, q, qd);
    worst.compare("tip position", sensor.position, tip_position(arm, p));
    worst.compare("J qd", sensor.velocity, times(jacobian(arm, p), qd));
    worst.compare("tip velocity", sensor.velocity, tip_velocity(arm, p, qd));
    worst.compare("tau_g", at_rest, gravity_torque(arm, p));
    worst.compare("M", mass_matrix_by_recursion(frictionless, q, at_rest), mass_matrix(arm, p));
    worst.compare("C qd", minus(recursion_inverse_dynamics(frictionless, q, qd, zero, zero), at_rest),
                  velocity_product(arm, p, qd));
    worst.compare("inverse dynamics", recursion_inverse_dynamics(arm, q, qd, u, f), inverse_dynamics(arm, p, qd, u, f));
    worst.compare("forward dynamics", recursion_forward_dynamics(arm, q, qd, u, f), forward_dynamics(arm, p, qd, u, f));
}

// 1000 states of each of 1000 arms; `angles` draws q.
template <class F>
static void compare_a_million(double limit, F angles) {
    Random random(11);
    Worst worst;
    for (int i = 0; i < 1000; ++i) {
        const Arm<double> arm = random_params(random).arm(), frictionless = without_friction(arm);
        for (int j = 0; j < 1000; ++j) compare_state(worst, arm, frictionless, angles(random), random);
    }
    worst.check(limit);
}

TEST_CASE(agrees_with_the_closed_form_on_1e6_states) {
    compare_a_million(1e-12, [](Random& random) { return random.vector(-100, 100); });
}

// Most of that difference is the rounding of q2 + q3. On a grid the sum is exact, and the formulas stand alone.
TEST_CASE(agrees_four_times_better_where_q2_plus_q3_is_exact) {
    compare_a_million(2.5e-13, [](Random& random) -> Vec3<double> {
        return (random.vector(-100, 100) * 0x1p40).array().round() * 0x1p-40;
    });
}

TEST_CASE(centres_and_elbow_are_where_the_chain_puts_them) {
    Random random(12);
    Worst worst;
    for (int i = 0; i < 1000; ++i) {
        const Arm<double> arm = random_params(random).arm();
        const Vec3<double> q = random.vector(-10, 10);
        const std::array<Body<double>, 3> bodies = chain(arm, q);
        const auto placed = [&](int body, Vec3<double> point) {
            for (; body >= 0; --body) point = plus(bodies[body].origin, times(bodies[body].R, point));
            return point;
        };
        const Mat3<double> rows = centres_of_mass(arm, pose(q));
        for (int body = 0; body < 3; ++body)
            worst.compare("centre", placed(body, bodies[body].com), Vec3<double>(rows.row(body).transpose()));
        worst.compare("elbow", placed(2, zero), elbow_position(arm, pose(q)));
    }
    worst.check(1e-14);
}

TEST_SUITE_END()

}  // namespace arm3r
