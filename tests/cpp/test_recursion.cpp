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

// Two joints that turn and one that slides away from both axes, which carries a point: the textbook's spherical
// coordinates, with the azimuth q1, the elevation q2 and the distance q3.
TEST_CASE(a_joint_that_slides_has_the_equations_of_spherical_coordinates) {
    Random random(13);
    Worst worst;
    for (int i = 0; i < 1000; ++i) {
        const Vec3<double> q = random.vector(0.2, 2), qd = random.vector(-3, 3), qdd = random.vector(-3, 3);
        const double m = random.vector(0.1, 3)[0], g = 9.8, r = q[2];
        Arm<double> arm = without_friction(random_params(random).arm());
        arm.is_elbow = false;
        arm.base_height = arm.payload = arm.link3.length = 0;
        arm.armature = zero;
        arm.gravity = {0, 0, -g};
        std::array<Body<double>, 3> bodies = chain(arm, q);
        for (Body<double>& body : bodies) body.mass = 0, body.com = body.inertia = body.products = zero;
        bodies[2].R = from_rows<double>({0, 0, 1}, {1, 0, 0}, {0, 1, 0});  // z along link 2
        bodies[2].origin = {r, 0, 0};
        bodies[2].slides = true;
        bodies[2].mass = m;

        const double C1 = std::cos(q[0]), S1 = std::sin(q[0]), C2 = std::cos(q[1]), S2 = std::sin(q[1]);
        const Vec3<double> out(C2 * C1, C2 * S1, S2), up(-S2 * C1, -S2 * S1, C2), around(-S1, C1, 0);
        const TipSensor<double> sensor = tip_sensor(bodies, zero, qd);
        worst.compare("position", sensor.position, Vec3<double>(r * out));
        worst.compare("velocity", sensor.velocity,
                      Vec3<double>(qd[2] * out + r * qd[1] * up + r * C2 * qd[0] * around));
        const Vec3<double> acceleration =
            (qdd[2] - r * qd[1] * qd[1] - r * C2 * C2 * qd[0] * qd[0] + g * S2) * out +
            (r * qdd[1] + 2 * qd[2] * qd[1] + r * S2 * C2 * qd[0] * qd[0] + g * C2) * up +
            (r * C2 * qdd[0] + 2 * qd[2] * C2 * qd[0] - 2 * r * S2 * qd[0] * qd[1]) * around;
        const Vec3<double> f = random.vector(-9, 9), force = m * acceleration - f;
        worst.compare("tau", recursion_inverse_dynamics(arm, bodies, qd, qdd, f),
                      Vec3<double>(r * C2 * dot(force, around), r * dot(force, up), dot(force, out)));
    }
    worst.check(1e-13);
}

TEST_SUITE_END()

}  // namespace arm3r
