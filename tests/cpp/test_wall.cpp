#include <boost/test/unit_test.hpp>

#include "arm3r/contact.hpp"
#include "fixtures.hpp"

namespace arm3r {

BOOST_AUTO_TEST_SUITE(wall)

static Wall<double> wall_of(const Params& params) { return make_setup(params).plant.wall; }

static Params walled() { return unequal_params().set("wall", 1).set("wall.point", {2, 0.3, -0.4}); }

static bool close(const Vec3<double>& a, const Vec3<double>& b, double tolerance = 1e-15) {
    return distance(a, b) <= tolerance;
}

// ---- the frame

BOOST_AUTO_TEST_CASE(the_lectures_plate_has_e1_along_y_and_e2_along_z) {
    const Wall<double> wall = wall_of(walled());
    BOOST_TEST(close(wall.n, {-1, 0, 0}, 0));
    BOOST_TEST(close(wall.e1, {0, 1, 0}, 0));
    BOOST_TEST(close(wall.e2, {0, 0, 1}, 0));
}

BOOST_AUTO_TEST_CASE(a_level_plate_has_e1_along_y) {
    for (const double up : {3.0, -0.5}) {
        const Wall<double> wall = wall_of(walled().set("wall.normal", {0, 0, up}));
        BOOST_TEST(close(wall.e1, {0, 1, 0}, 0));
        BOOST_TEST(close(wall.e2, {up > 0 ? 1.0 : -1.0, 0, 0}, 0));
    }
}

BOOST_AUTO_TEST_CASE(any_plate_has_a_right_handed_orthonormal_frame_with_e1_level) {
    Random random(31);
    for (int i = 0; i < 1000; ++i) {
        const Vec3<double> normal = random.vector(-3, 3);
        const Wall<double> wall = wall_of(walled().set("wall.normal", normal));
        Eigen::Matrix3d frame;
        frame << wall.n, wall.e1, wall.e2;
        BOOST_TEST(close(wall.n, normal.normalized()));
        BOOST_TEST(distance(frame.transpose() * frame, Eigen::Matrix3d::Identity()) <= 1e-14);
        BOOST_TEST(close(cross(wall.e1, wall.n), wall.e2));
        BOOST_TEST(wall.e1[2] == 0);
        BOOST_TEST(dot(wall.e1, cross(wall.n, Vec3<double>(0, 0, 1))) > 0);
    }
}

// ---- motions

// Velocity and acceleration are the derivatives of position and velocity.
static void check_motion(const Wall<double>& wall, double t) {
    const Dual<1> now = Dual<1>::variable(t, 0);
    const WallState<Dual<1>> state = wall_at(wall, now);
    for (int i = 0; i < 3; ++i) {
        BOOST_TEST(std::abs(state.position[i].slope[0] - state.velocity[i].number) <= 1e-12);
        BOOST_TEST(std::abs(state.velocity[i].slope[0] - state.acceleration[i].number) <= 1e-10);
    }
    constexpr double h = 1e-4;
    const WallState<double> before = wall_at(wall, t - h), at = wall_at(wall, t), after = wall_at(wall, t + h);
    const Vec3<double> v = (after.position - before.position) / (2 * h),
                       a = (after.velocity - before.velocity) / (2 * h);
    BOOST_TEST(distance(v, at.velocity) <= 1e-6);
    BOOST_TEST(distance(a, at.acceleration) <= 1e-5);
}

BOOST_AUTO_TEST_CASE(velocity_and_acceleration_are_derivatives) {
    const Params oblique = walled().set("wall.normal", {-1, 0.4, 0.3});
    Params sinusoid = Params(oblique).choose("wall.motion.type", "sinusoid");
    sinusoid.set("wall.motion.amplitude", 0.03).set("wall.motion.frequency", 1.7).set("wall.motion.phase", 0.6);
    for (const double t : {0.01, 0.7, 13.3}) {
        check_motion(wall_of(Params(oblique).choose("wall.motion.type", "fixed")), t);
        check_motion(wall_of(oblique), t);
        check_motion(wall_of(Params(oblique).set("wall.motion.velocity", {0.1, -0.2, 0.3})), t);
        check_motion(wall_of(sinusoid), t);
    }
}

BOOST_AUTO_TEST_CASE(each_motion_starts_at_the_point_and_goes_where_it_says) {
    const Vec3<double> point(2, 0.3, -0.4), n = Vec3<double>(-1, 0.4, 0.3).normalized();
    const Params oblique = walled().set("wall.normal", {-1, 0.4, 0.3});
    const auto at = [](const Params& params, double t) -> Vec3<double> { return wall_at(wall_of(params), t).position; };
    BOOST_TEST(close(at(Params(oblique).choose("wall.motion.type", "fixed"), 3), point, 0));
    BOOST_TEST(close(at(oblique, 3), point + 0.05 * 3 * n));
    BOOST_TEST(close(at(Params(oblique).set("wall.motion.velocity", {0.1, -0.2, 0.3}), 3),
                     point + 3 * Vec3<double>(0.1, -0.2, 0.3)));
    Params sinusoid = Params(oblique).choose("wall.motion.type", "sinusoid");
    sinusoid.set("wall.motion.amplitude", 0.03).set("wall.motion.frequency", 0.25).set("wall.motion.phase", M_PI / 6);
    BOOST_TEST(close(at(sinusoid, 0), point, 0));
    BOOST_TEST(close(at(sinusoid, 2.0 / 3), point + 0.03 * (1 - 0.5) * n));
}

BOOST_AUTO_TEST_CASE(a_sinusoid_is_still_on_its_curve_after_1e9_periods) {
    Params params = walled().choose("wall.motion.type", "sinusoid");
    params.set("wall.motion.amplitude", 1).set("wall.motion.frequency", 512).set("wall.motion.phase", 0);
    const Wall<double> wall = wall_of(params);
    for (const double turns : {0.0, 1.0, 1e6, 1e9}) {
        const double t = (turns + 0.0625) / 512;
        const WallState<double> state = wall_at(wall, t);
        const double phase = 2 * M_PI * (512 * t - turns);  // exact: 512 is a power of two
        BOOST_TEST(std::abs((2 - state.position[0]) - std::sin(phase)) <= 2e-15);
        BOOST_TEST(std::abs(-state.velocity[0] / (2 * M_PI * 512) - std::cos(phase)) <= 2e-15);
    }
}

// ---- a point, as the plate sees it

BOOST_AUTO_TEST_CASE(depth_and_its_rate_are_those_of_the_point_behind_the_face) {
    Random random(32);
    for (int i = 0; i < 1000; ++i) {
        Params params =
            walled().set("wall.normal", random.vector(-3, 3)).set("wall.motion.velocity", random.vector(-1, 1));
        const Wall<double> wall = wall_of(params.set("wall.face_offset", 0.07).set("wall.size", {0.8, 0.5}));
        const Vec3<double> x = random.vector(-2, 2), v = random.vector(-2, 2);
        const double t = random.in(0, 3);
        const Indentation<Dual<1>> in =
            indentation(wall, wall_at(wall, Dual<1>::variable(t, 0)), moving(x, v), moving(v, {0, 0, 0}));
        const Vec3<double> from_frame = x - wall_at(wall, t).position;
        BOOST_TEST(std::abs(in.depth.number - (0.07 - wall.n.dot(from_frame))) <= 1e-14);
        BOOST_TEST(std::abs(in.depth.slope[0] - in.rate.number) <= 1e-14);
        BOOST_TEST(std::abs(in.across1.number - wall.e1.dot(from_frame)) <= 1e-14);
        BOOST_TEST(std::abs(in.across2.number - wall.e2.dot(from_frame)) <= 1e-14);
        BOOST_TEST(std::abs(in.across1.slope[0] - in.slip1.number) <= 1e-14);
        BOOST_TEST(std::abs(in.across2.slope[0] - in.slip2.number) <= 1e-14);
        const double margin = std::min(0.4 - std::abs(in.across1.number), 0.25 - std::abs(in.across2.number));
        BOOST_TEST(inside_outline(wall, in).number == margin);
    }
}

// ---- the laws

BOOST_AUTO_TEST_CASE(a_spring_is_conservative_and_pushes_along_the_normal) {
    const Wall<double> wall = wall_of(walled().set("wall.normal", {-1, 0.4, 0.3}));
    const Contact<double> spring{Law::spring, {1234, 0, 0}};
    const Indentation<Dual<1>> in{Dual<1>::variable(0.003, 0), 0.1, 0.2, -0.3, 0.4, 0.5};
    const ContactForce<Dual<1>> force = contact_force(wall, spring, in);
    BOOST_TEST(force.normal.number == 1234 * 0.003);
    BOOST_TEST(std::abs(force.stored.slope[0] - force.normal.number) <= 1e-15);
    BOOST_TEST(force.dissipated.number == 0);
    for (int i = 0; i < 3; ++i) BOOST_TEST(force.on_tip[i].number == force.normal.number * wall.n[i]);
}

// The lecture's K_E (x - x_E), axis by axis.
BOOST_AUTO_TEST_CASE(a_diagonal_stiffness_is_the_lectures_force_on_the_wall) {
    const Wall<double> wall = wall_of(walled());
    const Contact<double> diagonal{Law::diagonal, {1000, 200, 30}};
    const Vec3<double> origin = wall_at(wall, 1.0).position, x = origin + Vec3<double>(0.002, 0.05, -0.07);
    const ContactForce<double> force =
        contact_force(wall, diagonal, indentation(wall, wall_at(wall, 1.0), x, Vec3<double>(0, 0, 0)));
    BOOST_TEST(close(-force.on_tip, {1000 * 0.002, 200 * 0.05, 30 * -0.07}, 1e-12));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace arm3r
