#include "arm3r/model/dynamics.hpp"
#include "arm3r/model/recursion.hpp"
#include "arm3r/plant.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "linear_algebra.hpp"

namespace arm3r {

// Identities that hold for every arm, and derivatives by Dual.
TEST_SUITE(dynamics)

struct Case {
    Params params;
    Arm<double> arm;
    Vec3<double> q, qd, tau, f;
    Pose<double> p;

    explicit Case(Random& random, bool is_elbow = false)
        : params(is_elbow ? random_elbow_params(random) : random_params(random)),
          arm(params.arm()),
          q(random.vector(-4, 4)),
          qd(random.vector(-5, 5)),
          tau(random.vector(-20, 20)),
          f(random.vector(-30, 30)),
          p(pose(q)) {}
};

template <class F>
static void for_planar_cases(unsigned seed, F check) {
    Random random(seed);
    for (int i = 0; i < 1000; ++i) check(Case(random));
}

// Planar arms, then elbow arms.
template <class F>
static void for_random_cases(unsigned seed, F check) {
    for_planar_cases(seed, check);
    Random random(100 + seed);
    for (int i = 0; i < 1000; ++i) check(Case(random, true));
}

static bool close(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double tolerance = 1e-12) {
    return distance(a, b) <= tolerance * (1 + a.cwiseAbs().maxCoeff());
}

static bool close(double a, double b) { return std::abs(a - b) <= 1e-12 * (1 + std::abs(a)); }

template <class M>
static Eigen::MatrixXd linearization(const M& matrix, int i = 0) {
    Eigen::MatrixXd result(matrix.rows(), matrix.cols());
    for (int r = 0; r < matrix.rows(); ++r)
        for (int c = 0; c < matrix.cols(); ++c) result(r, c) = matrix(r, c).slope[i];
    return result;
}

// Columns: derivatives by q1, q2, q3.
static Eigen::Matrix3d gradient(const Vec3<Dual<3>>& v) {
    Eigen::Matrix3d columns;
    for (int j = 0; j < 3; ++j) columns.col(j) = linearization(v, j);
    return columns;
}

// ---- kinematics

TEST_CASE(jacobian_is_the_derivative_of_the_tip) {
    for_random_cases(1, [](const Case& c) {
        CHECK(close(gradient(tip_position(c.arm, pose(variables(c.q)))), jacobian(c.arm, c.p)));
    });
}

TEST_CASE(jacobian_dot_is_the_derivative_of_the_jacobian) {
    for_random_cases(2, [](const Case& c) {
        CHECK(close(linearization(jacobian(c.arm, pose(moving(c.q, c.qd)))), jacobian_dot(c.arm, c.p, c.qd)));
    });
}

TEST_CASE(tip_velocity_is_the_jacobian_times_the_rates) {
    for_random_cases(3,
                     [](const Case& c) { CHECK(close(jacobian(c.arm, c.p) * c.qd, tip_velocity(c.arm, c.p, c.qd))); });
}

static Mat3<Dual<1>> orientation(const Arm<double>& arm, const Vec3<double>& q, const Vec3<double>& qd, int body) {
    const std::array<Body<Dual<1>>, 3> bodies = chain(arm, moving(q, qd));
    Mat3<Dual<1>> R = bodies[0].R;
    for (int i = 1; i <= body; ++i) R = R * bodies[i].R;
    return R;
}

static Vec3<double> angular_velocity(const Mat3<Dual<1>>& R) {  // of Rdot R^T = skew(omega)
    const Eigen::Matrix3d rotation = R.unaryExpr([](const Dual<1>& x) { return x.number; });
    const Eigen::Matrix3d skew = linearization(R) * rotation.transpose();
    return {skew(2, 1), skew(0, 2), skew(1, 0)};
}

TEST_CASE(angular_jacobian_turns_link_3_as_the_rotation_matrices_do) {
    for_random_cases(4, [](const Case& c) {
        CHECK(close(angular_velocity(orientation(c.arm, c.q, c.qd, 2)), angular_jacobian(c.arm, c.p) * c.qd));
    });
}

TEST_CASE(manipulability_is_the_determinant_and_the_inverse_inverts) {
    for_random_cases(5, [](const Case& c) {
        const Eigen::Matrix3d J = jacobian(c.arm, c.p);
        CHECK(close(std::abs(determinant(J)), manipulability(c.arm, c.p)));
        if (manipulability(c.arm, c.p) > 1e-3)
            CHECK(close(Eigen::Matrix3d::Identity(), inverse_jacobian(c.arm, c.p) * J, 1e-11));
    });
}

TEST_CASE(inverse_kinematics_has_four_branches_that_reach_the_point) {
    for_planar_cases(6, [](const Case& c) {
        const Vec3<double> tip = tip_position(c.arm, c.p);
        const double out = std::hypot(tip[0], tip[1]), up = tip[2] - c.arm.base_height;
        bool came_back = false;
        for (const bool front : {true, false}) {
            for (const bool elbow_up : {true, false}) {
                const auto [q, cos_q3] = inverse_kinematics(c.arm, tip, front, elbow_up);
                const Vec3<double> elbow = elbow_position(c.arm, pose(q));
                const double elbow_out = (elbow[0] * tip[0] + elbow[1] * tip[1]) / out,
                             elbow_at = elbow[2] - c.arm.base_height;
                CHECK(std::abs(cos_q3) <= 1 + 1e-14);
                CHECK(close(tip, tip_position(c.arm, pose(q))));
                CHECK((std::cos(q[0]) * tip[0] + std::sin(q[0]) * tip[1] > 0) == front);
                CHECK((elbow_at * out - elbow_out * up > 0) == elbow_up);
                came_back |= distance((q - c.q).array().sin(), Vec3<double>(0, 0, 0)) < 1e-7 &&
                             distance((q - c.q).array().cos(), Vec3<double>(1, 1, 1)) < 1e-7;
            }
        }
        CHECK(came_back);
    });
}

// The elbow is above the line from joint 2 to the tip; the tip is before axis 1 along u, or behind it.
TEST_CASE(inverse_kinematics_of_an_elbow_arm_has_four_branches_too) {
    Random random(106);
    for (int i = 0; i < 1000; ++i) {
        const Case c(random, true);
        const Vec3<double> tip = tip_position(c.arm, c.p);
        int reached = 0;
        bool came_back = false;
        for (const bool front : {true, false}) {
            for (const bool elbow_up : {true, false}) {
                const auto [q, cosine] = inverse_kinematics(c.arm, tip, front, elbow_up);
                CHECK((reach_excess(c.arm, tip, front) <= 1e-14) == (std::abs(cosine) <= 1 + 1e-13));
                if (std::abs(cosine) > 1) continue;
                const Pose<double> p = pose(q);
                const elbow_arm::Reaches<double> m = elbow_arm::reaches(c.arm, p);
                CHECK(close(tip, tip_position(c.arm, p), 1e-11));
                CHECK((radius(c.arm, p) > 0) == front);
                CHECK((m.h2 * (m.r2 + m.r3) - m.r2 * (m.h2 + m.h3) > 0) == (elbow_up == (m.r2 + m.r3 > 0)));
                came_back |= distance((q - c.q).array().sin(), Vec3<double>(0, 0, 0)) < 1e-6 &&
                             distance((q - c.q).array().cos(), Vec3<double>(1, 1, 1)) < 1e-6;
                ++reached;
            }
        }
        CHECK(came_back);
        CHECK(reached >= 2);
    }
}

TEST_CASE(inverse_kinematics_distinguishes_points_out_of_reach) {
    for_planar_cases(7, [](const Case& c) {
        const double a2 = c.arm.link2.length, a3 = c.arm.link3.length;
        const Vec3<double> shoulder(0, 0, c.arm.base_height), direction = c.f.normalized();
        const auto cosine_at = [&](double reach) {
            return inverse_kinematics(c.arm, Vec3<double>(shoulder + reach * direction), true, true).cos_q3;
        };
        CHECK(cosine_at((a2 + a3) * (1 + 1e-9)) > 1);
        CHECK(std::abs(cosine_at((a2 + a3) * (1 - 1e-9))) < 1);
        CHECK(cosine_at(std::abs(a2 - a3) * (1 - 1e-9)) < -1);
        CHECK(std::abs(cosine_at(std::abs(a2 - a3) * (1 + 1e-9))) < 1);
    });
}

// ---- dynamics

TEST_CASE(the_rate_of_M_is_C_plus_its_transpose) {
    for_random_cases(8, [](const Case& c) {
        const Eigen::Matrix3d Mdot = linearization(mass_matrix(c.arm, pose(moving(c.q, c.qd))));
        const Eigen::Matrix3d C = coriolis_matrix(c.arm, c.p, c.qd);
        const Eigen::Matrix3d N = Mdot - 2 * C;
        CHECK(close(Mdot, C + C.transpose()));
        CHECK(close(N, -N.transpose()));
        CHECK(close(C * c.qd, velocity_product(c.arm, c.p, c.qd)));
    });
}

// Christoffel symbols from the derivatives of M: of all C with the same C qd, this one.
TEST_CASE(C_is_made_of_christoffel_symbols) {
    for_random_cases(9, [](const Case& c) {
        const Mat3<Dual<3>> M = mass_matrix(c.arm, pose(variables(c.q)));
        Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k)
                    C(i, j) += 0.5 * (M(i, j).slope[k] + M(i, k).slope[j] - M(j, k).slope[i]) * c.qd[k];
        CHECK(close(C, coriolis_matrix(c.arm, c.p, c.qd)));
    });
}

