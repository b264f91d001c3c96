// The numbers half of the C interface: version, parameters, the arm, and reading a run.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <vector>

#include "api/c_api.hpp"
#include "arm3r/model/derivatives.hpp"
#include "base/number_text.hpp"
#include "batch/model_batch.hpp"
#include "batch/simulation.hpp"
#include "schema/columns.hpp"
#include "schema/schema.hpp"
#include "setup/make_elbow.hpp"
#include "setup/setup.hpp"
#include "validate/rules.hpp"
#include "validate/validate.hpp"

using namespace arm3r;

struct arm3r_arm : Model {};

namespace {

constexpr double max_number = 1e100;  // its square and cube are still numbers
constexpr double min_sine = 1e-3;     // of joint 3, or of the tip's distance from joint 1's axis over the arm's length
constexpr std::size_t max_states = std::numeric_limits<std::size_t>::max() / (21 * sizeof(double));

struct Input {  // rows of 3
    const double* data;
    const char* name;
    double limit;
    bool nullable = false;
};

struct Output {
    double* data;
    std::size_t width;
    const char* name;
};

using Inputs = std::initializer_list<Input>;
using Outputs = std::initializer_list<Output>;

Input joint_angles(const double* q) { return {q, "q", sincos_limit}; }
Input numbers(const double* data, const char* name) { return {data, name, max_number}; }
Input tip_force(const double* f_on_tip) { return {f_on_tip, "f_on_tip", max_number, true}; }

Error bad_value(const Input& in, std::size_t at) {
    const std::string where = std::string(in.name) + "[" + std::to_string(at / 3) + "][" + std::to_string(at % 3) + "]";
    return Error(ARM3R_E_VALUE, {{.code = "argument.value",
                                  .path = where,
                                  .message = "not a number that this function takes",
                                  .got = shortest(in.data[at]),
                                  .allowed = "finite, at most " + shortest(in.limit) + " either way"}});
}

void check_values(const Input& in, std::size_t n) {
    if (!in.data || all_within(in.data, 3 * n, in.limit)) return;
    for (std::size_t i = 0; i < 3 * n; ++i)
        if (!(std::abs(in.data[i]) <= in.limit)) throw bad_value(in, i);
}

bool overlap(const double* a, std::size_t a_count, const double* b, std::size_t b_count) {
    const auto at = [](const double* p) { return reinterpret_cast<std::uintptr_t>(p); };
    return at(a) < at(b) + b_count * sizeof(double) && at(b) < at(a) + a_count * sizeof(double);
}

void check_overlap(const Output& out, const double* other, std::size_t width, const char* name, std::size_t n) {
    if (n > 0 && other && overlap(out.data, n * out.width, other, n * width))
        throw Error(ARM3R_E_OVERLAP, std::string(out.name) + " overlaps " + name);
}

// All that is checked before a model function writes its first number.
void check(const arm3r_arm* arm, std::size_t n, Inputs inputs, Outputs outputs) {
    need(arm, "arm");
    for (const Input& in : inputs)
        if (in.data || !in.nullable) check_pointer(in.data, in.name);
    for (const Output& out : outputs) check_pointer(out.data, out.name);
    if (n > max_states) throw Error(ARM3R_E_SIZE, "n is " + std::to_string(n) + ": no array is as long");
    for (const Output& out : outputs) {
        for (const Input& in : inputs) check_overlap(out, in.data, 3, in.name, n);
        for (const Output& other : outputs)
            if (other.data != out.data) check_overlap(out, other.data, other.width, other.name, n);
            else if (&other != &out) throw Error(ARM3R_E_OVERLAP, std::string(out.name) + " overlaps " + other.name);
    }
    for (const Input& in : inputs) check_values(in, n);
}

StateRows rows(Inputs inputs, Outputs outputs) {
    StateRows all{};
    std::transform(inputs.begin(), inputs.end(), all.in.begin(), [](const Input& in) { return in.data; });
    std::transform(outputs.begin(), outputs.end(), all.out.begin(),
                   [](const Output& out) { return StateRows::Out{out.data, out.width}; });
    return all;
}

Vec3<double> load(const double* data, std::size_t i) { return {data[3 * i], data[3 * i + 1], data[3 * i + 2]}; }

// Joint angles, and other joint vectors, in the caller's convention from and to slide.
Vec3<double> load_angles(const arm3r_arm& arm, const double* data, std::size_t i) {
    return arm.convention.to_slide(load(data, i));
}
Vec3<double> load_joints(const arm3r_arm& arm, const double* data, std::size_t i) {
    return arm.convention.flipped(load(data, i));
}

void store(const Vec3<double>& v, double* data, std::size_t i) {
    for (int k = 0; k < 3; ++k) data[3 * i + k] = v[k] + 0.0;  // + 0.0: no negative zero
}

void store_joints(const arm3r_arm& arm, const Vec3<double>& v, double* data, std::size_t i) {
    store(arm.convention.flipped(v), data, i);
}

Error singular(std::size_t i, const std::string& what) {
    return Error(
        ARM3R_E_SINGULAR,
        {{.code = "argument.singular",
          .path = "q[" + std::to_string(i) + "]",
          .message = what,
          .hint =
              "|sin q3| (of the bend) and |r|, the tip's radius about axis 1, over the reach must be at least 1e-3"}});
}

void refuse_singular(const Model& model, std::size_t n, const double* q) {
    constexpr std::size_t most = 512;
    double sine[most], radius[most];
    for (std::size_t first = 0; first < n; first += most) {
        const std::size_t count = std::min(most, n - first);
        evaluate(in_groups::singularity, model, count, {{q + 3 * first}, {{{sine, 1}, {radius, 1}}}});
        for (std::size_t i = 0; i < count; ++i) {
            if (sine[i] < min_sine) throw singular(first + i, "the arm is stretched or folded: the pose is singular");
            if (radius[i] < min_sine * reach(model.arm))
                throw singular(first + i, std::string(tip_at_axis_text(model.arm)) + ": the pose is singular");
        }
    }
}

[[noreturn]] void refuse_direction(const Vec3<double>& direction, std::size_t i) {
    if (std::sqrt(dot(direction, direction)) > min_length)
        throw singular(i, "the tip cannot move along this direction");
    throw Error(ARM3R_E_VALUE, {{.code = "argument.value",
                                 .path = "direction[" + std::to_string(i) + "]",
                                 .message = "a direction needs a length",
                                 .got = "[0, 0, 0]",
                                 .allowed = "any vector that is not zero"}});
}

int32_t evaluated(const arm3r_arm* arm, std::size_t n, Inputs inputs, Outputs outputs, GroupFunction& function) {
    return guard([&] {
        check(arm, n, inputs, outputs);
        evaluate(function, *arm, n, rows(inputs, outputs));
    });
}

constexpr double no_force[3] = {0, 0, 0};

// Evaluates the recursion for one state after the other. A missing force is zero for every state.
template <class Body>
int32_t by_recursion(const arm3r_arm* arm, std::size_t n, const double* q, const double* qd, const char* third_name,
                     const double* third, const double* f_on_tip, Output out, Body body) {
    return guard([&] {
        check(arm, n, {joint_angles(q), numbers(qd, "qd"), numbers(third, third_name), tip_force(f_on_tip)}, {out});
        for (std::size_t i = 0; i < n; ++i)
            store_joints(*arm,
                         body(load_angles(*arm, q, i), load_joints(*arm, qd, i), load_joints(*arm, third, i),
                              f_on_tip ? load(f_on_tip, i) : load(no_force, 0)),
                         out.data, i);
    });
}

// A matrix of derivatives of a joint vector with respect to a joint vector: D A D (1.1).
void store_derivatives(const arm3r_arm& arm, const Mat3<double>& A, double* data, std::size_t i) {
    const Vec3<double>& sign = arm.convention.sign;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            data[9 * i + 3 * row + column] = sign[row] * sign[column] * A(row, column) + 0.0;  // no negative zero
}

// The derivatives of a joint vector with respect to q, qd and a third argument, for one state after the other.
template <class Body>
int32_t differentiated(const arm3r_arm* arm, std::size_t n, const double* q, const double* qd, const Input& third,
                       const double* f_on_tip, const std::array<Output, 3>& by, Body body) {
    return guard([&] {
        check(arm, n, {joint_angles(q), numbers(qd, "qd"), third, tip_force(f_on_tip)}, {by[0], by[1], by[2]});
        for (std::size_t i = 0; i < n; ++i) {
            const Derivatives found =
                body(arm->arm, load_angles(*arm, q, i), load_joints(*arm, qd, i), load_joints(*arm, third.data, i),
                     f_on_tip ? load(f_on_tip, i) : load(no_force, 0));
            for (int k = 0; k < 3; ++k) store_derivatives(*arm, found[k], by[k].data, i);
        }
    });
}

const std::vector<std::string>& param_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (std::size_t i = 0; i < param_count(); ++i) all.push_back(param_name(i));
        return all;
    }();
    return names;
}

}  // namespace

