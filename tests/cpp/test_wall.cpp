#include "arm3r/model/wall.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "linear_algebra.hpp"

namespace arm3r {

TEST_SUITE(wall)

static Wall<double> wall_of(const Params& params) { return make_setup(params).plant.wall; }

static Params walled() { return unequal_params().set("wall", 1).set("wall.point", {2, 0.3, -0.4}); }

static bool close(const Vec3<double>& a, const Vec3<double>& b, double tolerance = 1e-15) {
    return distance(a, b) <= tolerance;
}

// ---- the frame

TEST_CASE(the_lectures_plate_has_e1_along_y_and_e2_along_z) {
    const Wall<double> wall = wall_of(walled());
    CHECK(close(wall.n, {-1, 0, 0}, 0));
    CHECK(close(wall.e1, {0, 1, 0}, 0));
    CHECK(close(wall.e2, {0, 0, 1}, 0));
}

TEST_CASE(a_level_plate_has_e1_along_y) {
    for (const double up : {3.0, -0.5}) {
        const Wall<double> wall = wall_of(walled().set("wall.normal", {0, 0, up}));
        CHECK(close(wall.e1, {0, 1, 0}, 0));
        CHECK(close(wall.e2, {up > 0 ? 1.0 : -1.0, 0, 0}, 0));
    }
}

TEST_CASE(any_plate_has_a_right_handed_orthonormal_frame_with_e1_level) {
    Random random(31);
    for (int i = 0; i < 1000; ++i) {
        const Vec3<double> normal = random.vector(-3, 3);
        const Wall<double> wall = wall_of(walled().set("wall.normal", normal));
        Eigen::Matrix3d frame;
        frame << wall.n, wall.e1, wall.e2;
        CHECK(close(wall.n, normal.normalized()));
        CHECK(distance(frame.transpose() * frame, Eigen::Matrix3d::Identity()) <= 1e-14);
        CHECK(close(cross(wall.e1, wall.n), wall.e2));
        CHECK(wall.e1[2] == 0);
        CHECK(dot(wall.e1, cross(wall.n, Vec3<double>(0, 0, 1))) > 0);
    }
}

// ---- motions

static Vec3<double> spin_of(const Wall<double>& wall, double t) {
    return wall.rotation == Rotation::none ? Vec3<double>(0, 0, 0)
                                           : Vec3<double>(wall_at(wall, t).turn_rate * wall.axis);
}

// Velocity and acceleration are the derivatives of position and velocity, and the frame turns at its spin.
static void check_motion(const Wall<double>& wall, double t) {
    const Dual<1> now = Dual<1>::variable(t, 0);
    const WallState<Dual<1>> state = wall_at(wall, now);
    const auto number = [](const Vec3<Dual<1>>& v) { return Vec3<double>(v[0].number, v[1].number, v[2].number); };
    const auto slope = [](const Vec3<Dual<1>>& v) { return Vec3<double>(v[0].slope[0], v[1].slope[0], v[2].slope[0]); };
    CHECK(distance(slope(state.position), number(state.velocity)) <= 1e-12);
    CHECK(distance(slope(state.velocity), number(state.acceleration)) <= 1e-10);
    const Axes<Dual<1>> frame = axes(wall, state);
    const Vec3<double> spin = spin_of(wall, t);
    for (const auto* axis : {&frame.n, &frame.e1, &frame.e2})
        CHECK(distance(slope(*axis), cross_product(spin, number(*axis))) <= 1e-12 * (1 + spin.norm()));
    constexpr double h = 1e-4;
    const WallState<double> before = wall_at(wall, t - h), at = wall_at(wall, t), after = wall_at(wall, t + h);
    const Vec3<double> v = (after.position - before.position) / (2 * h),
                       a = (after.velocity - before.velocity) / (2 * h),
                       turn = (normal(wall, after) - normal(wall, before)) / (2 * h);
    CHECK(distance(v, at.velocity) <= 1e-6);
    CHECK(distance(a, at.acceleration) <= 1e-5);
    CHECK(distance(turn, cross_product(spin, normal(wall, at))) <= 1e-6);
}

static Params sinusoid(const Params& params, double amplitude, double frequency, double phase) {
    Params swinging = Params(params).choose("wall.motion.type", "sinusoid").set("wall.motion.amplitude", amplitude);
    return swinging.set("wall.motion.frequency", frequency).set("wall.motion.phase", phase);
}

static Params ramp(const Params& params, double distance, double start, double duration) {
    Params rising = Params(params).choose("wall.motion.type", "ramp").set("wall.motion.distance", distance);
    return rising.set("wall.motion.start", start).set("wall.motion.duration", duration);
}

// A table with a knot at each of `t`, through s and its derivatives.
template <class S, class V, class A>
static Params table(const Params& params, const std::vector<double>& t, S s, V v, A a) {
    Params given = Params(params).choose("wall.motion.type", "table");
    for (std::size_t i = 0; i < t.size(); ++i) {
        const std::string item = "[" + std::to_string(i) + "]";
        given.set("wall.motion.t" + item, t[i]).set("wall.motion.s" + item, s(t[i]));
        given.set("wall.motion.v" + item, v(t[i])).set("wall.motion.a" + item, a(t[i]));
    }
    return given;
}

static const auto wave = [](double t) { return 0.1 * std::sin(1.7 * t); };
static const auto wave_v = [](double t) { return 0.17 * std::cos(1.7 * t); };
static const auto wave_a = [](double t) { return -0.289 * std::sin(1.7 * t); };

static Params turning(const Params& params) {
    return Params(params)
        .choose("wall.rotation.type", "constant")
        .set("wall.rotation.axis", {0.3, 2, -0.7})
        .set("wall.rotation.rate", 1.3);
}

static Params nodding(const Params& params) {
    Params swinging = Params(params).choose("wall.rotation.type", "sinusoid");
    swinging.set("wall.rotation.axis", {0.3, 2, -0.7}).set("wall.rotation.amplitude", 0.4);
    return swinging.set("wall.rotation.frequency", 0.8).set("wall.rotation.phase", 0.5);
}

TEST_CASE(velocity_and_acceleration_are_derivatives) {
    const Params oblique = walled().set("wall.normal", {-1, 0.4, 0.3});
    const Params aside = Params(oblique).set("wall.motion.direction", {0.2, 3, -1});
    const std::vector<double> knots = {0, 0.4, 0.9, 2, 14};
    for (const double t : {0.01, 0.7, 13.3}) {
        check_motion(wall_of(Params(oblique).choose("wall.motion.type", "fixed")), t);
        check_motion(wall_of(oblique), t);
        check_motion(wall_of(Params(oblique).set("wall.motion.velocity", {0.1, -0.2, 0.3})), t);
        for (const Params& params : {oblique, aside}) {
            check_motion(wall_of(sinusoid(params, 0.03, 1.7, 0.6)), t);
            check_motion(wall_of(ramp(params, 0.3, 0.2, 0.9)), t);
            check_motion(wall_of(ramp(params, -0.3, 0, 20)), t);
            check_motion(wall_of(table(params, knots, wave, wave_v, wave_a)), t);
            check_motion(wall_of(turning(sinusoid(params, 0.03, 1.7, 0.6))), t);
        }
        check_motion(wall_of(turning(oblique)), t);
        check_motion(wall_of(nodding(oblique)), t);
    }
}

TEST_CASE(each_motion_starts_at_the_point_and_goes_where_it_says) {
    const Vec3<double> point(2, 0.3, -0.4), n = Vec3<double>(-1, 0.4, 0.3).normalized();
    const Params oblique = walled().set("wall.normal", {-1, 0.4, 0.3});
    const auto at = [](const Params& params, double t) -> Vec3<double> { return wall_at(wall_of(params), t).position; };
    CHECK(close(at(Params(oblique).choose("wall.motion.type", "fixed"), 3), point, 0));
    CHECK(close(at(oblique, 3), point + 0.05 * 3 * n));
    CHECK(close(at(Params(oblique).set("wall.motion.velocity", {0.1, -0.2, 0.3}), 3),
                point + 3 * Vec3<double>(0.1, -0.2, 0.3)));
    const Params swinging = sinusoid(oblique, 0.03, 0.25, M_PI / 6);
    CHECK(close(at(swinging, 0), point, 0));
    CHECK(close(at(swinging, 2.0 / 3), point + 0.03 * (1 - 0.5) * n));
    const Vec3<double> aside(0.6, -0.8, 0);
    const Params along = Params(swinging).set("wall.motion.direction", Vec3<double>(7 * aside));
    CHECK(close(at(along, 2.0 / 3), point + 0.03 * (1 - 0.5) * aside));
}

TEST_CASE(a_ramp_rests_at_both_ends_and_is_half_way_at_half_time) {
    const Params params = ramp(walled(), 0.4, 1.5, 2);
    const Wall<double> wall = wall_of(params);
    const auto gone = [&](double t) { return 2 - wall_at(wall, t).position[0]; };
    for (const double t : {0.0, 1.0, 1.5}) CHECK(gone(t) == 0);
    for (const double t : {3.5, 4.0, 1e6}) CHECK(std::abs(gone(t) - 0.4) <= 2e-16);
    CHECK(std::abs(gone(2.5) - 0.2) <= 2e-16);
    CHECK(std::abs(gone(2.0) - 0.4 * 0.103515625) <= 1e-15);  // 10/64 - 15/256 + 6/1024
    CHECK(std::abs(-wall_at(wall, 2.5).velocity[0] - 1.875 * 0.4 / 2) <= 1e-15);
    for (const double t : {1.0, 1.5, 3.5, 9.0}) {
        CHECK(close(wall_at(wall, t).velocity, {0, 0, 0}, 0));
        CHECK(close(wall_at(wall, t).acceleration, {0, 0, 0}, 0));
    }
}

TEST_CASE(a_table_of_a_quintic_is_that_quintic_and_stands_still_outside) {
    const auto s = [](double t) { return 0.1 + t * (0.2 + t * (-0.3 + t * (0.15 + t * (-0.02 + t * 0.001)))); };
    const auto v = [](double t) { return 0.2 + t * (-0.6 + t * (0.45 + t * (-0.08 + t * 0.005))); };
    const auto a = [](double t) { return -0.6 + t * (0.9 + t * (-0.24 + t * 0.02)); };
    std::vector<double> all_knots;  // as many as a key has places for
    for (int i = 0; i < 16; ++i) all_knots.push_back(0.5 + 0.25 * i + 0.01 * i * i);
    for (const std::vector<double>& knots : {std::vector<double>{0.5, 3}, {0.5, 1.1, 1.3, 3}, all_knots}) {
        const Wall<double> wall = wall_of(table(walled(), knots, s, v, a));
        for (double t = knots.front(); t < knots.back(); t += 0.0371) {
            const WallState<double> state = wall_at(wall, t);
            CHECK(std::abs((2 - state.position[0]) - s(t)) <= 1e-14);
            CHECK(std::abs(-state.velocity[0] - v(t)) <= 1e-13);
            CHECK(std::abs(-state.acceleration[0] - a(t)) <= 2e-12);
        }
        for (const double outside : {0.0, knots.front() - 1e-9, knots.back(), knots.back() + 1e-9, 1e9}) {
            const WallState<double> state = wall_at(wall, outside);
            const double held = s(outside < knots.front() ? knots.front() : knots.back());
            CHECK(std::abs((2 - state.position[0]) - held) <= 1e-14);
            CHECK(close(state.velocity, {0, 0, 0}, 0));
            CHECK(close(state.acceleration, {0, 0, 0}, 0));
        }
    }
}

TEST_CASE(a_turning_plate_is_the_plate_turned_about_its_origin) {
    const Vec3<double> axis = Vec3<double>(0.3, 2, -0.7).normalized();
    const Params oblique = walled().set("wall.normal", {-1, 0.4, 0.3});
    const Wall<double> still = wall_of(oblique), steady = wall_of(turning(oblique)), swings = wall_of(nodding(oblique));
    for (const double t : {0.0, 0.3, 2.9, 777.7, 1e6}) {
        const double swung = 0.4 * (std::sin(2 * M_PI * 0.8 * t + 0.5) - std::sin(0.5));
        for (const auto& [wall, angle, tolerance] :
             {std::tuple(&steady, 1.3 * t, 1e-15 * (1 + t)), std::tuple(&swings, swung, 1e-14 * (1 + t))}) {
            const Eigen::Matrix3d R = rotation(angle, axis);
            const WallState<double> state = wall_at(*wall, t);
            const Axes<double> frame = axes(*wall, state);
            CHECK(close(frame.n, R * still.n, tolerance));
            CHECK(close(frame.e1, R * still.e1, tolerance));
            CHECK(close(frame.e2, R * still.e2, tolerance));
            CHECK(close(state.position, wall_at(still, t).position, 0));
        }
        CHECK(close(spin_of(steady, t), 1.3 * axis));
    }
}

TEST_CASE(a_sinusoid_is_still_on_its_curve_after_1e9_periods) {
    const Wall<double> wall = wall_of(sinusoid(walled(), 1, 512, 0));
    for (const double turns : {0.0, 1.0, 1e6, 1e9}) {
        const double t = (turns + 0.0625) / 512;
        const WallState<double> state = wall_at(wall, t);
        const double phase = 2 * M_PI * (512 * t - turns);  // exact: 512 is a power of two
        CHECK(std::abs((2 - state.position[0]) - std::sin(phase)) <= 2e-15);
        CHECK(std::abs(-state.velocity[0] / (2 * M_PI * 512) - std::cos(phase)) <= 2e-15);
    }
}

// ---- a point, as the plate sees it

TEST_CASE(depth_and_its_rate_are_those_of_the_point_behind_the_face) {
    Random random(32);
    for (int i = 0; i < 1000; ++i) {
        Params params =
            walled().set("wall.normal", random.vector(-3, 3)).set("wall.motion.velocity", random.vector(-1, 1));
        if (i % 2 == 1) params = turning(params).set("wall.rotation.axis", random.vector(-1, 1));
        const Wall<double> wall = wall_of(params.set("wall.face_offset", 0.07).set("wall.size", {0.8, 0.5}));
        const Vec3<double> x = random.vector(-2, 2), v = random.vector(-2, 2);
        const double t = random.in(0, 3);
        const WallState<double> now = wall_at(wall, t);
        const Axes<double> frame = axes(wall, now);
        const Indentation<Dual<1>> in =
            indentation(wall, wall_at(wall, Dual<1>::variable(t, 0)), moving(x, v), moving(v, {0, 0, 0}));
        const Vec3<double> from_frame = x - now.position;
        CHECK(std::abs(in.depth.number - (0.07 - frame.n.dot(from_frame))) <= 1e-14);
        CHECK(std::abs(in.depth.slope[0] - in.rate.number) <= 1e-13);
        CHECK(std::abs(in.across1.number - frame.e1.dot(from_frame)) <= 1e-14);
        CHECK(std::abs(in.across2.number - frame.e2.dot(from_frame)) <= 1e-14);
        CHECK(std::abs(in.across1.slope[0] - in.slip1.number) <= 1e-13);
        CHECK(std::abs(in.across2.slope[0] - in.slip2.number) <= 1e-13);
        const double margin = std::min(0.4 - std::abs(in.across1.number), 0.25 - std::abs(in.across2.number));
        CHECK(inside_outline(wall, in).number == margin);
        const Vec3<double> riding = velocity_at(wall, now, x);  // a point that goes with the plate sinks in nowhere
        const Indentation<double> at_rest = indentation(wall, now, x, riding);
        for (const double rate : {at_rest.rate, at_rest.slip1, at_rest.slip2}) CHECK(std::abs(rate) <= 1e-14);
    }
}

TEST_SUITE_END()

}  // namespace arm3r
