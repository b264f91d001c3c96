#include "validate/size_limits.hpp"

#include <algorithm>

#include "base/number_text.hpp"
#include "schema/columns.hpp"

namespace arm3r {
namespace {

constexpr double max_bytes = 2e9;
constexpr double max_fixed_steps = 1e9;
constexpr double max_ticks = 1e8;

double whole(double count) { return count < 1e15 ? nearest_integer(count) : count; }

struct Limit {
    const char *code, *path, *message, *hint;
};

void refuse_above(double needed, double most, const Limit& limit) {
    if (needed <= most) return;
    throw Error(ARM3R_E_SIZE_CAP, {{.code = limit.code,
                                    .path = limit.path,
                                    .message = limit.message,
                                    .got = "about " + shortest(whole(needed)),
                                    .allowed = "at most " + shortest(whole(most)),
                                    .hint = limit.hint}});
}

double duration(const Setup& setup) { return setup.stop - setup.start; }

double ticks_of(const Setup& setup) {
    return setup.digital.sampling.on ? duration(setup) / setup.digital.sampling.period : 0;
}

double fixed_steps_allowed(const Solver& solver) { return std::min(max_fixed_steps, solver.max_steps); }

constexpr std::size_t need_count = static_cast<std::size_t>(Need::limits) + 1;

// The columns of each need, in the order of Need.
const std::array<ColumnSet, need_count>& columns_by_need() {
    static const std::array<ColumnSet, need_count> columns = [] {
        std::array<ColumnSet, need_count> of;
        for (std::size_t i = 0; i < column_count; ++i) of[static_cast<std::size_t>(column_table[i].need)].set(i);
        return of;
    }();
    return columns;
}

ColumnSet logged_columns(const Setup& setup) { return possible_columns(setup) & setup.logged; }

}  // namespace

bool has_too_many_steps(const Setup& setup) {
    const bool is_fixed = setup.solver.method == SolverMethod::rk4;
    return ticks_of(setup) > max_ticks ||
           (is_fixed && duration(setup) / setup.solver.step > fixed_steps_allowed(setup.solver));
}

void refuse_too_large(const Setup& setup, bool rows) {
    if (rows)
        refuse_above(duration(setup) / setup.log_every,
                     max_bytes / double(logged_columns(setup).count() * sizeof(double)),
                     {.code = "budget.rows",
                      .path = "time.log_every",
                      .message = "the run would need too many rows",
                      .hint = "log less often"});
    refuse_above(ticks_of(setup), max_ticks,
                 {.code = "budget.ticks",
                  .path = "sampling.rate",
                  .message = "the controller would have to compute too often",
                  .hint = "sample less often"});
    if (has_too_many_steps(setup))
        refuse_above(duration(setup) / setup.solver.step, fixed_steps_allowed(setup.solver),
                     {.code = "budget.steps",
                      .path = "solver.step",
                      .message = "the run would need too many steps",
                      .hint = "take a larger step, or raise solver.max_steps"});
}

ColumnSet possible_columns(const Setup& setup) {
    const Plant<double>& plant = setup.plant;
    const Controller<double>& controller = setup.controller();
    const bool has_path = tracks_path(controller.type);
    const auto is_there = [&](Need need) {
        switch (need) {
            case Need::nothing: return true;
            case Need::wall: return plant.has_wall;
            case Need::force_reference: return tracks_force(controller.type);
            case Need::path: return has_path && !controller.reference.in_joints;
            case Need::joint_path: return has_path && controller.reference.in_joints;
            case Need::observer: return setup.observes();
            case Need::estimator: return setup.estimation.on;
            case Need::tank: return controller.type == ControllerType::energy_tank;
            case Need::loss: return can_lose_energy(plant);
            default: return plant.arm.has_torque_limit && controller.type != ControllerType::none;
        }
    };
    ColumnSet columns;
    for (std::size_t need = 0; need < need_count; ++need)
        if (is_there(static_cast<Need>(need))) columns |= columns_by_need()[need];
    return columns;
}

std::vector<std::size_t> columns_of(const Setup& setup) { return in_order(logged_columns(setup)); }

std::vector<Problem> missing_columns(const Setup& setup, const std::string& path) {
    std::vector<Problem> problems;
    if (setup.logged.all()) return problems;
    for (const std::size_t column : in_order(setup.logged & ~possible_columns(setup))) {
        const Need need = column_table[column].need;
        problems.push_back({.code = "scenario.column",
                            .path = path,
                            .message = "this run has no such column; it is there " + std::string(need_text(need)),
                            .got = std::string(column_table[column].name),
                            .hint = std::string(need_hint(need)) + ", or take the name out of " + path});
    }
    return problems;
}

std::vector<std::size_t> in_order(const ColumnSet& columns) {
    std::vector<std::size_t> order;
    order.reserve(columns.count());
    for (std::size_t i = 0; i < column_count; ++i)
        if (columns[i]) order.push_back(i);
    return order;
}

}  // namespace arm3r
