#include "batch/model_batch.hpp"

#include <algorithm>
#include <bit>

#include "arm3r/lanes.hpp"
#include "arm3r/model/arm_points.hpp"
#include "arm3r/model/dynamics.hpp"
#include "arm3r/model/recursion.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/widths.hpp"

namespace arm3r {
namespace {

constexpr std::size_t group = 8;
constexpr std::size_t max_row_width = 3 * arm_point_count;
using Eight = Pack<group>;

// Eight rows of three numbers, turned into three columns of eight.
ARM3R_INLINE Vec3<Eight> load_columns(const double* rows) {
    const Eight a = Eight::load(rows), b = Eight::load(rows + group), c = Eight::load(rows + 2 * group);
    const Eight::Vector x = __builtin_shufflevector(a.v, b.v, 0, 3, 6, 9, 12, 15, -1, -1);
    const Eight::Vector y = __builtin_shufflevector(a.v, b.v, 1, 4, 7, 10, 13, -1, -1, -1);
    const Eight::Vector z = __builtin_shufflevector(a.v, b.v, 2, 5, 8, 11, 14, -1, -1, -1);
    return {Eight(__builtin_shufflevector(x, c.v, 0, 1, 2, 3, 4, 5, 10, 13)),
            Eight(__builtin_shufflevector(y, c.v, 0, 1, 2, 3, 4, 8, 11, 14)),
            Eight(__builtin_shufflevector(z, c.v, 0, 1, 2, 3, 4, 9, 12, 15))};
}

ARM3R_INLINE void store_columns(const Vec3<Eight>& columns, double* rows) {
    const Eight::Vector &x = columns[0].v, &y = columns[1].v, &z = columns[2].v;
    const Eight::Vector a = __builtin_shufflevector(x, y, 0, 8, -1, 1, 9, -1, 2, 10);
    const Eight::Vector b = __builtin_shufflevector(z, x, 2, 11, -1, 3, 12, -1, 4, 13);
    const Eight::Vector c = __builtin_shufflevector(y, z, 5, 13, -1, 6, 14, -1, 7, 15);
    Eight(__builtin_shufflevector(a, z, 0, 1, 8, 3, 4, 9, 6, 7)).store(rows);
    Eight(__builtin_shufflevector(b, y, 0, 1, 11, 3, 4, 12, 6, 7)).store(rows + group);
    Eight(__builtin_shufflevector(c, x, 0, 1, 14, 3, 4, 15, 6, 7)).store(rows + 2 * group);
}

// Eight states: their rows as the formulas take them, and the results as rows.
struct Group {
    const StateRows& rows;
    std::size_t index;
    const JointConvention& convention;  // of the rows

    ARM3R_INLINE Vec3<Eight> vector(int argument) const {
        const double* from = rows.in[argument];
        if (!from) return {Eight(0.0), Eight(0.0), Eight(0.0)};
        return load_columns(from + index * 3 * group);
    }
    ARM3R_INLINE Vec3<Eight> joints(int argument) const { return convention.flipped(vector(argument)); }
    ARM3R_INLINE Vec3<Eight> angles() const { return convention.to_slide(vector(0)); }
    ARM3R_INLINE Pose<Eight> pose() const { return arm3r::pose(angles()); }

    // + 0.0: no negative zero
    ARM3R_INLINE void store(const Eight& number, int result = 0) const { (number + 0.0).store(row(result)); }
    ARM3R_INLINE void store(const Vec3<Eight>& v, int result = 0) const {
        store_columns({v[0] + 0.0, v[1] + 0.0, v[2] + 0.0}, row(result));
    }
    ARM3R_INLINE void store_joints(const Vec3<Eight>& v) const { store(convention.flipped(v)); }

    // Numbers of every row, from `offset` on.
    template <int count>
    ARM3R_INLINE void store_each(const Eight* numbers, std::size_t offset) const {
        alignas(64) double columns[count][group];
        for (int k = 0; k < count; ++k) (numbers[k] + 0.0).store(columns[k]);
        double* to = row(0) + offset;
        for (std::size_t lane = 0; lane < group; ++lane, to += rows.out[0].width)
            for (int k = 0; k < count; ++k) to[k] = columns[k][lane];
    }
    ARM3R_INLINE void store(const Mat3<Eight>& m, std::size_t offset = 0) const { store_each<9>(m.data(), offset); }
    // J D: rows in space, columns in joints. D M D: both in joints.
    ARM3R_INLINE void store_in_joints(Mat3<Eight> J, std::size_t offset = 0) const {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) J(i, j) *= Eight(convention.sign[j]);
        store(J, offset);
    }
    ARM3R_INLINE void store_joints(Mat3<Eight> M) const {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) M(i, j) *= Eight(convention.sign[i]);
        store_in_joints(M);
    }

private:
    ARM3R_INLINE double* row(int result) const {
        return rows.out[result].data + index * group * rows.out[result].width;
    }
};

// The parameters in all lanes, so that no formula has to spread them.
ARM3R_INLINE Arm<Eight> broadcast_arm(const Arm<double>& from) {
    Arm<Eight> arm;
    copy_arm_choices(from, arm);
    each_arm_number([](Eight& to, const double& number) ARM3R_INLINE_LAMBDA { to = number; }, arm, from);
    return arm;
}

