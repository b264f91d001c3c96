#include "arm3r/control/control_laws.hpp"

#include "arm3r/lanes.hpp"
#include "arm3r/numbers/widths.hpp"
#include "check.hpp"
#include "control/compiled_laws.hpp"
#include "fixtures.hpp"
#include "linear_algebra.hpp"

namespace arm3r {

// Each law against its formula in matrices with explicit inverses, and against the motion that it promises.
TEST_SUITE(laws)

using evaluated::Matrix;
using evaluated::Vector;
using Memory = std::array<double, law_memory>;
using Slopes = Dual<derivatives_per_pass>;

static bool close(const Vector& a, const Vector& b, double tolerance = 1e-10) {
    return distance(a, b) <= tolerance * (1 + distance(a, {0, 0, 0}));
}

static bool close(double a, double b, double tolerance = 1e-10) {
    return std::abs(a - b) <= tolerance * (1 + std::abs(a));
}

static double farness(const Vector& q, const Arm<double>& arm) {  // from singular poses
    const double r = arm.link2.length * std::cos(q[1]) + arm.link3.length * std::cos(q[1] + q[2]);
    return std::min(std::abs(std::sin(q[2])), std::abs(r) / (arm.link2.length + arm.link3.length));
}

// A controller with its own model and random gains, and what it senses. All that may differ does.
struct RowContext {
    Controller<double> controller{};
    Measurement<double> sensed{};
    Memory memory{};

    RowContext(Random& random, ControllerType type) {
        each_law_number([&](double& x) { x = random.in(0.5, 2); }, controller);
        Gains<double>& gains = controller.gains;
        gains.integral_limit = 100;
        gains.plane_normal = random.vector(-1, 1).normalized();
        gains.tank_low = 0.2;
        gains.tank_high = 0.6;
        gains.tank_capacity = 1.5;
        controller.type = type;
        controller.model = random_params(random).arm();
        controller.compensates_gravity = controller.cancels_force = controller.has_tank = true;
        Reference<double>& reference = controller.reference;
        reference.path = Path::minimum_jerk;
        reference.in_joints = type == ControllerType::joint_pd || type == ControllerType::computed_torque ||
                              type == ControllerType::joint_stiffness;
        reference.from = random.vector(-1, 1);
        reference.to = random.vector(-1, 1);
        reference.force_profile = ForceProfile::sinusoid;

        sensed.t = reference.start + reference.duration * random.in(0.1, 0.9);
        do sensed.q = random.vector(-4, 4);
        while (farness(sensed.q, controller.model) < 0.2);
        sensed.qd = random.vector(-2, 2);
        sensed.pose = pose(sensed.q);
        sensed.f_on_tip = random.vector(-10, 10);
        sensed.f_cancelled = random.vector(-10, 10);
        sensed.n = random.vector(-1, 1).normalized();
        sensed.face = random.in(-1, 1);
        sensed.contact = 1;
        sensed.force_phase = random.in(0, 1) < 0.7;
        for (double& number : memory) number = random.in(-0.9, 0.9);
        if (type == ControllerType::energy_tank) memory[0] = random.in(0, 1.6);
    }

    // Exact model and exact sensors.
    void trust_everything() { sensed.f_cancelled = sensed.f_on_tip; }

    Command<double> command() const {
        Command<double> result;
        control_law(controller, sensed, memory, result);
        return result;
    }
    Vector tau() const { return command().tau; }
};

template <class F>
static void for_scenes(ControllerType type, F check) {
    Random random(unsigned(type) + 1);
    for (int i = 0; i < 300; ++i) check(RowContext(random, type));
}

// The formulas' symbols, in matrices.
struct Symbols {
    const Controller<double>& controller;
    const Gains<double>& g;
    const Measurement<double>& s;
    Matrix M, C, J, Jd, Ji, Lambda, mu, S_f, S_p;
    Vector qd, tau_g, tau_f, p, x, xd, x_d, xd_d, xdd_d, p_in;
    double f_d, e_f, z;

    explicit Symbols(const RowContext& scene)
        : controller(scene.controller),
          g(controller.gains),
          s(scene.sensed),
          qd(s.qd),
          p_in(-Vector(s.n)),
          z(scene.memory[0]) {
        const Arm<double>& model = controller.model;
        M = mass_matrix(model, s.pose);
        C = coriolis_matrix(model, s.pose, s.qd);
        J = jacobian(model, s.pose);
        Jd = jacobian_dot(model, s.pose, s.qd);
        Ji = J.inverse();
        Lambda = (J * M.inverse() * J.transpose()).inverse();
        mu = Ji.transpose() * C * Ji - Lambda * Jd * Ji;
        tau_g = gravity_torque(model, s.pose);
        tau_f = friction_torque(model, s.qd);
        p = Ji.transpose() * tau_g;
        x = tip_position(model, s.pose);
        xd = J * qd;
        const DesiredMotion<double> desired = desired_motion_at(controller.reference, s.t);
        x_d = desired.position;
        xd_d = desired.velocity;
        xdd_d = desired.acceleration;
        S_f = outer_product(s.force_phase * p_in, p_in);
        S_p = evaluated::identity() - S_f;
        f_d = desired_force_at(controller.reference, s.t);
        e_f = f_d + p_in.dot(s.f_on_tip);
    }

