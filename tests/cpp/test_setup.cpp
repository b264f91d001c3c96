
#include "arm3r/model/dynamics.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "validate/rules.hpp"
#include "validate/warnings.hpp"

namespace arm3r {

TEST_SUITE(setup)

static Lumped<double> random_lumped(Random& random) {
    return {.A1 = random.in(0, 1),
            .A2 = random.in(-1, 1),
            .A3 = random.in(-1, 1),
            .B = random.in(-1, 1),
            .B2 = random.in(0, 1),
            .B3 = random.in(0, 1),
            .J3 = random.in(0, 0.3),
            .G2 = 0,
            .G3 = 0};
}

static double lower_determinant(const Mat3<double>& M) { return M(1, 1) * M(2, 2) - M(1, 2) * M(2, 1); }

// The closed-form minima against all poses of a grid that holds both ends of every cosine: none is lower, and they are
// taken where they are said to be.
TEST_CASE(weakest_poses_are_those_of_a_search_over_all_poses) {
    Random random(21);
    constexpr int steps = 64;
    for (int i = 0; i < 300; ++i) {
        Arm<double> arm;
        arm.lumped = random_lumped(random);
        double M11 = HUGE_VAL, determinant = HUGE_VAL;
        for (int j = 0; j <= steps; ++j) {
            for (int k = 0; k <= 2 * steps; ++k) {
                const double q2 = M_PI * j / steps, q23 = M_PI * k / steps;
                const Mat3<double> M = mass_matrix(arm, pose(Vec3<double>(0, q2, q23 - q2)));
                M11 = std::min(M11, M(0, 0));
                determinant = std::min(determinant, lower_determinant(M));
            }
        }
        const WorstPose weakest = min_M11(arm.lumped), folded = min_lower_determinant(arm.lumped);
        CHECK(M11 >= weakest.value - 1e-12);
        CHECK(M11 <= weakest.value + 2e-3);
        CHECK(std::abs(determinant - folded.value) <= 1e-12);
        CHECK(std::abs(mass_matrix(arm, pose(Vec3<double>(0.3, weakest.q2, weakest.q3)))(0, 0) - weakest.value) <=
              1e-12);
        CHECK(std::abs(lower_determinant(mass_matrix(arm, pose(Vec3<double>(0.3, folded.q2, folded.q3)))) -
                       folded.value) <= 1e-12);
    }
}

static Problem only_problem(const Params& params) {
    const std::vector<Problem> problems = problems_of(params);
    REQUIRE(problems.size() == 1u);
    return problems.front();
}

static bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST_CASE(an_arm_that_nothing_turns_about_the_vertical_is_refused) {
    Params params = unequal_params();
    params.choose("arm.link2.shape", "slender").choose("arm.link3.shape", "slender").set("arm.link1.inertia_axial", 0);
    const Problem problem = only_problem(params);
    CHECK(problem.code == "scenario.singular_mass_matrix");
    CHECK(problem.path == "arm.link1.inertia_axial");
    CHECK(contains(problem.message, "q2 = 90 deg, q3 = 0 deg"));
    CHECK(contains(problem.hint, "arm.armature[0]"));
    CHECK(problems_of(params.set("arm.armature", {2e-9, 0, 0})).empty());
}

TEST_CASE(an_arm_whose_lower_links_have_no_inertia_is_refused) {
    Params params = unequal_params();
    params.set("arm.link2.com", 0).set("arm.link2.inertia", {1e-3, 1e-3, 0}).set("arm.link2.mass", 1);
    params.set("arm.link3.com", 0.6).set("arm.link3.inertia", {1e-3, 1e-3, 0});
    const Problem problem = only_problem(params);
    CHECK(problem.code == "scenario.singular_mass_matrix");
    CHECK(contains(problem.message, "q3 = 180 deg"));
    CHECK(problems_of(params.set("arm.armature", {0, 0.01, 0.01})).empty());
}

TEST_CASE(an_inertia_that_no_body_has_is_refused) {
    const Problem problem = only_problem(unequal_params().set("arm.link3.inertia", {0.1, 0.2, 0.31}));
    CHECK(problem.code == "scenario.inertia");
    CHECK(problems_of(unequal_params().set("arm.link3.inertia", {0.1, 0.2, 0.3})).empty());
}

static void check_refusal(const Params& params, const std::string& code, const std::string& path) {
    const Problem problem = only_problem(params);
    CHECK(problem.code == code);
    CHECK(problem.path == path);
}

TEST_CASE(what_a_shape_cannot_give_must_be_given) {
    check_refusal(Params().choose("arm.link3.shape", "slender"), "scenario.missing_key", "arm.link3.mass");
    check_refusal(Params().choose("arm.link2.shape", "cylinder"), "scenario.missing_key", "arm.link2.radius");
    for (const char* path : {"arm.link1.mass", "arm.link1.com", "arm.link1.inertia_axial"})
        check_refusal(Params().set(path, std::nan("")), "scenario.missing_key", path);
}

TEST_CASE(a_controllers_copy_that_is_no_arm_is_refused_where_it_is_said) {
    const Params params = Params().choose("controller.type", "gravity_compensation");
    check_refusal(Params(params).choose("controller.model.link3.shape", "slender"), "scenario.missing_key",
                  "controller.model.link3.mass");
    check_refusal(Params(params).choose("controller.model.link2.shape", "cylinder"), "scenario.missing_key",
                  "controller.model.link2.radius");
    check_refusal(Params(params).set("controller.model.link3.inertia", {0.1, 0.2, 0.31}), "scenario.inertia",
                  "controller.model.link3.inertia");
    CHECK(
        problems_of(Params(params).choose("controller.model.link3.shape", "slender").set("arm.link3.mass", 1)).empty());
}

TEST_CASE(a_vector_with_a_hole_is_refused) {
    const double unset = std::nan("");
    Params params = unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1);
    check_refusal(Params(params).set("controller.gravity", {9, unset, 7}), "scenario.missing_key",
                  "controller.gravity");
    check_refusal(Params(params).set("controller.gravity", {9, 7, unset}), "scenario.missing_key",
                  "controller.gravity");
    check_refusal(Params(params).set("wall.motion.velocity", {0.1, unset, 0.2}), "scenario.missing_key",
                  "wall.motion.velocity");
}

