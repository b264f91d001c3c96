
#include "arm3r/plant.hpp"
#include "check.hpp"
#include "fixtures.hpp"

namespace arm3r {

// The instants at which contact begins and ends, and the energy balance there.
TEST_SUITE(contact)

static Vec3<double> start_of(const Params& params) {
    const Setup setup = make_setup(params);
    return tip_position(setup.plant.arm, pose(setup.q));
}

// An arm held by gravity compensation before an infinite wall, `gap` away, whose normal is in no special direction.
static Params held(double gap, const Vec3<double>& normal = {-0.8, -0.5, 0.3}) {
    Params params =
        unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1).set("wall.normal", normal);
    return params.set("wall.point", Vec3<double>(start_of(params) - gap * normal.normalized()));
}

struct Sinusoid {
    double amplitude = 0.04, frequency = 1.3, phase = -0.5;

    Params before(double gap) const {
        Params params = held(gap).choose("wall.motion.type", "sinusoid").set("wall.motion.amplitude", amplitude);
        return params.set("wall.motion.frequency", frequency).set("wall.motion.phase", phase).set("time.stop", 3);
    }
    double deepest(double gap) const { return amplitude * (1 - std::sin(phase)) - gap; }
    // Half the time in contact, of each period; and the first time of greatest depth.
    double half_stay(double gap) const { return std::acos(1 - deepest(gap) / amplitude) / (2 * M_PI * frequency); }
    double first_peak() const { return (M_PI / 2 - phase) / (2 * M_PI * frequency); }
};

static void check_events(const Run& run, const Sinusoid& wall, double gap, double tolerance) {
    REQUIRE(run.events.size() == 8u);
    for (std::size_t i = 0; i < run.events.size(); ++i) {
        const bool make = i % 2 == 0;
        const double t = wall.first_peak() + double(i / 2) / wall.frequency + (make ? -1 : 1) * wall.half_stay(gap);
        CHECK((run.events[i].type == Event::make) == make);
        CHECK(std::abs(run.events[i].t - t) <= tolerance, run.events[i].t << " is not " << t);
    }
}

TEST_CASE(a_wall_that_comes_at_constant_speed_arrives_when_it_must) {
    const Run run = held(0.123).set("wall.motion.velocity", 0.05).set("time.stop", 4).run();
    REQUIRE(run.events.size() == 1u);
    CHECK(std::abs(run.events[0].t - 0.123 / 0.05) <= 1e-12);
    CHECK(std::abs(run.peak_force - 1000 * (0.05 * 4 - 0.123)) <= 1e-9);
    CHECK(last(run, "contact") == 1);
}

TEST_CASE(a_swinging_wall_makes_and_breaks_at_the_roots_of_its_sine) {
    const Sinusoid wall;
    const Run run = wall.before(0.05).run();
    check_events(run, wall, 0.05, 1e-12);
    CHECK(std::abs(run.peak_force - 1000 * wall.deepest(0.05)) <= 1e-9);
}

TEST_CASE(fixed_steps_find_the_same_instants_to_their_order) {
    const Sinusoid wall;
    check_events(wall.before(0.05).choose("solver.method", "rk4").run(), wall, 0.05, 1e-9);
}

TEST_CASE(a_touch_of_ten_nanometres_is_found_and_a_miss_of_ten_is_none) {
    const Sinusoid wall;
    const double just_touching = wall.deepest(0);
    check_events(wall.before(just_touching - 1e-8).run(), wall, just_touching - 1e-8, 1e-9);
    CHECK(wall.before(just_touching + 1e-8).run().events.empty());
}

// How far a falling arm swings towards -normal at the most, from a parabola through the three highest rows.
static double farthest_swing(const Run& run, const Vec3<double>& n) {
    const auto x = column(run, "tip_x"), y = column(run, "tip_y"), z = column(run, "tip_z");
    const auto towards = [&](std::size_t i) { return -(n[0] * x[i] + n[1] * y[i] + n[2] * z[i]); };
    std::size_t top = 1;
    for (std::size_t i = 1; i + 1 < run.rows; ++i)
        if (towards(i) > towards(top)) top = i;
    REQUIRE(towards(top) > towards(0));
    REQUIRE(towards(top) > towards(run.rows - 1));
    const double before = towards(top - 1), at = towards(top), after = towards(top + 1);
    return at + (after - before) * (after - before) / (8 * (2 * at - before - after));
}

