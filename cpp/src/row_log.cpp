#include "row_log.hpp"

#include <algorithm>

#include "size_cap.hpp"

namespace arm3r {
RowLog::RowLog(const Setup& setup, Run& run, bool wanted) : setup_(setup), run_(run) {
    if (!wanted) return;
    run.columns = columns_of(setup);
    const double intervals = (setup.stop - setup.start) / setup.log_every;
    run.capacity = intervals < 2 ? 0 : static_cast<std::size_t>(intervals) - 1;
    while (stands_before(run.capacity, setup.stop)) run.capacity += 1;
    run.capacity += 1;  // the end
    run.data = allocate_rows(run.capacity * run.columns.size());
}

void RowLog::log(const Scene& scene, double t, const FullState& y, double theta) {
    const Row row = sample(scene, t, y, theta);
    double* cell = run_.data.get() + run_.rows;
    for (const std::size_t column : run_.columns) {
        *cell = row.value[column];
        cell += run_.capacity;
    }
    run_.rows += 1;
    note_residual(run_.energy_residual_max, row.value[residual_column]);
    if (row.link_behind_wall) note_link_behind_wall(t);
}

void RowLog::log_together(const Scene& scene) {
    double t[together];
    for (int i = 0; i < together; ++i) t[i] = time_of(run_.rows + i);
    Rows rows;
    sample_together(scene, t, rows);
    double* cells = run_.data.get() + run_.rows;
    for (const std::size_t column : run_.columns) {
        std::copy_n(rows.value[column], together, cells);
        cells += run_.capacity;
    }
    run_.rows += together;
    for (const double residual : rows.value[residual_column]) note_residual(run_.energy_residual_max, residual);
    if (rows.first_link_behind_wall < together) note_link_behind_wall(t[rows.first_link_behind_wall]);
}

void RowLog::note_link_behind_wall(double t) {
    if (link_behind_wall_since_ < 0) link_behind_wall_since_ = t;
}

}  // namespace arm3r