    Vector ID(const Vector& a) const {
        return M * Ji * (a - Jd * qd) + C * qd + tau_g + tau_f - J.transpose() * s.f_cancelled;
    }
    static Matrix diagonal(const Vector& gain) { return evaluated::diagonal(gain); }
    double correction() const { return g.force * e_f + g.force_integral * z; }
    Vector a_m() const { return xdd_d + diagonal(g.velocity) * (xd_d - xd) + diagonal(g.position) * (x_d - x); }
    Vector a_f() const { return p_in * (correction() - g.force_damping * p_in.dot(xd)) / g.force_mass; }
};

// ---- each law is its formula

TEST_CASE(joint_pd_is_its_formula) {
    for_scenes(ControllerType::joint_pd, [](RowContext scene) {
        const Symbols y(scene);
        const Vector pd =
            y.diagonal(y.g.joint_stiffness) * (y.x_d - Vector(y.s.q)) - y.diagonal(y.g.joint_damping) * y.qd;
        CHECK(close(pd + y.tau_g, scene.tau()));
        scene.controller.compensates_gravity = false;
        CHECK(close(pd, scene.tau()));
    });
}

TEST_CASE(computed_torque_is_its_formula) {
    for_scenes(ControllerType::computed_torque, [](RowContext scene) {
        const Symbols y(scene);
        const Vector a =
            y.xdd_d + y.diagonal(y.g.velocity) * (y.xd_d - y.qd) + y.diagonal(y.g.position) * (y.x_d - Vector(y.s.q));
        const Vector tau = y.M * a + y.C * y.qd + y.tau_g + y.tau_f;
        CHECK(close(tau - y.J.transpose() * y.s.f_cancelled, scene.tau()));
        scene.controller.cancels_force = false;
        CHECK(close(tau, scene.tau()));
    });
}

TEST_CASE(resolved_acceleration_is_its_formula) {
    for_scenes(ControllerType::resolved_acceleration, [](RowContext scene) {
        const Symbols y(scene);
        CHECK(close(y.ID(y.a_m()), scene.tau()));
        scene.controller.cancels_force = false;
        CHECK(close(y.ID(y.a_m()) + y.J.transpose() * y.s.f_cancelled, scene.tau()));
    });
}

TEST_CASE(stiffness_is_its_formula) {
    for_scenes(ControllerType::stiffness, [](const RowContext& scene) {
        const Symbols y(scene);
        const Vector force = y.diagonal(y.g.stiffness) * (y.x_d - y.x) - y.diagonal(y.g.damping) * y.xd;
        CHECK(close(y.tau_g + y.J.transpose() * force, scene.tau()));
    });
}

TEST_CASE(joint_stiffness_is_its_formula) {
    for_scenes(ControllerType::joint_stiffness, [](const RowContext& scene) {
        const Symbols y(scene);
        const Matrix J_d = jacobian(y.controller.model, pose(Vec3<double>(y.x_d)));
        const Matrix K_q = J_d.transpose() * y.diagonal(y.g.stiffness) * J_d;
        const Matrix D_q = J_d.transpose() * y.diagonal(y.g.damping) * J_d;
        CHECK(close(y.tau_g + K_q * (y.x_d - Vector(y.s.q)) - D_q * y.qd, scene.tau()));
    });
}

TEST_CASE(impedance_is_its_formula) {
    for_scenes(ControllerType::impedance, [](const RowContext& scene) {
        const Symbols y(scene);
        const Vector force = y.Lambda * y.xdd_d + y.mu * y.xd_d - y.diagonal(y.g.damping) * (y.xd - y.xd_d) -
                             y.diagonal(y.g.stiffness) * (y.x - y.x_d);
        CHECK(close(y.tau_g + y.J.transpose() * force, scene.tau()));
    });
}

TEST_CASE(impedance_about_a_point_is_stiffness_at_a_singular_pose_too) {
    for_scenes(ControllerType::impedance, [](RowContext scene) {
        scene.controller.reference.path = Path::point;
        RowContext stretched = scene;
        stretched.sensed.q[2] = 0;
        stretched.sensed.pose = pose(stretched.sensed.q);
        for (RowContext* it : {&scene, &stretched}) {
            const Vector tau = it->tau();
            it->controller.type = ControllerType::stiffness;
            CHECK(close(it->tau(), tau, 1e-14));
        }
    });
}

TEST_CASE(shaped_impedance_is_its_formula) {
    for_scenes(ControllerType::shaped_impedance, [](const RowContext& scene) {
        const Symbols y(scene);
        const Vector force = Vector(y.s.f_on_tip) - y.diagonal(y.g.damping) * (y.xd - y.xd_d) -
                             y.diagonal(y.g.stiffness) * (y.x - y.x_d);
        CHECK(close(y.ID(y.xdd_d + y.diagonal(y.g.mass).inverse() * force), scene.tau()));
    });
}

TEST_CASE(operational_space_is_its_formula_in_lambda_mu_and_p) {
    for_scenes(ControllerType::operational_space, [](RowContext scene) {
        const Symbols y(scene);
        const Vector inertial = y.Lambda * (y.S_p * y.a_m() + y.S_f * y.a_f()) + y.mu * y.xd + y.p;
        CHECK(close(y.J.transpose() * (inertial - Vector(y.s.f_cancelled)) + y.tau_f, scene.tau()));
        scene.controller.force_term = ForceTerm::feedforward;
        CHECK(close(y.J.transpose() * (inertial + y.S_f * y.p_in * y.f_d) + y.tau_f, scene.tau()));
    });
}

TEST_CASE(hybrid_is_its_formula_in_each_variant) {
    for_scenes(ControllerType::hybrid, [](RowContext scene) {
        const Symbols y(scene);
        scene.controller.variant = Variant::dynamic;
        CHECK(close(y.ID(y.S_p * y.a_m() + y.S_f * y.a_f()), scene.tau()));

        const Vector pressed = y.S_f * y.p_in * (y.f_d + y.correction()) - y.S_f * y.g.force_damping * y.xd;
        const Vector held = y.diagonal(y.g.stiffness) * (y.x_d - y.x) - y.diagonal(y.g.damping) * y.xd;
        scene.controller.variant = Variant::jacobian_transpose;
        CHECK(close(y.tau_g + y.J.transpose() * (y.S_p * held + pressed), scene.tau()));

        const Matrix Kp = y.diagonal(y.g.joint_stiffness), Kv = y.diagonal(y.g.joint_damping);
        const auto in_joints = [&](const Matrix& P) -> Vector {
            return y.tau_g + Kp * P * (y.x_d - y.x) - Kv * P * y.xd + y.J.transpose() * pressed;
        };
        scene.controller.variant = Variant::raibert_craig;
        CHECK(close(in_joints(y.Ji * y.S_p), scene.tau()));

        const auto [inverse, rank] = pseudo_inverse(y.S_p * y.J);
        CHECK(rank == (y.s.force_phase == 1 ? 2 : 3));
        scene.controller.variant = Variant::projected;
        CHECK(close(in_joints(inverse), scene.tau()));
    });
}

TEST_CASE(parallel_is_its_formula) {
    for_scenes(ControllerType::parallel, [](const RowContext& scene) {
        const Symbols y(scene);
        const Vector force = y.diagonal(y.g.damping) * (y.xd_d - y.xd) + y.diagonal(y.g.stiffness) * (y.x_d - y.x) +
                             y.S_f * y.p_in * y.correction();
        CHECK(close(y.ID(y.xdd_d + force / y.g.force_mass), scene.tau()));
    });
}

TEST_CASE(admittance_yields_and_follows_by_its_formulas) {
    for_scenes(ControllerType::admittance, [](RowContext scene) {
        const Symbols y(scene);
        const Vector x_c(scene.memory[0], scene.memory[1], scene.memory[2]);
        const Vector xd_c(scene.memory[3], scene.memory[4], scene.memory[5]);
        const Vector force = Vector(y.s.f_on_tip) + y.f_d * y.p_in - y.diagonal(y.g.damping) * (xd_c - y.xd_d) -
                             y.diagonal(y.g.stiffness) * (x_c - y.x_d);
        const Vector xdd_c = y.xdd_d + y.diagonal(y.g.mass).inverse() * force;
        const Memory rates = scene.command().rates;
        CHECK(close(xd_c, Vector(rates[0], rates[1], rates[2])));
        CHECK(close(xdd_c, Vector(rates[3], rates[4], rates[5])));

        const double w = y.g.inner_bandwidth, d = 2 * y.g.inner_damping_ratio * w;
        scene.controller.inner = Inner::exact;
        CHECK(close(y.ID(xdd_c + d * (xd_c - y.xd) + w * w * (x_c - y.x)), scene.tau()));
        scene.controller.inner = Inner::position;
        CHECK(close(y.ID(w * w * (x_c - y.x) - d * y.xd), scene.tau()));
    });
}

TEST_CASE(admittance_by_joint_pd_pulls_the_joints_on_their_branch) {
    int out_of_first_turn = 0;
    Random shift(77);
    for_scenes(ControllerType::admittance, [&](RowContext scene) {
        const Symbols y(scene);
        const Vector away = shift.vector(-0.1, 0.1);  // stays on the branch: farness is 0.2 and more
        const Vector x_c = tip_position(y.controller.model, pose(Vec3<double>(Vector(y.s.q) + away)));
        std::copy_n(x_c.data(), 3, scene.memory.begin());
        scene.controller.inner = Inner::joint_pd;
        const Vector pd = y.diagonal(y.g.joint_stiffness) * away - y.diagonal(y.g.joint_damping) * y.qd;
        CHECK(close(y.tau_g + pd, scene.tau(), 1e-9));
        out_of_first_turn += y.s.q.cwiseAbs().maxCoeff() > 3.2;
    });
    CHECK(out_of_first_turn > 50);
}

TEST_CASE(admittance_beyond_reach_stretches_the_arm_towards_the_point) {
    for_scenes(ControllerType::admittance, [&](RowContext scene) {
        const Arm<double>& model = scene.controller.model;
        const Vector base(0, 0, model.base_height);
        const Vector x_c = base + 10 * (Vector(tip_position(model, scene.sensed.pose)) - base);
        std::copy_n(x_c.data(), 3, scene.memory.begin());
        scene.controller.gains.joint_stiffness = {1, 1, 1};
        scene.controller.gains.joint_damping = {0, 0, 0};
        scene.controller.inner = Inner::joint_pd;
        const Vector desired = Vector(scene.sensed.q) + scene.tau() - Symbols(scene).tau_g;
        const Vector reached = Vector(tip_position(model, pose(Vec3<double>(desired)))) - base;
        CHECK(std::abs(std::sin(desired[2])) < 1e-12);
        CHECK(close(reached.normalized(), (x_c - base).normalized()));
        CHECK(close(reached.norm(), model.link2.length + model.link3.length));
    });
}

TEST_CASE(adaptive_reference_displaces_the_reference_of_shaped_impedance) {
    for_scenes(ControllerType::adaptive_reference, [](RowContext scene) {
        scene.sensed.contact = 0;  // the phase alone says whether the force is controlled
        const Symbols y(scene);
        const Vector e = y.x - y.x_d - y.s.force_phase * scene.memory[0] * y.p_in;
        const Vector force =
            Vector(y.s.f_on_tip) - y.diagonal(y.g.damping) * (y.xd - y.xd_d) - y.diagonal(y.g.stiffness) * e;
        CHECK(close(y.ID(y.xdd_d + y.diagonal(y.g.mass).inverse() * force), scene.tau()));
        CHECK(close(y.s.force_phase * y.g.reference_gain * y.e_f, scene.command().rates[0]));
    });
}

// At rest the spring balances the wall, k_e deep: what force does the reference give?
TEST_CASE(adaptive_reference_from_a_wall_stiffness_presses_as_its_closed_form_says) {
    for_scenes(ControllerType::adaptive_reference, [](RowContext scene) {
        scene.controller.adaptation = Adaptation::indirect;
        scene.sensed.force_phase = 1;
        scene.controller.reference.path = Path::point;
        const Symbols y(scene);
        const Matrix K = y.diagonal(y.g.stiffness);
        const double k_e = scene.controller.gains.assumed_stiffness, s_E = -y.s.face;

        // x = x_d + x_r p_in - f K^-1 p_in and f = k_e (p_in . x - s_E), with x_r as the torque at x = x_d betrays it
        scene.sensed.qd = {0, 0, 0};
        scene.sensed.f_on_tip = scene.sensed.f_cancelled = {0, 0, 0};
        const Symbols rest(scene);
        const Vector a = rest.J * rest.M.inverse() * (scene.tau() - rest.tau_g);
        const Vector displaced = K.inverse() * y.diagonal(y.g.mass) * a - (rest.x_d - rest.x);
        const double x_r = y.p_in.dot(displaced);
        CHECK(close(x_r * y.p_in, displaced, 1e-9));
        const double along = 1 / y.p_in.dot(K.inverse() * y.p_in);
        const double f = (y.p_in.dot(y.x_d) + x_r - s_E) / (1 / k_e + 1 / along);
        CHECK(close(y.f_d, f, 1e-9));

        scene.controller.gains.assumed_stiffness *= 1.2;  // wrong: f = f_d k_e/(K + k_e) (1 + K/k^)
        const Vector wrong =
            K.inverse() * y.diagonal(y.g.mass) * rest.J * rest.M.inverse() * (scene.tau() - rest.tau_g);
        const double x_w = y.p_in.dot(wrong - (rest.x_d - rest.x));
        const double f_w = (y.p_in.dot(y.x_d) + x_w - s_E) / (1 / k_e + 1 / along);
        CHECK(close(y.f_d * k_e / (along + k_e) * (1 + along / (1.2 * k_e)), f_w, 1e-9));
        CHECK(scene.command().rates[0] == 0);
    });
}

TEST_CASE(an_axis_across_the_normal_may_have_no_stiffness) {
    const Vec3<double> K(0, 500, 0), n(0, -1, 0);
    CHECK(compliance_along(K, n) == 1.0 / 500);
}

static double quintic(double low, double high, double x) {
    const double u = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return 6 * std::pow(u, 5) - 15 * std::pow(u, 4) + 10 * std::pow(u, 3);
}

TEST_CASE(energy_tank_is_its_formula) {
    for_scenes(ControllerType::energy_tank, [](RowContext scene) {
        const Symbols y(scene);
        const Vector e = y.x - y.x_d, ed = y.xd - y.xd_d, damped = y.diagonal(y.g.damping) * ed;
        const double dK = y.g.stiffness_amplitude * std::sin(2 * M_PI * y.g.stiffness_frequency * y.s.t);
        const double gamma = quintic(0.2, 0.6, y.z), beta = 1 - quintic(1.1, 1.5, y.z);
        const Vector w = -gamma * dK * e;
        const Vector held = -damped - y.diagonal(y.g.stiffness) * e;
        CHECK(close(y.tau_g + y.J.transpose() * (held + w), scene.tau()));
        CHECK(close(beta * ed.dot(damped) - ed.dot(w), scene.command().rates[0]));
        scene.controller.has_tank = false;
        CHECK(close(y.tau_g + y.J.transpose() * (held - dK * e), scene.tau()));
        CHECK(scene.command().rates[0] == 0);
    });
}

TEST_CASE(equal_levels_of_the_tank_make_the_valves_hard) {
    Gains<double> gains{};
    gains.tank_low = gains.tank_high = 0.5;
    gains.tank_capacity = 2;
    CHECK(tank_gains(gains, 0.4999).out == 0);
    CHECK(tank_gains(gains, 0.5001).out == 1);
    CHECK(tank_gains(gains, 1.9999).in == 1);
    CHECK(tank_gains(gains, 2.0001).in == 0);
}

TEST_CASE(virtual_wall_pushes_one_way) {
    int pushed = 0;
    for_scenes(ControllerType::virtual_wall, [&](const RowContext& scene) {
        const Symbols y(scene);
        const Vector normal = y.g.plane_normal;
        const double depth = normal.dot(Vector(y.g.plane_point) - y.x), rate = -normal.dot(y.xd);
        const double force = y.g.stiffness[0] * depth + y.g.damping[0] * rate;
        const double pushing = depth > 0 && force > 0 ? force : 0.0;
        CHECK(close(y.tau_g + y.J.transpose() * (pushing * normal), scene.tau()));
        CHECK(close(pushing, virtual_wall_force(y.g, Vec3<double>(y.x), Vec3<double>(y.xd))));
        pushed += pushing > 0;
    });
    CHECK(pushed > 50);
    CHECK(pushed < 250);
}

// ---- memory

TEST_CASE(the_integral_grows_in_contact_and_in_the_force_phase_only) {
    for (const ControllerType type :
         {ControllerType::operational_space, ControllerType::hybrid, ControllerType::parallel})
        for_scenes(type, [](RowContext scene) {
            const double e_f = Symbols(scene).e_f;
            for (const double contact : {0.0, 1.0})
                for (const double phase : {0.0, 1.0}) {
                    scene.sensed.contact = contact;
                    scene.sensed.force_phase = phase;
                    CHECK(close(contact * phase * e_f, scene.command().rates[0]));
                }
        });
}

TEST_CASE(the_integral_stays_within_its_limit) {
    for_scenes(ControllerType::hybrid, [](RowContext scene) {
        scene.sensed.force_phase = 1;
        scene.controller.gains.integral_limit = 3;
        const double e_f = Symbols(scene).e_f;
        for (const double integral : {-3.5, -3.0, -2.9, 2.9, 3.0, 3.5}) {
            scene.memory[0] = integral;
            const bool further = std::abs(integral) >= 3 && integral * e_f > 0;
            CHECK(close(further ? 0.0 : e_f, scene.command().rates[0]));
        }
    });
}

TEST_CASE(per_integral_is_what_the_torque_changes_by) {
    for (const ControllerType type :
         {ControllerType::operational_space, ControllerType::hybrid, ControllerType::parallel})
        for_scenes(type, [](RowContext scene) {
            scene.controller.anti_windup = AntiWindup::conditional;
            for (const Variant variant :
                 {Variant::dynamic, Variant::jacobian_transpose, Variant::projected, Variant::raibert_craig}) {
                scene.controller.variant = variant;
                const Command<double> before = scene.command();
                RowContext after = scene;
                after.memory[0] += 1;
                CHECK(close(after.tau() - Vector(before.tau), before.dtau_dintegral, 1e-9));
            }
        });
}

TEST_CASE(memory_starts_where_the_law_needs_it) {
    Random random(5);
    const RowContext tank(random, ControllerType::energy_tank);
    CHECK(memory_at_start(tank.controller, tank.sensed)[0] == tank.controller.gains.tank_energy);

    const RowContext admitting(random, ControllerType::admittance);
    const Memory at = memory_at_start(admitting.controller, admitting.sensed);
    const Symbols y(admitting);
    CHECK(distance(Vector(at[0], at[1], at[2]), y.x_d) == 0);
    CHECK(distance(Vector(at[3], at[4], at[5]), y.xd_d) == 0);

    for (const ControllerType type : {ControllerType::hybrid, ControllerType::adaptive_reference}) {
        const RowContext forcing(random, type);
        CHECK((memory_at_start(forcing.controller, forcing.sensed) == Memory{}));
    }
}

// ---- the motion that each law promises, on the arm itself: qdd from the equation of motion

struct Motion3 {
    Vector qdd, xdd;
};

static Motion3 motion(const RowContext& scene) {
    const Symbols y(scene);
    const Measurement<double>& s = scene.sensed;
    const Vector qdd = forward_dynamics(scene.controller.model, s.pose, s.qd, Vec3<double>(scene.tau()), s.f_on_tip);
    return {qdd, y.J * qdd + y.Jd * y.qd};
}

TEST_CASE(computed_torque_makes_the_joint_errors_linear) {
    for_scenes(ControllerType::computed_torque, [](RowContext scene) {
        scene.trust_everything();
        const Symbols y(scene);
        const Vector e = y.x_d - Vector(y.s.q), ed = y.xd_d - y.qd;
        const Vector law = y.diagonal(y.g.velocity) * ed + y.diagonal(y.g.position) * e;
        const Vector edd = y.xdd_d - motion(scene).qdd;
        CHECK(close(edd, -law, 1e-9));
        scene.controller.cancels_force = false;
        const Vector felt = y.xdd_d - motion(scene).qdd + law;
        CHECK(close(felt, -(y.M.inverse() * y.J.transpose() * Vector(y.s.f_on_tip)), 1e-9));
    });
}

TEST_CASE(resolved_acceleration_and_hybrid_give_the_tip_the_acceleration_that_was_asked_for) {
    for (const ControllerType type :
         {ControllerType::resolved_acceleration, ControllerType::hybrid, ControllerType::operational_space})
        for_scenes(type, [&](RowContext scene) {
            scene.trust_everything();
            if (type == ControllerType::resolved_acceleration) scene.sensed.force_phase = 0;
            const Symbols y(scene);
            CHECK(close(y.S_p * y.a_m() + y.S_f * y.a_f(), motion(scene).xdd, 1e-9));
        });
}

TEST_CASE(a_force_fed_forward_couples_through_the_mobility) {
    for_scenes(ControllerType::operational_space, [](RowContext scene) {
        scene.controller.force_term = ForceTerm::feedforward;
        const Symbols y(scene);
        const Vector extra = y.Lambda.inverse() * (y.S_f * y.p_in * y.f_d + Vector(y.s.f_on_tip));
        CHECK(close(y.S_p * y.a_m() + y.S_f * y.a_f() + extra, motion(scene).xdd, 1e-9));
    });
}

TEST_CASE(shaped_impedance_is_a_mass_on_a_spring) {
    for_scenes(ControllerType::shaped_impedance, [](RowContext scene) {
        scene.trust_everything();
        const Symbols y(scene);
        const Vector edd = motion(scene).xdd - y.xdd_d;
        const Vector balance = y.diagonal(y.g.mass) * edd + y.diagonal(y.g.damping) * (y.xd - y.xd_d) +
                               y.diagonal(y.g.stiffness) * (y.x - y.x_d);
        CHECK(close(Vector(y.s.f_on_tip), balance, 1e-9));
    });
}

TEST_CASE(parallel_control_is_a_mass_between_spring_and_force_loop) {
    for_scenes(ControllerType::parallel, [](RowContext scene) {
        scene.trust_everything();
        const Symbols y(scene);
        const Vector balance = y.g.force_mass * (motion(scene).xdd - y.xdd_d) +
                               y.diagonal(y.g.damping) * (y.xd - y.xd_d) + y.diagonal(y.g.stiffness) * (y.x - y.x_d);
        CHECK(close(y.s.force_phase * y.correction() * y.p_in, balance, 1e-9));
    });
}

static void take_friction_away(Arm<double>& arm) {
    arm.damping = arm.friction = {0, 0, 0};
    arm.has_damping = arm.has_dry_friction = false;
}

TEST_CASE(impedance_keeps_the_arms_own_inertia) {
    for_scenes(ControllerType::impedance, [](RowContext scene) {
        take_friction_away(scene.controller.model);
        const Symbols y(scene);
        const Vector edd = motion(scene).xdd - y.xdd_d, ed = y.xd - y.xd_d;
        const Vector balance =
            y.Lambda * edd + (y.mu + y.diagonal(y.g.damping)) * ed + y.diagonal(y.g.stiffness) * (y.x - y.x_d);
        CHECK(close(Vector(y.s.f_on_tip), balance, 1e-9));
    });
}

// V = ed^T Lambda ed/2 + e^T K e/2 along the motion, differentiated by Dual.
static double storage_rate(const RowContext& scene, const Vector& qdd) {
    const Measurement<double>& s = scene.sensed;
    const Controller<double>& controller = scene.controller;
    const Vec3<Dual<1>> q = moving(s.q, s.qd), qd = moving(s.qd, Vec3<double>(qdd));
    const Pose<Dual<1>> p = pose(q);
    const DesiredMotion<Dual<1>> desired = desired_motion_at(controller.reference, Dual<1>(s.t, {1}));
    const Vec3<Dual<1>> e = minus(tip_position(controller.model, p), desired.position);
    const Vec3<Dual<1>> ed = minus(tip_velocity(controller.model, p, qd), desired.velocity);
    const Dual<1> kinetic = dot(ed, times(operational_space_inertia(controller.model, p), ed));
    Dual<1> elastic(0.0);
    for (int i = 0; i < 3; ++i) elastic += controller.gains.stiffness[i] * e[i] * e[i];
    return (0.5 * (kinetic + elastic)).slope[0];
}

TEST_CASE(impedance_stores_what_the_world_gives_less_what_it_damps) {
    for_scenes(ControllerType::impedance, [](RowContext scene) {
        take_friction_away(scene.controller.model);
        const Symbols y(scene);
        const Vector ed = y.xd - y.xd_d;
        const double given = ed.dot(Vector(y.s.f_on_tip)) - ed.dot(y.diagonal(y.g.damping) * ed);
        CHECK(close(given, storage_rate(scene, motion(scene).qdd), 1e-9));
    });
}

TEST_CASE(the_tank_pays_for_the_stiffness) {
    for_scenes(ControllerType::energy_tank, [](RowContext scene) {
        take_friction_away(scene.controller.model);
        scene.controller.reference.path = Path::point;
        const Symbols y(scene);
        const double beta = 1 - quintic(1.1, 1.5, y.z);
        const double V = storage_rate(scene, motion(scene).qdd) + scene.command().rates[0];
        const double lost = (1 - beta) * y.xd.dot(y.diagonal(y.g.damping) * y.xd);
        CHECK(close(y.xd.dot(Vector(y.s.f_on_tip)) - lost, V, 1e-9));
    });
}

// Without its own error the inner loop is the impedance that the outer one asks for.
TEST_CASE(admittance_tracked_exactly_is_shaped_impedance) {
    for_scenes(ControllerType::admittance, [](RowContext scene) {
        scene.controller.reference.force_profile = ForceProfile::constant;
        scene.controller.reference.force = 0;
        const Symbols y(scene);
        for (int i = 0; i < 3; ++i) {
            scene.memory[std::size_t(i)] = y.x[i];
            scene.memory[std::size_t(3 + i)] = y.xd[i];
        }
        const Vector tau = scene.tau();
        scene.controller.type = ControllerType::shaped_impedance;
        CHECK(close(scene.tau(), tau));
    });
}

// The lecture's brick arm at (0, -75, 45) degrees: along its unstable direction the joint-space hybrid law pushes away.
// The eigenvalue is that of M^-1 J^-1 S_p J, from an independent derivation.
TEST_CASE(hybrid_of_raibert_and_craig_is_unstable_where_it_is_known_to_be) {
    Random random(3);
    RowContext scene(random, ControllerType::hybrid);
    Controller<double>& controller = scene.controller;
    controller.model = Params().arm();
    controller.reference.path = Path::point;
    controller.gains.joint_stiffness = {1, 1, 1};
    controller.gains.force = controller.gains.force_integral = 0;
    controller.reference.force_profile = ForceProfile::constant;
    controller.reference.force = 0;
    const Vec3<double> q(0, -75 * M_PI / 180, 45 * M_PI / 180);
    controller.reference.to = tip_position(controller.model, pose(q));
    const Vec3<Slopes> moved(Slopes::variable(q[0], 0), Slopes::variable(q[1], 1), Slopes::variable(q[2], 2));
    const Slopes o(0.0), l(1.0);
    const Vec3<Slopes> zero(o, o, o), n(o, o, l);
    const Measurement<Slopes> sensed{o, moved, zero, pose(moved), zero, zero, n, o, l, l};
    const auto min_eigenvalue = [&](Variant variant) {
        controller.variant = variant;
        Command<Slopes> command;
        compiled_law<double, Slopes>()(controller, sensed, {}, command);
        const Vec3<Slopes> tau = minus(command.tau, gravity_torque(controller.model, sensed.pose));
        Matrix slope;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) slope(i, j) = tau[i].slope[std::size_t(j)];
        const Matrix M = mass_matrix(controller.model, pose(q));
        return eigenvalues((-(M.inverse() * slope)).m).real().minCoeff();
    };
    CHECK(close(-0.4323820891, min_eigenvalue(Variant::raibert_craig), 1e-9));
    CHECK(std::abs(min_eigenvalue(Variant::projected)) < 1e-9);
}