TEST_CASE(a_falling_arm_that_grazes_a_wall_by_ten_nanometres_is_found) {
    const Vec3<double> n = Vec3<double>(-0.3, 0.2, 0.9).normalized();
    Params params = unequal_params()
                        .set("initial.qd", {0.5, -0.4, 0.3})
                        .set("arm.link1.inertia_axial", 0.3)
                        .set("time.stop", 1)
                        .set("time.log_every", 1e-4);
    const double farthest = farthest_swing(params.run(), n);
    params.set("wall", 1).set("wall.normal", n).choose("wall.motion.type", "fixed");
    const auto events_at = [&](double distance) {
        return params.set("wall.point", Vec3<double>(-distance * n)).run().events;
    };
    CHECK(events_at(farthest + 1e-8).empty());
    const std::vector<Event> grazed = events_at(farthest - 1e-8);
    REQUIRE(grazed.size() == 2u);
    CHECK(grazed[0].type == Event::make);
    CHECK(grazed[1].type == Event::brk);
    CHECK(grazed[1].t - grazed[0].t > 1e-6);
    CHECK(grazed[1].t - grazed[0].t < 1e-3);
}

TEST_CASE(an_event_holds_the_state_at_its_instant) {
    Params params =
        unequal_params().set("initial.qd", {0.5, -0.4, 0.3}).set("arm.link1.inertia_axial", 0.3).set("time.stop", 0.5);
    params.set("wall", 1)
        .set("wall.normal", {0, 0, 1})
        .set("wall.point", {0, 0, 0.2})
        .choose("wall.motion.type", "fixed");
    const Run run = params.run();
    REQUIRE(!run.events.empty());
    const Event& event = run.events[0];
    const Run until = params.set("time.stop", event.t).set("wall", 0).run();
    for (int i = 0; i < 3; ++i) {
        CHECK(std::abs(event.q[i] - last(until, "q" + std::to_string(i + 1))) <= 1e-9);
        CHECK(std::abs(event.qd[i] - last(until, "qd" + std::to_string(i + 1))) <= 1e-7);
    }
    CHECK(std::abs(event.tip[2] - 0.2) <= 1e-12);
}

// ---- the start

TEST_CASE(a_start_inside_is_a_make_at_zero) {
    const Run run = held(-0.002).choose("wall.motion.type", "fixed").set("time.stop", 1).run();
    REQUIRE(run.events.size() == 1u);
    CHECK(run.events[0].type == Event::make);
    CHECK(run.events[0].t == 0);
    CHECK(column(run, "contact")[0] == 1);
    CHECK(std::abs(run.peak_force - 2) <= 1e-9);
}

TEST_CASE(touching_exactly_is_not_contact) {
    const Run still = held(0, {-1, 0, 0}).choose("wall.motion.type", "fixed").set("time.stop", 0).run();
    CHECK(last(still, "depth") == 0);
    CHECK(last(still, "contact") == 0);
    CHECK(still.events.empty());
    const Run coming = held(0, {-1, 0, 0}).set("time.stop", 1).run();
    REQUIRE(coming.events.size() == 1u);
    CHECK(coming.events[0].t <= 1e-12);
}

TEST_CASE(a_wall_that_recedes_was_deepest_at_the_start) {
    for (const char* method : {"dopri5", "rk4"}) {
        Params params = held(-0.05).choose("solver.method", method).set("wall.motion.velocity", -0.05);
        const Run run = params.set("time.stop", 2).run();
        CHECK(std::abs(run.peak_force - 50) <= 1e-9);
        REQUIRE(run.events.size() == 2u);
        CHECK(run.events[0].t == 0);
        CHECK(std::abs(run.events[1].t - 1) <= 1e-9);
        CHECK(run.events[1].type == Event::brk);
        CHECK(std::abs(params.set("time.stop", 0).run().peak_force - 50) <= 1e-9);
    }
}