TEST_CASE(gravity_torque_is_the_derivative_of_the_potential_energy) {
    for_random_cases(10, [](const Case& c) {
        const Dual<3> U = potential_energy(c.arm, pose(variables(c.q)));
        CHECK(close(Vec3<double>(U.slope.data()), gravity_torque(c.arm, c.p)));
    });
}

// Both energies once more, summed over bodies: link 3 and the payload apart.
TEST_CASE(energies_are_the_sums_over_bodies) {
    Random random(11);
    for (int i = 0; i < 1000; ++i) {
        Case c(random);
        const double payload = param(c.params, "arm.payload.mass");
        const Arm<double> bare = c.params.set("arm.payload.mass", 0).arm();
        const std::array<Body<Dual<1>>, 3> bodies = chain(bare, moving(c.q, c.qd));
        double kinetic = 0, potential = 0;
        const auto add_point = [&](double mass, int body, Vec3<Dual<1>> point) {
            for (int j = body; j >= 0; --j) point = plus(bodies[j].origin, times(bodies[j].R, point));
            kinetic += 0.5 * mass * linearization(point).squaredNorm();
            for (int k = 0; k < 3; ++k) potential -= mass * c.arm.gravity[k] * point[k].number;
        };
        for (int body = 0; body < 3; ++body) {
            add_point(bodies[body].mass.number, body, bodies[body].com);
            const Mat3<Dual<1>> R = orientation(bare, c.q, c.qd, body);
            const Eigen::Matrix3d to_body = R.unaryExpr([](const Dual<1>& x) { return x.number; }).transpose();
            const Vec3<double> omega = to_body * angular_velocity(R);
            for (int k = 0; k < 3; ++k) kinetic += 0.5 * bodies[body].inertia[k].number * omega[k] * omega[k];
        }
        add_point(payload, 2, {Dual<1>(bare.link3.length), Dual<1>(0.0), Dual<1>(0.0)});
        for (int k = 0; k < 3; ++k) kinetic += 0.5 * bare.armature[k] * c.qd[k] * c.qd[k];
        CHECK(close(kinetic, kinetic_energy(c.arm, c.p, c.qd)));
        CHECK(close(potential, potential_energy(c.arm, c.p)));
    }
}

