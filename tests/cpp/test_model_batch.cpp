#include <vector>

#include "arm3r/model/arm_points.hpp"
#include "arm3r/model/recursion.hpp"
#include "batch/model_batch.hpp"
#include "check.hpp"
#include "fixtures.hpp"

using namespace arm3r;

namespace {

using Numbers = std::vector<double>;

// One state as the formulas in double see it, in slide.
struct State1 {
    const Arm<double>& arm;
    Vec3<double> q, qd, third, force;
    Pose<double> p = pose(q);
};

Numbers numbers(const Vec3<double>& v) { return {v[0], v[1], v[2]}; }
Numbers numbers(const Mat3<double>& m) { return {m.data(), m.data() + 9}; }

Numbers joined(Numbers a, const Numbers& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

// A row of results in the slide convention, and the same row in simscape.
enum class Kind { space, joints, columns_in_joints, joints_twice };

struct Case {
    const char* name;
    GroupFunction& function;
    std::vector<std::size_t> widths;
    Kind kind;
    Numbers (*formula)(const State1&);
};

const Case cases[] = {
    {"tip_position",
     in_groups::tip_position,
     {3},
     Kind::space,
     [](const State1& s) { return numbers(tip_position(s.arm, s.p)); }},
    {"elbow_position",
     in_groups::elbow_position,
     {3},
     Kind::space,
     [](const State1& s) { return numbers(elbow_position(s.arm, s.p)); }},
    {"points",
     in_groups::arm_points,
     {21},
     Kind::space,
     [](const State1& s) {
         Numbers all;
         for (const Vec3<double>& point : arm_points(s.arm, s.p)) all = joined(all, numbers(point));
         return all;
     }},
    {"centres",
     in_groups::centres_of_mass,
     {9},
     Kind::space,
     [](const State1& s) { return numbers(centres_of_mass(s.arm, s.p)); }},
    {"jacobian",
     in_groups::jacobian,
     {9},
     Kind::columns_in_joints,
     [](const State1& s) { return numbers(jacobian(s.arm, s.p)); }},
    {"geometric_jacobian",
     in_groups::geometric_jacobian,
     {18},
     Kind::columns_in_joints,
     [](const State1& s) { return joined(numbers(jacobian(s.arm, s.p)), numbers(angular_jacobian(s.arm, s.p))); }},
    {"jacobian_dot",
     in_groups::jacobian_dot,
     {9},
     Kind::columns_in_joints,
     [](const State1& s) { return numbers(jacobian_dot(s.arm, s.p, s.qd)); }},
    {"mass_matrix",
     in_groups::mass_matrix,
     {9},
     Kind::joints_twice,
     [](const State1& s) { return numbers(mass_matrix(s.arm, s.p)); }},
    {"coriolis_matrix",
     in_groups::coriolis_matrix,
     {9},
     Kind::joints_twice,
     [](const State1& s) { return numbers(coriolis_matrix(s.arm, s.p, s.qd)); }},
    {"velocity_product",
     in_groups::velocity_product,
     {3},
     Kind::joints,
     [](const State1& s) { return numbers(velocity_product(s.arm, s.p, s.qd)); }},
    {"gravity_torque",
     in_groups::gravity_torque,
     {3},
     Kind::joints,
     [](const State1& s) { return numbers(gravity_torque(s.arm, s.p)); }},
    {"operational_space_inertia",
     in_groups::operational_space_inertia,
     {9},
     Kind::space,
     [](const State1& s) { return numbers(operational_space_inertia(s.arm, s.p)); }},
    {"manipulability",
     in_groups::manipulability,
     {1},
     Kind::space,
     [](const State1& s) { return Numbers{manipulability(s.arm, s.p)}; }},
    {"energy",
     in_groups::energy,
     {1, 1},
     Kind::space,
     [](const State1& s) { return Numbers{kinetic_energy(s.arm, s.p, s.qd), potential_energy(s.arm, s.p)}; }},
    {"forward_dynamics",
     in_groups::forward_dynamics,
     {3},
     Kind::joints,
     [](const State1& s) { return numbers(forward_dynamics(s.arm, s.p, s.qd, s.third, s.force)); }},
    {"inverse_dynamics",
     in_groups::inverse_dynamics,
     {3},
     Kind::joints,
     [](const State1& s) { return numbers(inverse_dynamics(s.arm, s.p, s.qd, s.third, s.force)); }},
    {"tip_sensor",
     in_groups::tip_sensor,
     {3, 3},
     Kind::space,
     [](const State1& s) {
         const TipSensor<double> sensor = tip_sensor(s.arm, s.q, s.qd);
         return joined(numbers(sensor.position), numbers(sensor.velocity));
     }},
    {"singularity",
     in_groups::singularity,
     {1, 1},
     Kind::space,
     [](const State1& s) { return Numbers{std::abs(sine_of_bend(s.arm, s.p)), std::abs(radius(s.arm, s.p))}; }},
};

// A result in slide as the rows tell it.
void turn(Numbers& result, Kind kind) {
    for (std::size_t i = 0; i < result.size(); ++i) {
        const bool column = i % 3 != 0, row = i / 3 % 3 != 0;
        const bool flips = kind != Kind::space && (kind == Kind::joints_twice ? column != row : column);
        if (flips) result[i] = -result[i];
    }
}

// Rows of three, with zeros of either sign among them.
Numbers random_rows(Random& random, std::size_t n, double limit) {
    Numbers rows(3 * n);
    for (double& x : rows) {
        const double choice = random.in(0, 1);
        x = choice < 0.1 ? 0.0 : choice < 0.2 ? -0.0 : random.in(-limit, limit);
    }
    return rows;
}

JointConvention convention(bool is_simscape) {
    return is_simscape ? JointConvention{.sign = {1, -1, -1}} : JointConvention{};
}

Vec3<double> row(const Numbers& rows, std::size_t i, bool flip) {
    return convention(flip).flipped(Vec3<double>(rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]));
}

constexpr double untouched = 12345;

// Every number of every case on n states against the formula in double, and that nothing is written beyond.
void compare(const Model& model, std::size_t n, Random& random, bool with_force) {
    const bool is_simscape = model.convention.sign[1] < 0;
    const Numbers q = random_rows(random, n, 10), qd = random_rows(random, n, 5), third = random_rows(random, n, 20);
    const Numbers force = with_force ? random_rows(random, n, 50) : Numbers(3 * n);
    for (const Case& c : cases) {
        std::array<Numbers, 2> out;
        StateRows rows{{q.data(), qd.data(), third.data(), with_force ? force.data() : nullptr}, {}};
        for (std::size_t k = 0; k < c.widths.size(); ++k) {
            out[k].assign(n * c.widths[k] + 1, untouched);
            rows.out[k] = {out[k].data(), c.widths[k]};
        }
        evaluate(c.function, model, n, rows);
        for (std::size_t i = 0; i < n; ++i) {
            const State1 state{model.arm, row(q, i, is_simscape), row(qd, i, is_simscape), row(third, i, is_simscape),
                               row(force, i, false)};
            Numbers expected = c.formula(state);
            if (is_simscape) turn(expected, c.kind);
            std::size_t at = 0;
            for (std::size_t k = 0; k < c.widths.size(); ++k)
                for (std::size_t j = 0; j < c.widths[k]; ++j, ++at)
                    CHECK(same_bits(out[k][i * c.widths[k] + j], expected[at] + 0.0),
                          c.name << " of state " << i << " of " << n << ", number " << at);
            CHECK(at == expected.size());
        }
        for (std::size_t k = 0; k < c.widths.size(); ++k) CHECK(out[k].back() == untouched);
    }
}

}  // namespace