TEST_CASE(from_an_exact_touch_a_wall_may_recede_and_come_back) {
    CHECK(held(0, {-1, 0, 0}).set("wall.motion.velocity", -0.05).set("time.stop", 1).run().events.empty());
    for (const char* method : {"dopri5", "rk4"}) {
        Params params = held(0, {-1, 0, 0}).choose("solver.method", method).choose("wall.motion.type", "sinusoid");
        params.set("wall.motion.amplitude", 0.02).set("wall.motion.frequency", 1).set("wall.motion.phase", M_PI);
        const Run run = params.set("time.stop", 2.25).run();
        REQUIRE(run.events.size() == 4u);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK((run.events[i].type == Event::make) == (i % 2 == 0));
            CHECK(std::abs(run.events[i].t - 0.5 * double(i + 1)) <= 1e-9);
        }
    }
}

// ---- spins, which have no error at any step

static Params spinning(const Vec3<double>& qd) {
    return Params().set("arm.gravity", {0, 0, 0}).set("initial.q", {1, 0, 0}).set("initial.qd", qd);
}

TEST_CASE(a_spinning_arm_meets_the_wall_every_turn) {
    Params params = spinning({3, 0, 0}).set("wall", 1).set("wall.size", {HUGE_VAL, HUGE_VAL}).set("time.log_every", 1);
    params.set("wall.point", {2.5, 0, 0}).set("wall.motion.velocity", 1e-3).set("time.stop", 600);
    const Run run = params.run();
    CHECK(run.events.size() == 96u);
    CHECK(double(run.steps.accepted) >= 600 * 3 / (M_PI / 4));
}

TEST_CASE(an_arm_that_spins_up_meets_the_wall_every_turn) {
    Params params = spinning({0, 0, 0}).choose("controller.type", "constant").set("controller.torque", {1, 0, 0});
    params.set("wall", 1).set("wall.size", {HUGE_VAL, HUGE_VAL}).set("wall.point", {1.9, 0, 0});
    const Run run = params.choose("wall.motion.type", "fixed").set("time.stop", 20).run();
    CHECK(run.events.size() == 30u);
    CHECK(double(run.steps.accepted) >= (last(run, "q1") - 1) / (M_PI / 4));
}

// How far a step may turn a link: 45 degrees, or less where the tolerance is fine (5.2).
static double max_turn(double rtol) { return std::min(M_PI / 4, std::pow(1e5 * rtol, 0.2)); }

// The ends of the steps, from runs that may take one more step each. Rate and acceleration may each turn the angle as
// far.
TEST_CASE(an_arm_that_starts_to_spin_is_held_to_its_turn_from_the_first_steps_on) {
    for (const double torque : {1.0, 2.0, 3.0, 5.0, 7.0}) {
        for (const double rtol : {1e-9, 1e-3}) {
            Params params = spinning({0, 0, 0}).choose("controller.type", "constant").set("solver.rtol", rtol);
            params.set("controller.torque", {torque, 0, 0}).set("time.stop", 100);
            const double acceleration = torque / mass_matrix(params.arm(), pose(Vec3<double>(1, 0, 0)))(0, 0);
            double turned = 0;
            for (int steps = 1; steps <= 20; ++steps) {
                const double t = params.set("solver.max_steps", steps).run().t_end, angle = 0.5 * acceleration * t * t;
                CHECK(angle - turned <= 2 * max_turn(rtol) + 1e-9);
                turned = angle;
            }
            CHECK(turned > 2);
        }
    }
}

// Link 3 balanced at the elbow: each link turns on its own, at a steady rate.
TEST_CASE(no_step_turns_a_link_too_far_and_none_is_needlessly_short) {
    for (const Vec3<double>& qd :
         {Vec3<double>(3, 0, 0), Vec3<double>(0, 3, -3), Vec3<double>(0, 0, 3), Vec3<double>(0, 1.5, 1.5)}) {
        for (const double rtol : {1e-9, 1e-3}) {
            Params params = spinning(qd).set("arm.link3.com", 0).set("solver.rtol", rtol);
            const Run run = params.set("time.stop", 100).set("time.log_every", 10).run();
            const double fewest = 100 * 3 / max_turn(rtol);
            CHECK(double(run.steps.accepted) >= fewest, "at " << qd.transpose());
            CHECK(double(run.steps.accepted) <= 1.1 * fewest, "at " << qd.transpose());
        }
    }
}

