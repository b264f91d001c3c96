#pragma once
// A row: all columns at one instant, from t and the state at that instant alone. Nothing is stored between rows.

#include <algorithm>
#include <array>
#include <span>

#include "arm3r/numbers/polynomial.hpp"
#include "arm3r/plant.hpp"
#include "contact/contact_mode.hpp"
#include "control/continuous_inputs.hpp"
#include "control/sampled_controller.hpp"
#include "integrate/dense_output.hpp"
#include "schema/columns.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// The vector without negative zeros, as users see it; angles and rates of joints in the arm's convention.
inline std::array<double, 3> without_negative_zero(const Vec3<double>& v) {
    return {v[0] + 0.0, v[1] + 0.0, v[2] + 0.0};
}

inline std::array<double, 3> angles_out(const Setup& setup, const Vec3<double>& q) {
    return without_negative_zero(setup.convention.from_slide(q));
}
inline std::array<double, 3> rates_out(const Setup& setup, const Vec3<double>& qd) {
    return without_negative_zero(setup.convention.flipped(qd));
}

template <class T>
struct Energies {
    T kinetic, potential, contact;  // J; potential: of the pose, as only its changes count
    ARM3R_INLINE T sum() const { return kinetic + potential + contact; }
};

Energies<double> energies(const Plant<double>& plant, double t, const FullState& y, ContactMode mode);

// Beyond this rate, rad/s, a motion has diverged: a step of an eighth of a turn takes some microseconds there, and the
// work for a simulated second would grow without bound. Where angles and rates are in range, so is every column.
inline constexpr double rate_limit = 1e5;

// Whether the motion has diverged. A run ends there whatever of it is recorded.
template <class T, std::size_t N>
ARM3R_INLINE auto is_out_of_range(const State<T, N>& y) {
    return max(max(abs(y[0]), abs(y[1])), abs(y[2])) > T(sincos_limit) ||
           max(max(abs(y[3]), abs(y[4])), abs(y[5])) > T(rate_limit);
}

// The residual of the energy balance (4.9).
template <class T, std::size_t N, class E>
ARM3R_INLINE T energy_residual(const State<T, N>& y, const T& energy, const E& energy_at_start) {
    return (energy - energy_at_start) - (y[work_of_actuators] + y[work_of_wall] - y[dissipated]);
}

// The parts of the dissipated energy since the start, J (4.9). `at_edges` is the sum over the changes of contact.
template <class P, class T>
ARM3R_INLINE std::array<T, 4> dissipated_parts(const Plant<P>& plant, const State<T, full_size>& y, double at_edges) {
    const T joints = y[dissipated_in_joints], friction = y[dissipated_in_friction], edges(at_edges);
    const T contact = dissipates_in_contact(plant) ? T(y[dissipated] - joints - friction - edges) : T(0.0);
    return {joints, contact, friction, edges};
}

// The columns of the plan, and energy_residual; joint vectors in the arm's convention. Others are 0.
struct Row {
    std::array<double, column_count> value;
    bool link_behind_wall;  // the elbow, or a link that is not in contact itself, lies behind the plate
};

// What rows are computed from beside time, angles and rates: each is computed only if a column needs it, and energy and
// links also for what a run says about its rows. The contact comes with any other part.
enum RowPart : unsigned {
    applied_torque = 1,
    acceleration = 2,
    gravity_part = 4,
    transform_sensor = 8,
    jacobian_velocity = 16,
    differentiated_position = 32,
    law_signals = 64,
    observer_signals = 128,
    memory_signals = 256,
    losses = 512,
    contact_state = 1024,
    energy_terms = 2048,
    links_behind_wall = 4096,
};

// What a run says about its rows: the largest residual of their energies, and the links behind the wall.
constexpr unsigned judged_parts = energy_terms | links_behind_wall;

// The columns of a log, those that are kept beside them, and the parts of a row that they need.
struct RowPlan {
    std::vector<std::size_t> columns, hidden;
    unsigned parts;
};

// is_judged: whether the run says something about its rows.
RowPlan make_row_plan(const Setup& setup, const ColumnSet& kept, bool is_judged = true);
RowPlan plan_of_end();  // of what EndValues has (run_data.hpp); in memory it has no column

// The data that all rows within a step share.
struct RowContext {
    const Plant<double>& plant;
    const JointConvention& convention;
    double energy_at_start;
    ContactMode mode;
    const DenseOutput& dense;  // the tip position is differentiated along it (5.4)
    const Controller<double>& controller;
    bool is_sampled;                                  // the law is a digital controller's
    const ControllerState<double>& controller_state;  // of the sampled controller
    ContinuousInputs inputs;                          // of a continuous one
    double lost_at_edges;                             // J, so far
    std::span<const double> jumps;                    // s, of formulas of time within the step
    double clock_rounding;                            // s
    const RowPlan& plan;

    bool needs(unsigned parts) const { return (plan.parts & parts) != 0; }
    bool is_judged() const { return needs(links_behind_wall); }
};

// `theta` is the place of t within the step.
Row make_row(const RowContext& context, double t, const FullState& y, double theta);

// Up to eight rows of the dense output of a step, computed together, with the same bits as one by one.
constexpr int rows_per_block = 8;

struct RowBlock {
    int count;                                               // of rows
    double t[rows_per_block];                                // s; after the last row its time is repeated
    alignas(64) double value[column_count][rows_per_block];  // the columns of the plan, and energy_residual
    int first_link_behind_wall;                              // the first row with link_behind_wall, or `count`
};

// Sets the values of a block whose times are given.
void fill_row_block(const RowContext& context, RowBlock& rows);

}  // namespace arm3r