// A point mass pushes back on the tip with its inertia and its weight.
TEST_CASE(payload_is_a_force_on_the_bare_arm) {
    Random random(12);
    for (int i = 0; i < 1000; ++i) {
        Case c(random);
        const double payload = param(c.params, "arm.payload.mass");
        const Arm<double> bare = c.params.set("arm.payload.mass", 0).arm();
        const Vec3<double> qdd = c.tau;
        const Vec3<double> acceleration = jacobian(bare, c.p) * qdd + jacobian_dot(bare, c.p, c.qd) * c.qd;
        const Vec3<double> push = c.f - payload * (acceleration - bare.gravity);
        CHECK(close(recursion_inverse_dynamics(bare, c.q, c.qd, qdd, push),
                    inverse_dynamics(c.arm, c.p, c.qd, qdd, c.f)));
    }
}

TEST_CASE(dynamics_are_those_of_the_recursion) {
    for_random_cases(20, [](const Case& c) {
        const Vec3<double> qdd = recursion_forward_dynamics(c.arm, c.q, c.qd, c.tau, c.f);
        CHECK(close(qdd, forward_dynamics(c.arm, c.p, c.qd, c.tau, c.f), 1e-9));
        CHECK(close(recursion_inverse_dynamics(c.arm, c.q, c.qd, qdd, c.f),
                    inverse_dynamics(c.arm, c.p, c.qd, qdd, c.f), 1e-11));
        const TipSensor<double> sensor = tip_sensor(c.arm, c.q, c.qd);
        CHECK(close(sensor.position, tip_position(c.arm, c.p)));
        CHECK(close(sensor.velocity, tip_velocity(c.arm, c.p, c.qd)));
    });
}