// ---- the rim of the plate

// The plate of 1 m slides away sideways, along e1, from under a tip that is 2 mm deep.
TEST_CASE(leaving_over_the_edge_is_a_break) {
    for (const char* method : {"dopri5", "rk4"}) {
        Params params = held(-0.002, {-1, 0, 0})
                            .set("wall.size", {1, 1})
                            .set("wall.contact.stiffness", 1e4)
                            .choose("solver.method", method);
        const Run run = params.set("wall.motion.velocity", {0, 0.1, 0}).set("time.stop", 8).run();
        REQUIRE(run.events.size() == 2u);
        CHECK(run.events[1].type == Event::brk);
        CHECK(std::abs(run.events[1].t - 5) <= 1e-9);
        const auto t = column(run, "t"), f = column(run, "f_on_wall_x"), depth = column(run, "depth"),
                   flag = column(run, "contact");
        for (std::size_t i = 0; i < run.rows; ++i) {
            if (std::abs(t[i] - 5) < 1e-9) continue;
            CHECK(std::abs(f[i] - (t[i] < 5 ? 20.0 : 0.0)) <= 1e-9);
            CHECK(flag[i] == (t[i] < 5 ? 1.0 : 0.0));
            CHECK(std::abs(depth[i] - 0.002) <= 1e-12);
        }
    }
}

// A plate of 0.3 m by 0.9 m, its centre off the tip, slides away in eight directions.
TEST_CASE(a_plate_is_left_over_the_edge_that_comes_first) {
    const double half[] = {0.15, 0.45}, across[] = {0.05, -0.3}, speed = 0.2;
    const auto leaving = [&](int axis, int way) {  // the tip moves the other way over the plate
        return way == 0 ? HUGE_VAL : (half[axis] + way * across[axis]) / speed;
    };
    for (const char* method : {"dopri5", "rk4"}) {
        for (int direction = 0; direction < 9; ++direction) {
            const int along1 = direction % 3 - 1, along2 = direction / 3 - 1;
            if (along1 == 0 && along2 == 0) continue;
            Params params = held(-0.002, {-1, 0, 0}).set("wall.size", {0.3, 0.9}).choose("solver.method", method);
            params.set("wall.point", Vec3<double>(start_of(params) + Vec3<double>(-0.002, -across[0], -across[1])));
            const Run run =
                params.set("wall.motion.velocity", {0, along1 * speed, along2 * speed}).set("time.stop", 5).run();
            REQUIRE(run.events.size() == 2u);
            CHECK(run.events[0].t == 0);
            CHECK(run.events[1].type == Event::brk);
            CHECK(std::abs(run.events[1].t - std::min(leaving(0, along1), leaving(1, along2))) <= 1e-9,
                  method << " " << along1 << " " << along2 << ": " << run.events[1].t);
        }
    }
}

TEST_CASE(near_a_corner_the_earlier_edge_counts) {
    const double speed = 0.2, one = 1.0002, other = 1.0006;  // within one fixed step
    for (const char* method : {"dopri5", "rk4"}) {
        for (const auto& [t1, t2] : {std::pair(one, other), std::pair(other, one)}) {
            Params params = held(-0.002, {-1, 0, 0}).set("wall.size", {1, 1}).choose("solver.method", method);
            const Vec3<double> off(-0.002, 0.5 - speed * t1, 0.5 - speed * t2);
            params.set("wall.point", Vec3<double>(start_of(params) + off)).set("time.stop", 2);
            const Run run = params.set("wall.motion.velocity", {0, speed, speed}).run();
            REQUIRE(run.events.size() == 2u);
            CHECK(std::abs(run.events[1].t - one) <= 1e-9, method << ": " << run.events[1].t);
        }
    }
}