// ---- version

int32_t arm3r_abi_version(void) { return ARM3R_ABI; }
const char* arm3r_version(void) { return ARM3R_VERSION; }
const char* arm3r_build_info(void) { return ARM3R_BUILD_INFO; }

const char* arm3r_outcome_name(int32_t outcome) {
    static const char* const names[] = {"ok",          "stopped",         "diverged", "step_collapse",
                                        "event_storm", "ill_conditioned", "energy",   "budget",
                                        "invalid",     "controller"};
    return outcome >= 0 && outcome < int32_t(std::size(names)) ? names[outcome] : "";
}

// ---- parameters

size_t arm3r_param_count(void) { return param_count(); }

int32_t arm3r_param_index(const char* name, size_t name_size, size_t* index) {
    return guard([&] {
        need(index, "index");
        *index = param_index(text_in(name, name_size, "name"));
    });
}

int32_t arm3r_param_name(size_t index, const char** name) {
    return guard([&] {
        need(name, "name");
        check_index(index, param_count(), "parameter");
        *name = param_names()[index].c_str();
    });
}

int32_t arm3r_param_key(size_t index, const char** key, const char** kind, const char** unit) {
    return guard([&] {
        need(key, "key");
        need(kind, "kind");
        need(unit, "unit");
        check_index(index, param_count(), "parameter");
        const Key& found = key_at(index);
        *key = found.path.c_str();
        *kind = kind_name(found.kind);
        *unit = found.unit.c_str();
    });
}