// ---- where the laws end

TEST_CASE(distance_to_singular_is_that_of_elbow_or_axis) {
    Random random(11);
    for (int i = 0; i < 300; ++i) {
        const Arm<double> arm = random_params(random).arm();
        const Vec3<double> q = random.vector(-4, 4);
        CHECK(close(farness(q, arm), distance_to_singular(arm, pose(q)), 1e-13));
    }
}

// ---- number types

// Every law in every one of its forms.
static std::vector<Controller<double>> all_laws(Random& random) {
    std::vector<Controller<double>> result;
    for (int type = int(ControllerType::joint_pd); type < int(ControllerType::user); ++type)
        for (int form = 0; form < 4; ++form) {
            Controller<double> controller = RowContext(random, ControllerType(type)).controller;
            controller.variant = Variant(form);
            controller.force_term = ForceTerm(form % 2);
            controller.anti_windup = AntiWindup(form % 3);
            controller.inner = Inner(form % 3);
            controller.adaptation = Adaptation(form % 2);
            controller.reference.path = Path(2 + form);
            controller.reference.force_profile = ForceProfile(form);
            controller.has_tank = controller.cancels_force = controller.compensates_gravity = form % 2;
            result.push_back(controller);
        }
    return result;
}

static std::vector<double> numbers(const Command<double>& command) {
    std::vector<double> all(command.tau.data(), command.tau.data() + 3);
    all.insert(all.end(), command.rates.begin(), command.rates.end());
    all.insert(all.end(), command.dtau_dintegral.data(), command.dtau_dintegral.data() + 3);
    return all;
}