// The tip turns above a floor, 1 cm deep, and comes out over each of its four edges by a micrometre: between two looks.
TEST_CASE(an_edge_crossed_for_an_instant_is_found) {
    const double radius = 1.4, half = radius - 1e-6, speed = 2, before = 0.5;
    for (int edge = 0; edge < 4; ++edge) {
        Params params = unequal_params().set("arm.gravity", {0, 0, 0}).set("initial.qd", {speed, 0, 0});
        params.set("initial.q", {edge * M_PI / 2 - before, 0, 0}).set("wall", 1).set("wall.normal", {0, 0, 1});
        params.set("wall.point", {0, 0, 0.31}).set("wall.size", {2 * half, 2 * half});
        const Run run = params.choose("wall.motion.type", "fixed").set("time.stop", 0.6).run();
        REQUIRE(run.events.size() == 2u);
        CHECK(std::abs(run.events[1].t - (before - std::acos(half / radius)) / speed) <= 1e-9,
              "edge " << edge << ": " << run.events[1].t);
    }
}

// The plate passes the tip's depth beside it, at `t_depth`, and then slides over it, at `t_over`.
static Run passed_beside(const char* method, double acts_on_arm, double t_depth, double t_over) {
    Params params = held(0, {-1, 0, 0}).set("wall.size", {0.3, 0.9}).set("wall.acts_on_arm", acts_on_arm);
    params.set("wall.point", Vec3<double>(start_of(params) + Vec3<double>(0.05 * t_depth, 0.15 + 0.1 * t_over, 0)));
    params.set("wall.motion.velocity", {-0.05, -0.1, 0}).choose("solver.method", method).set("solver.step", 0.01);
    return params.set("time.stop", 2).run();
}

TEST_CASE(a_plate_that_gets_behind_the_tip_beside_it_pushes_nothing) {
    for (const char* method : {"dopri5", "rk4"}) {
        for (const double acts_on_arm : {0.0, 1.0}) {
            for (const double t_over : {1.5, 1.012}) {  // the second: in the very next of the fixed steps
                const Run run = passed_beside(method, acts_on_arm, 1.003, t_over);
                CHECK(last(run, "depth") > 0.04);
                CHECK(run.events.empty());
                CHECK(run.peak_force == 0);
                CHECK(last(run, "work_wall") == 0);
                for (const double force : column(run, "f_on_tip_x")) CHECK(force == 0);
            }
        }
    }
}

TEST_CASE(a_plate_that_comes_in_from_the_side_pushes_nothing) {
    for (const double up : {0.0, 1.0}) {
        Params params = held(-0.002, {-1, 0, 0}).set("wall.size", {1, 1});
        const Vec3<double> sideways(0, 1 - up, up),
            point = start_of(params) - Vec3<double>(0.002, 0, 0) - 0.8 * sideways;
        const Run run = params.set("wall.point", point)
                            .set("wall.motion.velocity", Vec3<double>(0.1 * sideways))
                            .set("time.stop", 10)
                            .run();
        CHECK(run.events.empty());
        CHECK(run.peak_force == 0);
    }
}

// A spinning arm carries its tip in over the rim of a plate that swings to and fro: no force before it has once been in
// front. The rows are compared with a table of modes of their own.
TEST_CASE(beside_the_plate_nothing_pushes_until_the_tip_has_been_in_front) {
    Params params = held(-0.02, {-1, 0, 0})
                        .set("initial.qd", {0.1, 0, 0})
                        .set("wall.size", {1, 1})
                        .set("arm.link1.inertia_axial", 0.5);
    params.set("wall.point", Vec3<double>(start_of(params) + Vec3<double>(-0.02, 0.505, 0)))
        .choose("wall.motion.type", "sinusoid");
    params.set("wall.motion.amplitude", 0.05).set("wall.motion.frequency", 2).set("wall.motion.phase", -0.5);
    const Run run = params.set("time.stop", 1).set("time.log_every", 1e-3).run();
    const auto depth = column(run, "depth"), y = column(run, "tip_y"), plate = column(run, "wall_y"),
               flag = column(run, "contact");
    bool free = false, touching = false, within_but_unfelt = false;
    for (std::size_t i = 0; i < run.rows; ++i) {
        const bool within = std::abs(y[i] - plate[i]) < 0.5;
        touching = depth[i] > 0 && within && (touching || free);
        free = depth[i] <= 0;
        within_but_unfelt |= within && depth[i] > 0 && !touching;
        CHECK(flag[i] == double(touching));
    }
    CHECK(within_but_unfelt);
    CHECK(touching + run.events.size() >= 2u);
    CHECK(run.events.at(0).type == Event::make);
}