TEST_CASE(a_start_deep_in_the_wall_is_refused_and_one_behind_the_plates_rim_is_not) {
    Params params = unequal_params();
    const Vec3<double> tip = tip_position(params.arm(), pose(Vec3<double>(0.4, 0.7, -0.9)));
    params.set("wall", 1).set("wall.point", Vec3<double>(tip - Vec3<double>(0.11, 0, 0)));
    CHECK(only_problem(params).code == "scenario.starts_inside_wall");
    CHECK(problems_of(Params(params).set("wall.point", Vec3<double>(tip - Vec3<double>(0.09, 0, 0)))).empty());
    CHECK(problems_of(
              Params(params).set("wall.point", Vec3<double>(tip - Vec3<double>(0.11, 1, 0))).set("wall.size", {1, 1}))
              .empty());
}

TEST_CASE(taylor_is_refused_where_the_law_has_corners) {
    Params params =
        unequal_params().choose("solver.method", "taylor").choose("controller.type", "gravity_compensation");
    CHECK(problems_of(params).empty());
    const Problem problem = only_problem(params.set("arm.torque_limit", {HUGE_VAL, 20, HUGE_VAL}));
    CHECK(problem.code == "scenario.corner");
    CHECK(problem.path == "solver.method");
    CHECK(contains(problem.message, "arm.torque_limit"));
    CHECK(contains(problem.message, "controller.type"));
    CHECK(contains(problem.hint, "dopri5"));
    CHECK(problems_of(Params(params).choose("solver.method", "dopri5")).empty());
    CHECK(problems_of(Params(params).choose("controller.type", "none")).empty());
    params.choose("controller.type", "constant").set("controller.torque", {1, 30, 1});
    CHECK(problems_of(params).empty());
}

TEST_CASE(taylor_is_refused_where_the_torque_is_to_come_from_the_recursion) {
    Params params = unequal_params().choose("solver.method", "taylor");
    params.choose("controller.type", "gravity_compensation").choose("controller.algorithm", "recursion");
    const Problem problem = only_problem(params);
    CHECK(problem.code == "scenario.no_series");
    CHECK(problem.path == "controller.algorithm");
    CHECK(contains(problem.hint, "dopri5"));
    CHECK(problems_of(Params(params).choose("solver.method", "rk4")).empty());
    CHECK(problems_of(Params(params).choose("controller.type", "none")).empty());
}

static Params seriesed() { return unequal_params().choose("solver.method", "taylor").set("wall", 1); }

static Params damped(Params params, std::string_view law) {
    return params.choose("wall.contact.law", law).set("wall.contact.stiffness", 1e4);
}

