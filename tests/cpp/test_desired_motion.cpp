#include "arm3r/control/reference.hpp"

#include "check.hpp"
#include "fixtures.hpp"
#include "linear_algebra.hpp"

namespace arm3r {

// Positions where they are promised, and velocities and accelerations that are their derivatives.
TEST_SUITE(reference)

using Vector = Eigen::Vector3d;

static bool close(const Vector& a, const Vector& b, double tolerance = 1e-13) {
    return distance(a, b) <= tolerance * (1 + a.cwiseAbs().maxCoeff());
}

static bool close(double a, double b, double tolerance = 1e-13) {
    return std::abs(a - b) <= tolerance * (1 + std::abs(a));
}

static Reference<double> random_setpoint(Random& random, Path path) {
    Reference<double> s{};
    s.path = path;
    s.from = random.vector(-1, 1);
    s.to = random.vector(-1, 1);
    s.start = random.in(0.1, 2);
    s.duration = random.in(0.3, 3);
    s.end = s.start + s.duration;
    s.across1 = random.vector(-1, 1);
    s.across2 = cross_product(s.across1, random.vector(-1, 1)).normalized() * s.across1.norm();
    s.turns = random.in(0.2, 3);
    s.amplitude = random.vector(-1, 1);
    s.frequency = random.in(0.1, 2);
    return s;
}

static const Path paths[] = {Path::hold, Path::point, Path::line, Path::minimum_jerk, Path::circle, Path::sinusoid};

template <class F>
static void for_paths(F check) {
    Random random(1);
    for (const Path path : paths)
        for (int i = 0; i < 50; ++i) check(random_setpoint(random, path), random);
}

TEST_CASE(velocity_and_acceleration_are_the_derivatives) {
    for_paths([](const Reference<double>& s, Random& random) {
        for (const double share : {-0.4, random.in(0.02, 0.98), 1.4}) {
            const double t = s.start + share * s.duration, h = 1e-3 * s.duration;
            const auto difference = [&](auto part) -> Vector {
                const auto at = [&](double time) -> Vector { return part(desired_motion_at(s, time)); };
                return (at(t - 2 * h) - 8 * at(t - h) + 8 * at(t + h) - at(t + 2 * h)) / (12 * h);
            };
            const DesiredMotion<double> wanted = desired_motion_at(s, t);
            const double size = 1 / (s.duration * s.duration);
            CHECK(close(wanted.velocity, difference([](const auto& w) { return w.position; }), 1e-7 * (1 + size)));
            CHECK(close(wanted.acceleration, difference([](const auto& w) { return w.velocity; }), 1e-7 * (1 + size)));
        }
    });
}

// The value of a path before its start, and after its end if it has one.
TEST_CASE(paths_begin_and_end_where_they_should) {
    for_paths([](const Reference<double>& s, Random&) {
        const Vector still = Vector::Zero();
        const Vector begin = s.path == Path::point ? s.to : s.from;
        for (const double t : {0.0, 0.9 * s.start}) {
            const DesiredMotion<double> before = desired_motion_at(s, t);
            CHECK(close(begin, before.position));
            CHECK(close(still, before.velocity));
            CHECK(close(still, before.acceleration));
        }
        if (s.path == Path::sinusoid) return;
        const double angle = 2 * M_PI * s.turns;
        const Vector centre = s.from - s.across1;
        const Vector end = s.path == Path::hold ? Vector(s.from)
                           : s.path == Path::circle
                               ? Vector(centre + std::cos(angle) * s.across1 + std::sin(angle) * s.across2)
                               : Vector(s.to);
        for (const double late : {1e-9, 5.0}) {
            const DesiredMotion<double> after = desired_motion_at(s, s.start + s.duration + late);
            CHECK(close(end, after.position, 1e-12));
            CHECK(close(still, after.velocity));
            CHECK(close(still, after.acceleration));
        }
    });
}

TEST_CASE(a_line_is_even_and_a_minimum_jerk_motion_is_that_of_the_quintic) {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const double x = random.in(0, 1);
        const Reference<double> line = random_setpoint(random, Path::line);
        const Vector way = line.to - line.from;
        const DesiredMotion<double> even = desired_motion_at(line, line.start + x * line.duration);
        CHECK(close(Vector(line.from) + x * way, even.position));
        CHECK(close(way / line.duration, even.velocity));

        const Reference<double> smooth = random_setpoint(random, Path::minimum_jerk);
        const double s = 10 * std::pow(x, 3) - 15 * std::pow(x, 4) + 6 * std::pow(x, 5);
        CHECK(close(Vector(smooth.from) + s * (smooth.to - smooth.from),
                    desired_motion_at(smooth, smooth.start + x * smooth.duration).position));
    }
}