// All their terms, once, with zeros for what only the elbow arm has.
TEST_CASE(a_planar_arm_is_an_elbow_arm_without_offsets) {
    for_planar_cases(21, [](const Case& c) {
        Params params = c.params;
        const Vec3<double> zero(0, 0, 0);
        const auto number = [&](const std::string& key) { return param(c.params, key); };
        params.choose("arm.model", "elbow").set("arm.base.position", {0, 0, number("arm.base_height")});
        params.set("arm.link3.tip", {number("arm.link3.length"), 0, 0});
        params.set("arm.link1.com", {0, 0, number("arm.link1.com") - number("arm.base_height")});
        params.set("arm.link1.inertia", {0, 0, number("arm.link1.inertia_axial"), 0, 0, 0});
        for (const std::string link : {"arm.link2", "arm.link3"}) {
            const Link<double>& stated = link == "arm.link2" ? c.arm.link2 : c.arm.link3;
            params.set(link + ".mass", stated.mass).set(link + ".com", {stated.com, 0, 0});
            params.set(link + ".inertia", {stated.inertia[0], stated.inertia[1], stated.inertia[2], 0, 0, 0});
        }
        const Arm<double> elbow = params.arm();
        REQUIRE(elbow.is_elbow);
        CHECK(close(mass_matrix(c.arm, c.p), mass_matrix(elbow, c.p)));
        CHECK(close(forward_dynamics(c.arm, c.p, c.qd, c.tau, c.f), forward_dynamics(elbow, c.p, c.qd, c.tau, c.f),
                    1e-11));
        CHECK(close(tip_position(c.arm, c.p), tip_position(elbow, c.p)));
        CHECK(close(jacobian(c.arm, c.p), jacobian(elbow, c.p)));
        CHECK(close(potential_energy(c.arm, c.p), potential_energy(elbow, c.p)));
        CHECK(close(zero, velocity_product(c.arm, c.p, c.qd) - velocity_product(elbow, c.p, c.qd)));
    });
}

TEST_CASE(forward_dynamics_inverts_inverse_dynamics) {
    for_random_cases(13, [](const Case& c) {
        const Vec3<double> qdd = forward_dynamics(c.arm, c.p, c.qd, c.tau, c.f);
        CHECK(close(c.tau, inverse_dynamics(c.arm, c.p, c.qd, qdd, c.f), 1e-11));
    });
}

TEST_CASE(energy_changes_by_what_flows_in) {
    for_random_cases(14, [](const Case& c) {
        const Vec3<double> qdd = forward_dynamics(c.arm, c.p, c.qd, c.tau, c.f);
        const Pose<Dual<1>> p = pose(moving(c.q, c.qd));
        const double rate = (kinetic_energy(c.arm, p, moving(c.qd, qdd)) + potential_energy(c.arm, p)).slope[0];
        const double in =
            dot(c.qd, c.tau) + dot(tip_velocity(c.arm, c.p, c.qd), c.f) - dot(c.qd, friction_torque(c.arm, c.qd));
        CHECK(std::abs(rate - in) <= 1e-10 * (1 + std::abs(in)));
    });
}

TEST_CASE(friction_always_takes_energy) {
    for_random_cases(15, [](const Case& c) {
        const Vec3<double> tau_f = friction_torque(c.arm, c.qd);
        for (int i = 0; i < 3; ++i) {
            CHECK(tau_f[i] * c.qd[i] > 0);
            CHECK(close(tau_f[i],
                        c.arm.damping[i] * c.qd[i] + c.arm.friction[i] * std::tanh(c.qd[i] / c.arm.friction_velocity)));
        }
    });
}