TEST_CASE(taylor_is_refused_where_the_wall_has_no_series) {
    const auto refuses = [](const Params& params, const char* path) {
        check_refusal(params, "scenario.no_series", path);
        CHECK(problems_of(Params(params).choose("solver.method", "dopri5")).empty());
        CHECK(problems_of(Params(params).choose("solver.method", "rk4")).empty());
    };
    CHECK(problems_of(seriesed()).empty());
    Params ramp = seriesed().choose("wall.motion.type", "ramp").set("wall.motion.distance", 0.1);
    refuses(ramp.set("wall.motion.duration", 1), "wall.motion.type");
    Params turning = seriesed().choose("wall.rotation.type", "constant").set("wall.rotation.axis", {0, 0, 1});
    refuses(turning.set("wall.rotation.rate", 1), "wall.rotation.type");
    refuses(damped(seriesed(), "kelvin_voigt").set("wall.contact.damping", 3), "wall.contact.law");
    refuses(damped(seriesed(), "hunt_crossley").set("wall.contact.dissipation", 3), "wall.contact.law");
    const Params diagonal =
        seriesed().choose("wall.contact.law", "diagonal").set("wall.contact.stiffness", {1e3, 20, 30});
    CHECK(problems_of(diagonal).empty());
    refuses(Params(diagonal).set("wall.acts_on_arm", 1), "wall.contact.law");
    const Params rough = seriesed().set("wall.contact.friction.coefficient", 0.2);
    CHECK(problems_of(rough).empty());
    refuses(Params(rough).set("wall.acts_on_arm", 1), "wall.contact.friction.coefficient");
    Params aside = seriesed().choose("wall.motion.type", "sinusoid").set("wall.motion.amplitude", 0.1);
    CHECK(problems_of(aside.set("wall.motion.frequency", 1).set("wall.motion.direction", {0, 1, 0})).empty());
}

// ---- the wall

TEST_CASE(a_damped_law_takes_damping_or_restitution_but_not_both) {
    const Params walled = unequal_params().set("wall", 1);
    const Params voigt = damped(walled, "kelvin_voigt"), crossley = damped(walled, "hunt_crossley");
    check_refusal(voigt, "scenario.missing_key", "wall.contact.damping");
    check_refusal(Params(voigt).set("wall.contact.damping", 3).set("wall.contact.restitution", 0.5),
                  "scenario.conflict", "wall.contact.damping");
    check_refusal(crossley, "scenario.missing_key", "wall.contact.dissipation");
    check_refusal(Params(crossley).set("wall.contact.restitution", 0.5), "scenario.missing_key",
                  "wall.contact.impact_speed");
    check_refusal(Params(crossley).set("wall.contact.dissipation", 0.5).set("wall.contact.impact_speed", 0.5),
                  "scenario.conflict", "wall.contact.impact_speed");
    check_refusal(Params(walled)
                      .choose("wall.contact.law", "hunt_crossley")
                      .set("wall.contact.dissipation", 1)
                      .set("wall.contact.stiffness", std::nan("")),
                  "scenario.missing_key", "wall.contact.stiffness");
    CHECK(problems_of(Params(crossley).set("wall.contact.restitution", 0.5).set("wall.contact.impact_speed", 0.1))
              .empty());
}

TEST_CASE(damping_comes_from_the_restitution_and_the_mass_that_the_arm_shows) {
    Params params = damped(unequal_params().set("wall", 1).set("wall.normal", {-1, 0.3, 0.2}), "kelvin_voigt");
    const Setup setup = make_setup(params.set("wall.contact.restitution", 0.450975453));
    const double m = effective_mass(setup.plant.arm, pose(setup.q), setup.plant.wall.n);
    CHECK(std::abs(setup.plant.contact.damping / (2 * 0.3 * std::sqrt(1e4 * m)) - 1) <= 1e-8);
    params = damped(params, "hunt_crossley").set("wall.contact.restitution", 0.832869792);
    const Contact<double> contact = make_setup(params.set("wall.contact.impact_speed", 0.2)).plant.contact;
    CHECK(std::abs(contact.dissipation - 0.3 / 0.2) <= 1e-7);
    CHECK(contact.exponent == 1.5);
}