// f(x...) for each number of what controllers sense.
template <class F, class... Senses>
static void each_sensed_number(F f, Senses&... s) {
    const auto vector = [&](auto&... v) { f(v[0]...), f(v[1]...), f(v[2]...); };
    f(s.t...), vector(s.q...), vector(s.qd...);
    f(s.pose.S1...), f(s.pose.C1...), f(s.pose.S2...), f(s.pose.C2...), f(s.pose.S23...), f(s.pose.C23...);
    vector(s.f_on_tip...), vector(s.f_cancelled...), vector(s.n...);
    f(s.face...), f(s.contact...), f(s.force_phase...);
}

// The results of the lanes of a pack, and of each alone. Objects of packs are aligned by hand, because the compiler
// would not do it outside functions for wide registers.
template <class P, int N>
static void check_lanes(Random& random, const Controller<double>& form) {
    constexpr bool one_controller = std::is_same_v<P, double>;
    const RowContext shared(random, form.type);
    std::vector<RowContext> scenes;
    alignas(64) Controller<P> controllers{};
    copy_controller_choices(form, controllers);
    controllers.model.has_damping = controllers.model.has_dry_friction = true;
    alignas(64) Measurement<Pack<N>> sensed;
    alignas(64) std::array<Pack<N>, law_memory> memory;
    const auto put = [](int lane, auto& to, double x) {
        if constexpr (one_controller) to = x;
        else to.set(lane, x);
    };
    for (int lane = 0; lane < N; ++lane) {
        RowContext scene(random, form.type);
        if (one_controller) scene.controller = shared.controller;
        copy_controller_choices(form, scene.controller);
        const auto into = [&](P& to, const double& x) { put(lane, to, x); };
        each_law_number(into, controllers, scene.controller);
        each_arm_number(into, controllers.model, scene.controller.model);
        each_sensed_number([&](Pack<N>& to, const double& x) { to.set(lane, x); }, sensed, scene.sensed);
        for (std::size_t i = 0; i < law_memory; ++i) memory[i].set(lane, scene.memory[i]);
        scenes.push_back(scene);
    }
    alignas(64) Command<Pack<N>> together;
    compiled_law<P, Pack<N>>()(controllers, sensed, memory, together);
    for (int lane = 0; lane < N; ++lane) {
        Command<double> of_lane;
        for (int i = 0; i < 3; ++i) {
            of_lane.tau[i] = together.tau[i][lane];
            of_lane.dtau_dintegral[i] = together.dtau_dintegral[i][lane];
        }
        for (std::size_t i = 0; i < law_memory; ++i) of_lane.rates[i] = together.rates[i][lane];
        const std::vector<double> alone = numbers(scenes[std::size_t(lane)].command()), packed = numbers(of_lane);
        CHECK(std::equal(alone.begin(), alone.end(), packed.begin(), same_bits));
    }
}