int32_t arm3r_param_defaults(double* params, size_t count) {
    return guard([&] {
        if (params_in(params, count).size() != param_count())
            throw Error(ARM3R_E_SIZE, "params has " + std::to_string(count) + " numbers; there are " +
                                          std::to_string(param_count()) + " defaults");
        const std::vector<double> defaults = param_defaults();
        std::copy(defaults.begin(), defaults.end(), params);
    });
}

// ---- the arm

int32_t arm3r_arm_create(const double* params, size_t count, arm3r_arm** arm) {
    return guard([&] {
        need(arm, "arm");
        const std::span<const double> all = params_in(params, count);
        valid_setup(all);
        *arm = new arm3r_arm{{make_arm(all), convention_of(all)}};
    });
}

void arm3r_arm_free(arm3r_arm* arm) { delete arm; }

int32_t arm3r_arm_tip_position(const arm3r_arm* arm, size_t n, const double* q, double* tip) {
    return evaluated(arm, n, {joint_angles(q)}, {{tip, 3, "tip"}}, in_groups::tip_position);
}

int32_t arm3r_arm_elbow_position(const arm3r_arm* arm, size_t n, const double* q, double* elbow) {
    return evaluated(arm, n, {joint_angles(q)}, {{elbow, 3, "elbow"}}, in_groups::elbow_position);
}