TEST_CASE(a_table_says_as_much_of_each_instant_and_they_increase) {
    Params table = unequal_params().set("wall", 1).choose("wall.motion.type", "table");
    check_refusal(Params(table)
                      .set("wall.motion.t", 0.0)
                      .set("wall.motion.s", {0, 1})
                      .set("wall.motion.v", {0, 0})
                      .set("wall.motion.a", {0, 0}),
                  "scenario.missing_key", "wall.motion.t");
    table.set("wall.motion.t", {0, 1, 3}).set("wall.motion.s", {0, 0.1, 0.2});
    table.set("wall.motion.v", {0, 0.1, 0}).set("wall.motion.a", {0, 0, 0});
    CHECK(problems_of(table).empty());
    CHECK(make_setup(table).plant.wall.table->knots() == 3);
    check_refusal(Params(table).set("wall.motion.a[3]", 0), "scenario.table", "wall.motion.a");
    check_refusal(Params(table).set("wall.motion.s[2]", std::nan("")), "scenario.table", "wall.motion.s");
    check_refusal(Params(table).set("wall.motion.v[1]", std::nan("")), "scenario.missing_key", "wall.motion.v");
    check_refusal(Params(table).set("wall.motion.t[2]", 1), "scenario.table", "wall.motion.t[2]");
    check_refusal(Params(table).set("wall.motion.t[1]", 5), "scenario.table", "wall.motion.t[2]");
}

TEST_CASE(directions_and_axes_have_a_length) {
    Params params = unequal_params().set("wall", 1).choose("wall.motion.type", "ramp").set("wall.motion.distance", 1);
    params.set("wall.motion.duration", 1);
    check_refusal(Params(params).set("wall.motion.direction", {0, 0, 0}), "scenario.range", "wall.motion.direction");
    params.choose("wall.rotation.type", "constant").set("wall.rotation.rate", 1);
    check_refusal(params, "scenario.missing_key", "wall.rotation.axis");
    check_refusal(Params(params).set("wall.rotation.axis", {0, 0, 0}), "scenario.range", "wall.rotation.axis");
    const Wall<double> wall =
        make_setup(params.set("wall.motion.direction", {0, 3, 4}).set("wall.rotation.axis", {0, 0, -9})).plant.wall;
    CHECK(distance(wall.direction, Vec3<double>(0, 0.6, 0.8)) <= 1e-16);
    CHECK(distance(wall.axis, Vec3<double>(0, 0, -1)) == 0);
}

TEST_CASE(a_part_of_the_body_says_how_stiff_the_wall_is_unless_it_is_said_otherwise) {
    const Key& stiffness = *find_key("wall.contact.stiffness");
    const auto fallback = [&](const Params& params) { return default_of(stiffness, params)[0]; };
    const Params walled = unequal_params().set("wall", 1);
    CHECK(fallback(walled) == 1000);
    CHECK(fallback(Params(walled).choose("wall.contact.preset", "chest")) == 25e3);
    CHECK(fallback(Params(walled).choose("wall.contact.preset", "hands_and_fingers")) == 75e3);
    CHECK(fallback(Params(walled).choose("wall.contact.law", "kelvin_voigt")) == 1000);
    for (const char* law : {"diagonal", "hunt_crossley"})
        CHECK(std::isnan(fallback(Params(walled).choose("wall.contact.law", law))));
}

// ---- the solver

TEST_CASE(the_solver_is_as_it_was_asked_for) {
    Params params = unequal_params().set("solver.rtol", 1e-5).set("solver.atol", 1e-6).set("solver.tol", 1e-7);
    params.set("solver.step", 0.25).set("solver.max_steps", 12);
    const std::pair<const char*, SolverMethod> methods[] = {
        {"dopri5", SolverMethod::dopri5}, {"rk4", SolverMethod::rk4}, {"taylor", SolverMethod::taylor}};
    for (const auto& [word, method] : methods)
        CHECK((make_setup(params.choose("solver.method", word)).solver.method == method));
    CHECK(make_setup(params).solver.max_step == HUGE_VAL);
    const Solver solver = make_setup(params.set("solver.max_step", 0.5)).solver;
    CHECK(solver.rtol == 1e-5);
    CHECK(solver.atol == 1e-6);
    CHECK(solver.tol == 1e-7);
    CHECK(solver.max_step == 0.5);
    CHECK(solver.step == 0.25);
    CHECK(solver.max_steps == 12);
}

// ---- what shapes give