TEST_CASE(a_circle_keeps_its_distance_and_its_plane) {
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const Reference<double> s = random_setpoint(random, Path::circle);
        const Vector centre = s.from - s.across1, axis = cross_product(s.across1, s.across2).normalized();
        const double x = random.in(0, 1);
        const Vector out = Vector(desired_motion_at(s, s.start + x * s.duration).position) - centre;
        CHECK(close(s.across1.norm(), out.norm()));
        CHECK(std::abs(axis.dot(out)) < 1e-13);
        const double angle = 2 * M_PI * s.turns * (10 * std::pow(x, 3) - 15 * std::pow(x, 4) + 6 * std::pow(x, 5));
        CHECK(close(std::cos(angle) * s.across1 + std::sin(angle) * s.across2, out, 1e-12));
    }
}

TEST_CASE(a_sinusoid_swings_about_its_start) {
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const Reference<double> s = random_setpoint(random, Path::sinusoid);
        const double since = random.in(0, 100), omega = 2 * M_PI * s.frequency;
        const DesiredMotion<double> wanted = desired_motion_at(s, s.start + since);
        CHECK(close(Vector(s.from) + std::sin(omega * since) * s.amplitude, wanted.position, 1e-11));
        CHECK(close(omega * std::cos(omega * since) * s.amplitude, wanted.velocity, 1e-11));
    }
}

// ---- the pressing force

static Reference<double> pressing(ForceProfile kind) {
    Reference<double> s{};
    s.force_profile = kind;
    s.force = 20;
    s.force_before = 5;
    s.force_start = 1.5;
    s.force_duration = 0.4;
    s.force_amplitude = 2;
    s.force_frequency = 3;
    return s;
}

TEST_CASE(the_force_is_constant_steps_ramps_or_swings) {
    const Reference<double> constant = pressing(ForceProfile::constant), step = pressing(ForceProfile::step),
                            ramp = pressing(ForceProfile::ramp), swing = pressing(ForceProfile::sinusoid);
    for (const double t : {0.0, 1.4999, 1.5, 1.6, 1.9, 1.91, 7.0}) {
        CHECK(desired_force_at(constant, t) == 20);
        CHECK(desired_force_at(step, t) == (t < 1.5 ? 5 : 20));
        const double share = t < 1.5 ? 0 : t < 1.9 ? (t - 1.5) / 0.4 : 1;
        CHECK(close(5 + 15 * share, desired_force_at(ramp, t)));
        CHECK(close(20 + 2 * std::sin(6 * M_PI * t), desired_force_at(swing, t)));
    }
}

// ---- lanes

TEST_CASE(lanes_have_the_bits_of_each_setpoint_alone) {
    Random random(7);
    for (const Path path : paths) {
        const Reference<double> s = random_setpoint(random, path);
        Pack<8> times;
        for (int lane = 0; lane < 8; ++lane) times.set(lane, s.start + s.duration * random.in(-0.5, 1.5));
        const DesiredMotion<Pack<8>> together = desired_motion_at(s, times);
        for (int lane = 0; lane < 8; ++lane) {
            const DesiredMotion<double> alone = desired_motion_at(s, times[lane]);
            for (int i = 0; i < 3; ++i) {
                CHECK(same_bits(alone.position[i], together.position[i][lane]));
                CHECK(same_bits(alone.velocity[i], together.velocity[i][lane]));
                CHECK(same_bits(alone.acceleration[i], together.acceleration[i][lane]));
            }
        }
    }
}

TEST_SUITE_END()

}  // namespace arm3r