int32_t arm3r_arm_points(const arm3r_arm* arm, size_t n, const double* q, double* points) {
    return evaluated(arm, n, {joint_angles(q)}, {{points, 21, "points"}}, in_groups::arm_points);
}

int32_t arm3r_arm_reach(const arm3r_arm* arm, double* most) {
    return guard([&] {
        need(arm, "arm");
        need(most, "reach");
        *most = reach(arm->arm);
    });
}

int32_t arm3r_arm_centres(const arm3r_arm* arm, size_t n, const double* q, double* centres_of_mass) {
    return evaluated(arm, n, {joint_angles(q)}, {{centres_of_mass, 9, "centres"}}, in_groups::centres_of_mass);
}

int32_t arm3r_arm_jacobian(const arm3r_arm* arm, size_t n, const double* q, double* jacobian) {
    return evaluated(arm, n, {joint_angles(q)}, {{jacobian, 9, "jacobian"}}, in_groups::jacobian);
}

int32_t arm3r_arm_geometric_jacobian(const arm3r_arm* arm, size_t n, const double* q, double* jacobian) {
    return evaluated(arm, n, {joint_angles(q)}, {{jacobian, 18, "jacobian"}}, in_groups::geometric_jacobian);
}

int32_t arm3r_arm_jacobian_dot(const arm3r_arm* arm, size_t n, const double* q, const double* qd,
                               double* jacobian_dot) {
    return evaluated(arm, n, {joint_angles(q), numbers(qd, "qd")}, {{jacobian_dot, 9, "jacobian_dot"}},
                     in_groups::jacobian_dot);
}

int32_t arm3r_arm_mass_matrix(const arm3r_arm* arm, size_t n, const double* q, double* mass) {
    return evaluated(arm, n, {joint_angles(q)}, {{mass, 9, "mass"}}, in_groups::mass_matrix);
}

int32_t arm3r_arm_coriolis_matrix(const arm3r_arm* arm, size_t n, const double* q, const double* qd, double* coriolis) {
    return evaluated(arm, n, {joint_angles(q), numbers(qd, "qd")}, {{coriolis, 9, "coriolis"}},
                     in_groups::coriolis_matrix);
}

int32_t arm3r_arm_velocity_product(const arm3r_arm* arm, size_t n, const double* q, const double* qd, double* product) {
    return evaluated(arm, n, {joint_angles(q), numbers(qd, "qd")}, {{product, 3, "product"}},
                     in_groups::velocity_product);
}

int32_t arm3r_arm_gravity_torque(const arm3r_arm* arm, size_t n, const double* q, double* tau_g) {
    return evaluated(arm, n, {joint_angles(q)}, {{tau_g, 3, "tau_g"}}, in_groups::gravity_torque);
}

int32_t arm3r_arm_operational_space_inertia(const arm3r_arm* arm, size_t n, const double* q, double* lambda) {
    return guard([&] {
        check(arm, n, {joint_angles(q)}, {{lambda, 9, "lambda"}});
        refuse_singular(*arm, n, q);
        evaluate(in_groups::operational_space_inertia, *arm, n, {{q}, {{{lambda, 9}}}});
    });
}

int32_t arm3r_arm_effective_mass(const arm3r_arm* arm, size_t n, const double* q, const double* direction,
                                 double* mass) {
    return guard([&] {
        check(arm, n, {joint_angles(q), numbers(direction, "direction")}, {{mass, 1, "mass"}});
        std::vector<double> found(n);
        evaluate(in_groups::effective_mass, *arm, n, {{q, direction}, {{{found.data(), 1}}}});
        for (std::size_t i = 0; i < n; ++i)
            if (!(std::isfinite(found[i]) && found[i] > 0)) refuse_direction(load(direction, i), i);
        std::copy(found.begin(), found.end(), mass);
    });
}