TEST_CASE(shapes_give_mass_centre_and_inertia) {
    Params params = unequal_params();
    params.set("arm.link2.section", {0.02, 0.03}).set("arm.link2.density", 1000).set("arm.link2.mass", std::nan(""));
    params.choose("arm.link3.shape", "cylinder").set("arm.link3.radius", 0.05).set("arm.link3.mass", 2);
    params.choose("arm.link1.shape", "slender")
        .set("arm.link1.length", 0.4)
        .set("arm.link1.mass", 3)
        .set("arm.link1.com", std::nan(""));
    const Arm<double> arm = params.arm();
    const double m = 1000 * 0.8 * 0.02 * 0.03, a = 0.8;
    CHECK(arm.link2.mass == m);
    CHECK(arm.link2.com == 0.4);
    CHECK(arm.link2.inertia[0] == m * (0.03 * 0.03 + 0.02 * 0.02) / 12);
    CHECK(arm.link2.inertia[1] == m * (a * a + 0.03 * 0.03) / 12);
    CHECK(arm.link2.inertia[2] == m * (a * a + 0.02 * 0.02) / 12);
    CHECK(arm.link3.mass == 2);
    CHECK(arm.link3.inertia[0] == 2 * 0.05 * 0.05 / 2);
    CHECK(arm.link3.inertia[1] == 2 * (3 * 0.05 * 0.05 + 0.6 * 0.6) / 12);
    CHECK(arm.link3.inertia[1] == arm.link3.inertia[2]);
    CHECK(arm.link1.com == 0.2);
    CHECK(arm.link1.inertia_axial == 0.02);
    CHECK(params.set("arm.link1.inertia_axial", std::nan("")).arm().link1.inertia_axial == 0);
}

TEST_CASE(the_controllers_model_differs_only_in_the_keys_that_are_given) {
    Params params = unequal_params();
    params.choose("controller.type", "gravity_compensation")
        .set("controller.model.link3.mass", 0.9)
        .set("arm.payload.mass", 0.2);
    const Setup setup = make_setup(params);
    const Arm<double>&plant = setup.plant.arm, &model = setup.plant.controller.model;
    CHECK(model.link3.mass == 0.9);
    CHECK(plant.link3.mass == 0.7);
    CHECK(model.payload == 0.2);
    CHECK(model.link2.mass == plant.link2.mass);
    CHECK(model.gravity[2] == -9.80665);
}

// ---- warnings

static std::vector<std::string> warnings(const Params& params) { return scenario_warnings(make_setup(params)); }

static void check_slip(const Params& params, const std::string& part) {
    const std::vector<std::string> found = warnings(params);
    CHECK(found.size() == 1u);
    CHECK((!found.empty() && contains(found.front(), part)), part << " in: " << (found.empty() ? "" : found.front()));
}

TEST_CASE(nothing_is_said_of_an_ordinary_scenario) {
    CHECK(warnings(unequal_params()).empty());
    CHECK(warnings(unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1)).empty());
}

TEST_CASE(two_gravities_within_a_percent_but_not_equal_are_named) {
    Params params = unequal_params().choose("controller.type", "gravity_compensation");
    check_slip(Params(params).set("controller.gravity", 9.8065), "9.8065");
    check_slip(Params(params).set("controller.gravity", 9.72), "9.72");
    CHECK(warnings(Params(params).set("controller.gravity", 9.66)).empty());
}

TEST_CASE(an_angle_that_looks_like_degrees_is_named) {
    check_slip(unequal_params().set("initial.q", {0.4, -30, 0.2}), "`-30 deg`");
    CHECK(warnings(unequal_params().set("initial.q", {0.4, 720 * M_PI / 180, 0.2})).empty());
}

TEST_CASE(a_wall_that_passes_the_shoulder_is_named) {
    Params params = unequal_params().set("wall", 1).set("time.stop", 50);
    check_slip(params, "shoulder");
    CHECK(warnings(params.set("time.stop", 30)).empty());
}

TEST_CASE(a_fixed_step_that_cannot_resolve_the_contact_is_named) {
    Params params = unequal_params().set("wall", 1).set("wall.acts_on_arm", 1).choose("solver.method", "rk4");
    check_slip(Params(params).set("wall.contact.stiffness", 1e8), "solver.step");
    CHECK(warnings(params).empty());
    params.choose("wall.contact.law", "kelvin_voigt");
    CHECK(warnings(Params(params).set("wall.contact.damping", 100)).empty());
    check_slip(Params(params).set("wall.contact.damping", 2000), "solver.step");
}

TEST_CASE(units_off_by_powers_of_ten_are_a_slip) {
    const Params params = unequal_params();
    const Vec3<double> I = params.arm().link2.inertia;
    const Params in_g_cm2 = Params(params).set("arm.link2.inertia", Vec3<double>(1e7 * I));
    REQUIRE(warnings(in_g_cm2).size() == 1u);
    CHECK(warnings(in_g_cm2)[0].find("g cm^2") != std::string::npos);
    const std::vector<std::string> in_mm = warnings(Params(params).set("arm.link3.length", 700));
    CHECK(std::count_if(in_mm.begin(), in_mm.end(),
                        [](const std::string& slip) { return slip.find("millimetres") != slip.npos; }) == 1);
}

TEST_SUITE_END()

}  // namespace arm3r