// Plant and controller each with a gravity of its own, upright or oblique.
TEST_CASE(the_equation_of_motion_takes_any_gravity) {
    Random random(18);
    const Vec3<double> upright(0, 0, -9), oblique(2, -3, -7);
    for (const auto& [feels, compensates] : {std::pair(upright, oblique), std::pair(oblique, upright)}) {
        for (int i = 0; i < 100; ++i) {
            Case c(random);
            c.params.set("arm.gravity", feels).choose("controller.type", "gravity_compensation");
            const Plant<double> plant = make_setup(c.params.set("controller.gravity", compensates)).plant;
            RightHandSide<double, double> rhs(plant);
            const State<double, motion_size> y{c.q[0], c.q[1], c.q[2], c.qd[0], c.qd[1], c.qd[2]};
            State<double, motion_size> dy;
            rhs.begin_step(y);
            rhs(0.0, y, dy);
            const Vec3<double> tau = recursion_gravity_torque(plant.controller.model, c.q);
            CHECK(close(recursion_forward_dynamics(plant.arm, c.q, c.qd, tau, Vec3<double>(0, 0, 0)),
                        Vec3<double>(dy[3], dy[4], dy[5]), 1e-11));
        }
    }
}

// What a plant of common terms is computed by gives the numbers of the formulas for every plant, but for their rounding.
TEST_CASE(common_terms_are_the_terms_of_every_plant) {
    Random random(19);
    int pressed = 0;
    for (const std::string controller : {"none", "gravity_compensation", "constant"}) {
        for (int i = 0; i < 100; ++i) {
            Params params;
            if (i % 2 == 0) params = random_elbow_params(random);
            else randomise_link(params, "arm.link2", random), randomise_link(params, "arm.link3", random);
            params.choose("arm.convention", "slide").set("arm.base.rotation", {0, 0, random.in(-3, 3)});
            for (const char* key : {"arm.damping", "arm.friction"}) params.set(key, {0, 0, 0});
            const Vec3<double> q = random.vector(-1, 1), qd = random.vector(-5, 5);
            params.set("wall", 1).set("wall.acts_on_arm", i % 3 != 0).set("controller.torque", random.vector(-20, 20));
            params.set("wall.normal", random.vector(-1, 1)).set("wall.point", random.vector(-2, 2));
            params.choose("wall.motion.type", i % 4 < 2 ? "constant" : "fixed").set("wall.size", {4, 6});
            params.set("wall.motion.velocity", random.vector(-0.1, 0.1)).set("wall.face_offset", random.in(0, 0.1));
            params.set("arm.base_height", random.in(0, 1)).set("arm.gravity", {0, 0, random.in(-10, 10)});
            params.set("controller.gravity", {0, 0, random.in(-10, 10)});
            params.choose("controller.type", controller).set("arm.payload.mass", random.in(0, 2));
            const Plant<double> plant = make_setup(params).plant;
            REQUIRE(has_common_terms(plant));
            RightHandSide<double, double> rhs(plant);
            rhs.force_mode = plant.acts_on_arm ? ContactForceMode::each_stage : ContactForceMode::none;
            const State<double, state_size> y{q[0], q[1], q[2], qd[0], qd[1], qd[2]};
            State<double, state_size> every{}, common{};
            const double t = random.in(0, 10);
            rhs.begin_step(y);
            rhs(t, y, every);
            Vec3<double> tau;
            rhs.derivative_at<Terms::common>(t, y, common, tau);
            double scale = 1;
            for (const double rate : every) scale = std::max(scale, std::abs(rate));
            for (std::size_t j = 0; j < state_size; ++j) CHECK(std::abs(every[j] - common[j]) <= 1e-12 * scale);
            pressed += every[work_of_wall] != 0;
        }
    }
    CHECK(pressed > 25);
}

// ---- seen from the tip

TEST_CASE(a_force_on_the_tip_accelerates_it_by_the_mobility) {
    for_random_cases(16, [](const Case& c) {
        const auto acceleration = [&](const Vec3<double>& f) -> Vec3<double> {
            return jacobian(c.arm, c.p) * forward_dynamics(c.arm, c.p, c.qd, c.tau, f);
        };
        const Eigen::Vector3d gained = acceleration(c.f) - acceleration({0, 0, 0});
        CHECK(close(gained, tip_mobility(c.arm, c.p) * c.f, 1e-11));
    });
}

TEST_CASE(operational_space_inertia_inverts_the_mobility) {
    for_random_cases(17, [](const Case& c) {
        if (manipulability(c.arm, c.p) < 1e-2) return;
        const Eigen::Matrix3d W = tip_mobility(c.arm, c.p), L = operational_space_inertia(c.arm, c.p);
        const Vec3<double> n = c.f.normalized();
        CHECK(close(Eigen::Matrix3d::Identity(), L * W, 1e-9));
        CHECK(close(L, L.transpose()));
        CHECK(close(1 / n.dot(W * n), effective_mass(c.arm, c.p, n)));
    });
}

TEST_SUITE_END()

}  // namespace arm3r