int32_t arm3r_arm_manipulability(const arm3r_arm* arm, size_t n, const double* q, double* manipulability) {
    return evaluated(arm, n, {joint_angles(q)}, {{manipulability, 1, "manipulability"}}, in_groups::manipulability);
}

int32_t arm3r_arm_energy(const arm3r_arm* arm, size_t n, const double* q, const double* qd, double* kinetic,
                         double* potential) {
    return evaluated(arm, n, {joint_angles(q), numbers(qd, "qd")},
                     {{kinetic, 1, "kinetic"}, {potential, 1, "potential"}}, in_groups::energy);
}

int32_t arm3r_arm_forward_dynamics(const arm3r_arm* arm, size_t n, const double* q, const double* qd, const double* tau,
                                   const double* f_on_tip, double* qdd) {
    return evaluated(arm, n, {joint_angles(q), numbers(qd, "qd"), numbers(tau, "tau"), tip_force(f_on_tip)},
                     {{qdd, 3, "qdd"}}, in_groups::forward_dynamics);
}

int32_t arm3r_arm_inverse_dynamics(const arm3r_arm* arm, size_t n, const double* q, const double* qd, const double* qdd,
                                   const double* f_on_tip, double* tau) {
    return evaluated(arm, n, {joint_angles(q), numbers(qd, "qd"), numbers(qdd, "qdd"), tip_force(f_on_tip)},
                     {{tau, 3, "tau"}}, in_groups::inverse_dynamics);
}

int32_t arm3r_arm_recursion_inverse_dynamics(const arm3r_arm* arm, size_t n, const double* q, const double* qd,
                                             const double* qdd, const double* f_on_tip, double* tau) {
    return by_recursion(arm, n, q, qd, "qdd", qdd, f_on_tip, {tau, 3, "tau"},
                        [&](const Vec3<double>& angles, const Vec3<double>& w, const Vec3<double>& a,
                            const Vec3<double>& f) { return recursion_inverse_dynamics(arm->arm, angles, w, a, f); });
}

int32_t arm3r_arm_recursion_forward_dynamics(const arm3r_arm* arm, size_t n, const double* q, const double* qd,
                                             const double* tau, const double* f_on_tip, double* qdd) {
    return by_recursion(
        arm, n, q, qd, "tau", tau, f_on_tip, {qdd, 3, "qdd"},
        [&](const Vec3<double>& angles, const Vec3<double>& w, const Vec3<double>& torque, const Vec3<double>& f) {
            return recursion_forward_dynamics(arm->arm, angles, w, torque, f);
        });
}

int32_t arm3r_arm_forward_dynamics_derivatives(const arm3r_arm* arm, size_t n, const double* q, const double* qd,
                                               const double* tau, const double* f_on_tip, double* qdd_by_q,
                                               double* qdd_by_qd, double* qdd_by_tau) {
    return differentiated(arm, n, q, qd, numbers(tau, "tau"), f_on_tip,
                          {{{qdd_by_q, 9, "qdd_by_q"}, {qdd_by_qd, 9, "qdd_by_qd"}, {qdd_by_tau, 9, "qdd_by_tau"}}},
                          forward_dynamics_derivatives);
}

int32_t arm3r_arm_inverse_dynamics_derivatives(const arm3r_arm* arm, size_t n, const double* q, const double* qd,
                                               const double* qdd, const double* f_on_tip, double* tau_by_q,
                                               double* tau_by_qd, double* tau_by_qdd) {
    return differentiated(arm, n, q, qd, numbers(qdd, "qdd"), f_on_tip,
                          {{{tau_by_q, 9, "tau_by_q"}, {tau_by_qd, 9, "tau_by_qd"}, {tau_by_qdd, 9, "tau_by_qdd"}}},
                          inverse_dynamics_derivatives);
}