template <class Formula>
void each(const Model& model, std::size_t groups, const StateRows& rows, Formula formula) {
    run_at_widest([&]() ARM3R_INLINE_LAMBDA {
        const Arm<Eight> arm = broadcast_arm(model.arm);
        for (std::size_t i = 0; i < groups; ++i) formula(Group{rows, i, model.convention}, arm);
    });
}

// The mass along a direction of any length; 0 where it has none.
ARM3R_INLINE Eight mass_along(const Arm<Eight>& arm, const Pose<Eight>& p, const Vec3<Eight>& direction) {
    const Eight length = sqrt(dot(direction, direction));
    const Vec3<Eight> n(direction[0] / length, direction[1] / length, direction[2] / length);
    return select(length > Eight(min_length), effective_mass(arm, p, n), Eight(0.0));
}

}  // namespace

namespace in_groups {

using Parameters = const Arm<Eight>&;
using Here = const Group&;

void tip_position(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store(arm3r::tip_position(arm, g.pose())); });
}

void elbow_position(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store(arm3r::elbow_position(arm, g.pose())); });
}

void arm_points(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        const auto points = arm3r::arm_points(arm, g.pose());
        for (std::size_t i = 0; i < points.size(); ++i) g.store_each<3>(points[i].data(), 3 * i);
    });
}

void centres_of_mass(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store(arm3r::centres_of_mass(arm, g.pose())); });
}

void jacobian(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store_in_joints(arm3r::jacobian(arm, g.pose())); });
}

void geometric_jacobian(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        const Pose<Eight> p = g.pose();
        g.store_in_joints(arm3r::jacobian(arm, p));
        g.store_in_joints(angular_jacobian(arm, p), 9);
    });
}

void jacobian_dot(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        g.store_in_joints(arm3r::jacobian_dot(arm, g.pose(), g.joints(1)));
    });
}

void mass_matrix(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store_joints(arm3r::mass_matrix(arm, g.pose())); });
}

void coriolis_matrix(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        g.store_joints(arm3r::coriolis_matrix(arm, g.pose(), g.joints(1)));
    });
}

void velocity_product(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        g.store_joints(arm3r::velocity_product(arm, g.pose(), g.joints(1)));
    });
}

void gravity_torque(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store_joints(arm3r::gravity_torque(arm, g.pose())); });
}

void operational_space_inertia(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store(arm3r::operational_space_inertia(arm, g.pose())); });
}

void effective_mass(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store(mass_along(arm, g.pose(), g.vector(1))); });
}

void manipulability(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows,
         [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA { g.store(arm3r::manipulability(arm, g.pose())); });
}

void energy(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        const Pose<Eight> p = g.pose();
        g.store(kinetic_energy(arm, p, g.joints(1)), 0);
        g.store(potential_energy(arm, p), 1);
    });
}

void forward_dynamics(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        g.store_joints(arm3r::forward_dynamics(arm, g.pose(), g.joints(1), g.joints(2), g.vector(3)));
    });
}

void inverse_dynamics(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        g.store_joints(arm3r::inverse_dynamics(arm, g.pose(), g.joints(1), g.joints(2), g.vector(3)));
    });
}

void tip_sensor(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        const TipSensor<Eight> sensor = arm3r::tip_sensor(arm, g.angles(), g.joints(1));
        g.store(sensor.position, 0);
        g.store(sensor.velocity, 1);
    });
}

void singularity(const Model& model, std::size_t groups, const StateRows& rows) {
    each(model, groups, rows, [](Here g, Parameters arm) ARM3R_INLINE_LAMBDA {
        const Pose<Eight> p = g.pose();
        g.store(abs(Eight(sine_of_bend(arm, p))), 0);
        g.store(abs(radius(arm, p)), 1);
    });
}

}  // namespace in_groups

// An incomplete last group is filled with states of zeros.
void evaluate(GroupFunction& function, const Model& model, std::size_t n, const StateRows& rows) {
    const std::size_t left = n % group, done = n - left;
    if (done > 0) function(model, done / group, rows);
    if (left == 0) return;

    double in[std::tuple_size_v<decltype(StateRows::in)>][3 * group] = {};
    double out[std::tuple_size_v<decltype(StateRows::out)>][max_row_width * group];
    StateRows rest = rows;
    for (std::size_t k = 0; k < rows.in.size(); ++k) {
        if (!rows.in[k]) continue;
        std::copy_n(rows.in[k] + 3 * done, 3 * left, in[k]);
        rest.in[k] = in[k];
    }
    for (std::size_t k = 0; k < rows.out.size(); ++k) rest.out[k].data = out[k];
    function(model, 1, rest);
    for (std::size_t k = 0; k < rows.out.size(); ++k)
        if (const auto [data, width] = rows.out[k]; data) std::copy_n(out[k], left * width, data + done * width);
}

// Without their sign, numbers are ordered like their bits, and NaN is above all.
bool all_within(const double* data, std::size_t count, double limit) {
    const auto most = std::bit_cast<std::int64_t>(limit);
    std::int64_t room = 0;  // negative where any was beyond
    for (std::size_t i = 0; i < count; ++i) room |= most - (std::bit_cast<std::int64_t>(data[i]) & INT64_MAX);
    return room >= 0;
}

}  // namespace arm3r
