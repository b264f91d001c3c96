#include "record/row_log.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "schema/columns.hpp"
#include "validate/size_limits.hpp"

namespace arm3r {
namespace {

// Whether the law tracks a point by joint angles, which are limited by the reach of the arm.
bool follows_point(const Controller<double>& law) {
    return law.type == ControllerType::admittance && law.inner == Inner::joint_pd;
}

// 0 for a finite number, else NaN.
double zero_or_nan(double value) { return 0.0 * value; }

}  // namespace

std::size_t row_count(const Setup& setup) {
    const double intervals = (setup.stop - setup.start) / setup.log_every;
    std::size_t rows = intervals < 2 ? 0 : static_cast<std::size_t>(intervals) - 1;
    while (stands_before(setup, rows, setup.stop)) rows += 1;
    return rows + 1;  // and the end
}

void RowLog::reserve(const RowPlan& plan) {
    run_.columns = plan.columns;
    run_.hidden = plan.hidden;
    run_.reserve(row_count(setup_));
}

void RowLog::log(const RowContext& context, double t, const FullState& y, double theta) {
    const Row row = make_row(context, t, y, theta);
    double nothing = 0;
    each_cell([&](std::size_t column, double* cell) {
        *cell = row.value[column];
        nothing += zero_or_nan(*cell);
    });
    if (nothing != 0) return end_at_bad_row(row, t);
    run_.rows += 1;
    if (!context.is_judged()) return;
    include_residual(run_.energy_residual_max, row.value[ColumnIndex("energy_residual")]);
    if (row.link_behind_wall) record_link_behind_wall(t);
    if (follows_point(context.controller)) check_workspace(context, t, y);
}

void RowLog::log_block(const RowContext& context, int count) {
    RowBlock rows;
    rows.count = count;
    for (int i = 0; i < rows_per_block; ++i)
        rows.t[i] = time_of(run_.rows + static_cast<std::size_t>(std::min(i, count - 1)));
    fill_row_block(context, rows);
    double nothing = 0;
    each_cell([&](std::size_t column, double* cells) {
        const double* values = rows.value[column];
        for (int i = 0; i < count; ++i) nothing += zero_or_nan(cells[i] = values[i]);
    });
    const std::span<const double> times(rows.t, static_cast<std::size_t>(count));
    if (nothing != 0) return log_one_by_one(context, times);
    run_.rows += times.size();
    if (!context.is_judged()) return;
    for (int i = 0; i < count; ++i)
        include_residual(run_.energy_residual_max, rows.value[ColumnIndex("energy_residual")][i]);
    if (rows.first_link_behind_wall < count) record_link_behind_wall(rows.t[rows.first_link_behind_wall]);
    if (!follows_point(context.controller)) return;
    for (const double t : times) check_workspace(context, t, context.dense((t - context.dense.t0) / context.dense.h));
}

void RowLog::log_one_by_one(const RowContext& context, std::span<const double> t) {
    for (std::size_t i = 0; i < t.size() && run_.outcome == ARM3R_RUN_OK; ++i) {
        const double theta = (t[i] - context.dense.t0) / context.dense.h;
        log(context, t[i], context.dense(theta), theta);
    }
}

void RowLog::end_at_bad_row(const Row& row, double t) {
    if (run_.outcome != ARM3R_RUN_OK) return;
    const auto is_bad = [](double value) { return !std::isfinite(value); };
    const auto bad = static_cast<std::size_t>(std::ranges::find_if(row.value, is_bad) - row.value.begin());
    run_.outcome = ARM3R_RUN_DIVERGED;
    run_.message = std::string(column_table[bad].name) + " is not a finite number at t = " + shortest(t) + " s";
}

void RowLog::record_link_behind_wall(double t) {
    if (run_.link_behind_wall_since < 0) run_.link_behind_wall_since = t;
}

void RowLog::check_workspace(const RowContext& context, double t, const FullState& y) {
    const double* point = context.is_sampled ? context.controller_state.memory.data() : y.data() + law_at;
    const double beyond = workspace_excess(context.controller.model, Vec3<double>(point[0], point[1], point[2]));
    if (!(beyond > 0)) return;
    if (run_.out_of_reach_since < 0) run_.out_of_reach_since = t;
    run_.out_of_reach_by = std::max(run_.out_of_reach_by, beyond);
}

}  // namespace arm3r
