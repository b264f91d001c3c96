#include "record/row_log.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "schema/columns.hpp"
#include "validate/size_limits.hpp"

namespace arm3r {
namespace {

// Whether the law follows a point by joint angles, which end where the arm is stretched.
bool follows_point(const Controller<double>& law) {
    return law.type == Controls::admittance && law.inner == Inner::joint_pd;
}

// 0 but for infinities and what is no number.
double nothing_of(double value) { return 0.0 * value; }

}  // namespace

void RowLog::reserve() {
    const double intervals = (setup_.stop - setup_.start) / setup_.log_every;
    std::size_t rows = intervals < 2 ? 0 : static_cast<std::size_t>(intervals) - 1;
    while (stands_before(rows, setup_.stop)) rows += 1;
    run_.reserve(columns_of(setup_), rows + 1);  // and the end
}

void RowLog::log(const Scene& scene, double t, const FullState& y, double theta) {
    const Row row = sample(scene, t, y, theta);
    double* cell = run_.data.get() + run_.rows;
    double nothing = 0;
    for (const std::size_t column : run_.columns) {
        *cell = row.value[column];
        nothing += nothing_of(*cell);
        cell += run_.capacity;
    }
    if (nothing != 0) return end_without(row, t);
    run_.rows += 1;
    note_residual(run_.energy_residual_max, row.value[residual_column]);
    if (row.link_behind_wall) note_link_behind_wall(t);
    if (follows_point(scene.law)) note_reach(scene, t, y);
}

void RowLog::log_together(const Scene& scene) {
    double t[together];
    for (int i = 0; i < together; ++i) t[i] = time_of(run_.rows + i);
    RowBlock rows;
    sample_together(scene, t, rows);
    double* cells = run_.data.get() + run_.rows;
    double nothing = 0;
    for (const std::size_t column : run_.columns) {
        std::copy_n(rows.value[column], together, cells);
        for (const double value : rows.value[column]) nothing += nothing_of(value);
        cells += run_.capacity;
    }
    if (nothing != 0) return log_one_by_one(scene, t);
    run_.rows += together;
    for (const double residual : rows.value[residual_column]) note_residual(run_.energy_residual_max, residual);
    if (rows.first_link_behind_wall < together) note_link_behind_wall(t[rows.first_link_behind_wall]);
    if (!follows_point(scene.law)) return;
    for (const double at : t) note_reach(scene, at, scene.inside((at - scene.inside.t0) / scene.inside.h));
}

void RowLog::log_one_by_one(const Scene& scene, std::span<const double> t) {
    for (std::size_t i = 0; i < t.size() && run_.outcome == ARM3R_RUN_OK; ++i) {
        const double theta = (t[i] - scene.inside.t0) / scene.inside.h;
        log(scene, t[i], scene.inside(theta), theta);
    }
}

void RowLog::end_without(const Row& row, double t) {
    if (run_.outcome != ARM3R_RUN_OK) return;
    const auto is_bad = [&](std::size_t column) { return !std::isfinite(row.value[column]); };
    const std::size_t bad = *std::find_if(run_.columns.begin(), run_.columns.end(), is_bad);
    run_.outcome = ARM3R_RUN_DIVERGED;
    run_.message = std::string(column_table()[bad].name) + " is not a finite number at t = " + shortest(t) + " s";
}

void RowLog::note_link_behind_wall(double t) {
    if (run_.link_behind_wall_since < 0) run_.link_behind_wall_since = t;
}

void RowLog::note_reach(const Scene& scene, double t, const FullState& y) {
    const double* point = scene.is_sampled ? scene.known.memory.data() : y.data() + law_at;
    const double beyond = beyond_reach(scene.law.model, Vec3<double>(point[0], point[1], point[2]));
    if (!(beyond > 0)) return;
    if (run_.out_of_reach_since < 0) run_.out_of_reach_since = t;
    run_.out_of_reach_by = std::max(run_.out_of_reach_by, beyond);
}

}  // namespace arm3r