TEST_SUITE(model_batch)

TEST_CASE(every_state_gets_the_bits_of_the_formula_in_double) {
    Random random(11);
    for (std::size_t n = 0; n <= 25; ++n)
        for (const bool simscape : {false, true}) {
            compare({random_params(random).arm(), convention(simscape)}, n, random, n % 3 != 0);
            compare({random_elbow_params(random).arm(), convention(simscape)}, n, random, n % 3 != 0);
        }
}

TEST_CASE(an_arm_without_extras_gets_them_too) {
    Random random(12);
    for (const bool simscape : {false, true}) {
        const Model model{Params().arm(), convention(simscape)};
        CHECK(model.arm.gravity_is_vertical);
        compare(model, 1000, random, simscape);
    }
}

TEST_CASE(effective_mass_is_that_of_the_unit_direction) {
    Random random(13);
    const std::size_t n = 203;
    const Model model{random_params(random).arm(), convention(true)};
    const Numbers q = random_rows(random, n, 3);
    Numbers direction = random_rows(random, n, 4), mass(n);
    std::fill_n(direction.begin() + 60, 3, -0.0);
    evaluate(in_groups::effective_mass, model, n, {{q.data(), direction.data()}, {{{mass.data(), 1}}}});
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3<double> d = row(direction, i, false);
        const double length = std::sqrt(dot(d, d));
        const Vec3<double> unit(d[0] / length, d[1] / length, d[2] / length);
        const double expected = length > 0 ? effective_mass(model.arm, pose(row(q, i, true)), unit) : 0;
        CHECK(same_bits(mass[i], expected), "state " << i);
    }
    CHECK(mass[20] == 0);
}

TEST_CASE(one_bad_number_is_found_wherever_it_stands) {
    for (const std::size_t count : {1, 7, 8, 9, 24, 51}) {
        Numbers data(count, -1e5);
        CHECK(all_within(data.data(), count, 1e5));
        for (double& x : data)
            for (const double bad : {100000.00000000001455, -HUGE_VAL, HUGE_VAL, double(NAN)}) {
                x = bad;
                CHECK(!all_within(data.data(), count, 1e5));
                x = -0.0;
            }
    }
    CHECK(all_within(nullptr, 0, 1e5));
}

TEST_SUITE_END()