int32_t arm3r_arm_tip_sensor(const arm3r_arm* arm, size_t n, const double* q, const double* qd, double* position,
                             double* velocity) {
    return evaluated(arm, n, {joint_angles(q), numbers(qd, "qd")},
                     {{position, 3, "position"}, {velocity, 3, "velocity"}}, in_groups::tip_sensor);
}

int32_t arm3r_arm_inverse_kinematics(const arm3r_arm* arm, size_t n, const double* tip, int32_t front, int32_t elbow_up,
                                     double* q, size_t* failed) {
    return guard([&] {
        check(arm, n, {numbers(tip, "tip")}, {{q, 3, "q"}});
        for (const int32_t flag : {front, elbow_up})
            if (flag != 0 && flag != 1)
                throw Error(ARM3R_E_VALUE, "front and elbow_up are 0 or 1, not " + std::to_string(flag));
        constexpr double rounding = 1e-12;  // a stretched arm may come out this much beyond its reach
        for (std::size_t i = 0; i < n; ++i) {
            const double C3 = inverse_kinematics(arm->arm, load(tip, i), front, elbow_up).cos_q3;
            if (std::abs(C3) <= 1 + rounding) continue;
            if (failed) *failed = i;
            throw Error(ARM3R_E_REACH, {{.code = "argument.reach",
                                         .path = "tip[" + std::to_string(i) + "]",
                                         .message = "the point is out of reach",
                                         .got = distance_from_reach(arm->arm, load(tip, i), front),
                                         .allowed = reach_text(arm->arm)}});
        }
        for (std::size_t i = 0; i < n; ++i)
            store(arm->convention.from_slide(inverse_kinematics(arm->arm, load(tip, i), front, elbow_up).q), q, i);
    });
}

// ---- a run

int32_t arm3r_params_run(const double* params, size_t count, const arm3r_run_options* options, arm3r_run** run) {
    return guard([&] {
        need(run, "run");
        auto handle = std::make_unique<arm3r_run>();
        run_in(*handle, valid_setup(params_in(params, count)), options);
        *run = handle.release();
    });
}

void arm3r_run_free(arm3r_run* run) { delete run; }

int32_t arm3r_run_outcome(const arm3r_run* run, int32_t* outcome) {
    return guard([&] {
        need(run, "run");
        need(outcome, "outcome");
        *outcome = run->run.outcome;
    });
}

int32_t arm3r_run_shape(const arm3r_run* run, size_t* rows, size_t* columns) {
    return guard([&] {
        need(run, "run");
        need(rows, "rows");
        need(columns, "columns");
        *rows = run->run.rows;
        *columns = run->run.columns.size();
    });
}

int32_t arm3r_run_column(const arm3r_run* run, size_t index, const char** name, const char** unit,
                         const double** data) {
    return guard([&] {
        need(run, "run");
        need(name, "name");
        need(unit, "unit");
        need(data, "data");
        check_index(index, run->run.columns.size(), "column");
        const arm3r::Column& column = column_table[run->run.columns[index]];
        *name = column.name.data();
        *unit = column.unit.data();
        *data = run->run.column(index).data();
    });
}

int32_t arm3r_run_event_count(const arm3r_run* run, size_t* count) {
    return guard([&] {
        need(run, "run");
        need(count, "count");
        *count = run->run.events.size();
    });
}

int32_t arm3r_run_event(const arm3r_run* run, size_t index, arm3r_event* event) {
    return guard([&] {
        need(run, "run");
        need(event, "event");
        check_index(index, run->run.events.size(), "event");
        const Event& from = run->run.events[index];
        *event = {from.type == Event::make ? 0 : 1, 0, from.t, {}, {}, {}};
        std::copy(from.q.begin(), from.q.end(), event->q);
        std::copy(from.qd.begin(), from.qd.end(), event->qd);
        std::copy(from.tip.begin(), from.tip.end(), event->tip);
    });
}