// ---- both ways

static Params bouncing() {
    return held(0.01)
        .set("wall.acts_on_arm", 1)
        .set("wall.contact.stiffness", 1e4)
        .set("wall.motion.velocity", 0.3)
        .set("time.stop", 0.3);
}

TEST_CASE(a_bounce_leaves_at_twice_the_walls_speed_and_the_energy_balance_closes) {
    const Run run = bouncing().set("wall.contact.stiffness", 1e6).set("time.stop", 0.05).run();
    CHECK(run.outcome == ARM3R_RUN_OK, run.message);
    REQUIRE(run.events.size() == 2u);
    const Setup setup = make_setup(bouncing());
    const Vec3<double> n = setup.plant.wall.n;
    const double m_n = effective_mass(setup.plant.arm, pose(setup.q), n);
    const Event& left = run.events[1];
    const Vec3<double> q(left.q.data()), qd(left.qd.data());
    CHECK(std::abs(dot(n, tip_velocity(setup.plant.arm, pose(q), qd)) - 0.6) <= 2e-3);
    CHECK(std::abs(left.t - run.events[0].t - M_PI * std::sqrt(m_n / 1e6)) <= 2e-5);
    CHECK(std::abs(last(run, "work_wall") - 2 * m_n * 0.09) <= 1e-3);
    CHECK(run.energy_residual_max <= 1e-9);
}

TEST_CASE(the_energy_balance_closes_over_many_contacts_with_everything_at_work) {
    Params params = held(0.02)
                        .set("wall.acts_on_arm", 1)
                        .set("arm.damping", {0.3, 0.2, 0.1})
                        .set("arm.friction", {0.05, 0.04, 0.03});
    params.set("arm.friction_velocity", 0.05)
        .set("controller.gravity", 8)
        .set("arm.payload.mass", 0.2)
        .set("arm.armature", {0.02, 0.01, 0.03});
    params.choose("wall.motion.type", "sinusoid")
        .set("wall.motion.amplitude", 0.15)
        .set("wall.motion.frequency", 1.5)
        .set("wall.contact.stiffness", 3000);
    const Run run = params.set("time.stop", 3).run();
    CHECK(run.outcome == ARM3R_RUN_OK, run.message);
    CHECK(run.events.size() >= 4u);
    CHECK(last(run, "energy_dissipated") > 0.1);
    CHECK(std::abs(last(run, "work_wall")) > 0.1);
    CHECK(std::abs(last(run, "work_actuators")) > 0.1);
    CHECK(run.energy_residual_max <= 1e-8);
}

TEST_CASE(what_the_spring_holds_at_the_edge_counts_as_lost) {
    Params params =
        held(-0.001, {-1, 0, 0}).set("wall.acts_on_arm", 1).set("wall.contact.stiffness", 1e4).set("wall.size", {1, 1});
    params.set("wall.point", Vec3<double>(start_of(params) + Vec3<double>(-0.001, 0.4, 0)))
        .set("wall.motion.velocity", {0, 20, 0});
    const Run run = params.set("time.stop", 0.02).set("time.log_every", 1e-4).run();
    CHECK(run.outcome == ARM3R_RUN_OK, run.message);
    REQUIRE(run.events.size() == 2u);
    const Event& left = run.events[1];
    const double depth = left.tip[0] - (start_of(params)[0] - 0.001);
    CHECK(std::abs(left.t - 0.005) <= 1e-4);
    CHECK(depth > 1e-4);
    CHECK(std::abs(last(run, "energy_dissipated") - 0.5 * 1e4 * depth * depth) <= 1e-12);
    CHECK(last(run, "energy_contact") == 0);
    CHECK(run.energy_residual_max <= 1e-10);
}