TEST_CASE(lanes_have_the_bits_of_each_law_alone) {
    Random random(21);
    for (const Controller<double>& form : all_laws(random)) {
#define CHECK_ROWS(T) \
    if (has_registers_for(Lanes<T>::count)) check_lanes<double, Lanes<T>::count>(random, form);
#define CHECK_LANES(T) \
    if (has_registers_for(Lanes<T>::count)) check_lanes<T, Lanes<T>::count>(random, form);
        ARM3R_ROW_PACKS(CHECK_ROWS)
        ARM3R_PACKS(CHECK_LANES)
    }
}

// tau and rates along a line through q, qd, f, t and memory: slopes of Dual against differences of double.
struct Along {
    const Controller<double>& controller;
    RowContext at, by;

    template <class T>
    std::vector<T> operator()(const T& share) const {
        const auto shifted = [&](double from, double step) { return T(from + share * step); };
        const auto vector = [&](const Vec3<double>& from, const Vec3<double>& step) {
            return Vec3<T>(shifted(from[0], step[0]), shifted(from[1], step[1]), shifted(from[2], step[2]));
        };
        const Measurement<double>&s = at.sensed, &d = by.sensed;
        const Vec3<T> q = vector(s.q, d.q);
        const Measurement<T> sensed{shifted(s.t, d.t),
                                    q,
                                    vector(s.qd, d.qd),
                                    pose(q),
                                    vector(s.f_on_tip, d.qd),
                                    vector(s.f_cancelled, d.qd),
                                    vector(s.n, {0, 0, 0}),
                                    T(s.face),
                                    T(1.0),
                                    T(1.0)};
        std::array<T, law_memory> memory;
        for (std::size_t i = 0; i < law_memory; ++i) memory[i] = shifted(at.memory[i], by.memory[i]);
        Command<T> command;
        compiled_law<double, T>()(controller, sensed, memory, command);
        std::vector<T> result{command.tau[0], command.tau[1], command.tau[2]};
        result.insert(result.end(), command.rates.begin(), command.rates.end());
        return result;
    }
};

TEST_CASE(slopes_of_each_law_are_right) {
    Random random(31);
    for (const Controller<double>& controller : all_laws(random)) {
        RowContext at(random, controller.type), by(random, controller.type);
        do at.sensed.q = random.vector(-4, 4);
        while (farness(at.sensed.q, controller.model) < 0.3);
        at.sensed.t = controller.reference.start + 0.37 * controller.reference.duration;
        const Along along{controller, at, by};
        const std::vector<Slopes> exact = along(Slopes::variable(0.0, 0));
        const double h = 1e-4;
        const std::vector<double> a = along(-2 * h), b = along(-h), c = along(h), d = along(2 * h);
        for (std::size_t i = 0; i < exact.size(); ++i)
            CHECK(close(exact[i].slope[0], (a[i] - 8 * b[i] + 8 * c[i] - d[i]) / (12 * h), 1e-6),
                  "law " << int(controller.type) << " number " << i << ": " << exact[i].slope[0]);
    }
}

TEST_SUITE_END()

}  // namespace arm3r