TEST_CASE(letting_go_over_the_face_loses_nothing) {
    for (const char* method : {"dopri5", "rk4"}) {
        const Run run = bouncing().choose("solver.method", method).run();
        CHECK(run.events.size() == 2u);
        for (const double lost : column(run, "energy_dissipated")) CHECK(lost == 0);
    }
}

TEST_CASE(rows_after_an_edge_within_a_fixed_step_show_the_loss) {
    Params params = held(-0.05, {-1, 0, 0}).set("wall.acts_on_arm", 1).set("wall.contact.stiffness", 100);
    params.set("wall.size", {0.02, 0.5}).set("wall.motion.velocity", {0, 0.3, 0}).set("time.stop", 0.1);
    params.choose("solver.method", "rk4").set("solver.step", 0.004);
    for (const double log_every : {5e-4, 0.004, 1.0}) {
        const Run run = params.set("time.log_every", log_every).run();
        REQUIRE(run.events.size() == 2u);
        const double lost = last(run, "energy_dissipated");
        CHECK(lost > 0.05);
        for (const double residual : column(run, "energy_residual")) CHECK(std::abs(residual) <= 0.02 * lost);
        CHECK(run.energy_residual_max <= 0.02 * lost);
    }
}

// The arm rests its weight on a hard floor, with tolerances that would allow anything: only the floor's own time holds
// the steps short.
TEST_CASE(steps_in_contact_follow_the_stiffness_of_the_wall) {
    const double stiffness = 1e6, stop = 0.05;
    const Vec3<double> up(0, 0, 1), none(0, 0, 0);
    const Setup setup = make_setup(held(0));
    const Arm<double>& arm = setup.plant.arm;
    const Pose<double> p = pose(setup.q);
    const double m_n = effective_mass(arm, p, up);
    const double weight = -m_n * (jacobian(arm, p) * forward_dynamics(arm, p, none, none, none))[2];
    Params params = held(-weight / stiffness, up).choose("controller.type", "none").set("wall.acts_on_arm", 1);
    params.choose("wall.motion.type", "fixed").set("wall.contact.stiffness", stiffness).set("time.stop", stop);
    const Run run = params.set("solver.rtol", 1e-3).set("solver.atol", 1e-2).run();
    CHECK(run.events.size() == 1u);
    CHECK(double(run.steps.accepted) >= 0.95 * stop / (0.25 * M_PI * std::sqrt(m_n / stiffness)));
}

TEST_CASE(one_way_contact_leaves_the_arm_and_its_energy_balance_alone) {
    const Run with = bouncing().set("wall.acts_on_arm", 0).run(), without = bouncing().set("wall", 0).run();
    CHECK(last(with, "f_on_wall_x") > 1);
    for (const char* name : {"q1", "q2", "q3", "qd1", "qd2", "qd3", "work_actuators", "energy_residual"})
        CHECK(same_bits(last(with, name), last(without, name)), name);
    for (const char* name : {"energy_contact", "work_wall", "energy_dissipated"}) CHECK(last(with, name) == 0);
}

TEST_CASE(fixed_steps_meet_the_same_bounce) {
    const Run adaptive = bouncing().run(),
              fixed = bouncing().choose("solver.method", "rk4").set("solver.step", 1e-4).run();
    REQUIRE(fixed.events.size() == adaptive.events.size());
    for (std::size_t i = 0; i < fixed.events.size(); ++i)
        CHECK(std::abs(fixed.events[i].t - adaptive.events[i].t) <= 1e-6);
    CHECK(std::abs(fixed.peak_force / adaptive.peak_force - 1) <= 1e-5);
    for (const char* name : {"qd1", "qd2", "qd3"}) CHECK(std::abs(last(fixed, name) - last(adaptive, name)) <= 1e-4);
}

TEST_CASE(both_forces_sum_to_zero_at_every_row) {
    const Run run = bouncing().run();
    for (const char* axis : {"x", "y", "z"}) {
        const auto on_tip = column(run, std::string("f_on_tip_") + axis),
                   on_wall = column(run, std::string("f_on_wall_") + axis);
        for (std::size_t i = 0; i < run.rows; ++i) CHECK(on_tip[i] + on_wall[i] == 0);
    }
}

TEST_SUITE_END()

}  // namespace arm3r
