#include <algorithm>

#include "arm3r/numbers/widths.hpp"
#include "record/row_values.hpp"

namespace arm3r {
namespace {

// As many rows in a pack as the registers hold, one pack after the other.
template <class Group>
ARM3R_INLINE void fill_block(const RowContext& context, RowBlock& rows) {
    constexpr int N = Lanes<Group>::count;
    rows.first_link_behind_wall = rows.count;
    for (int first = (rows.count - 1) / N * N; first >= 0; first -= N) {
        const Group at = Group::load(rows.t + first);
        const Group theta = (at - context.dense.t0) / context.dense.h;
        RowValues<Group> sampled;
        fill_row(context, at, state_for_row(context, theta), theta, sampled);
        const auto store = [&](std::size_t i) ARM3R_INLINE_LAMBDA { sampled.value[i].store(rows.value[i] + first); };
        for (const std::size_t column : context.plan.columns) store(column);
        for (const std::size_t column : context.plan.hidden) store(column);
        if (!context.is_judged()) continue;
        store(ColumnIndex("energy_residual"));
        for (int i = N - 1; i >= 0; --i)
            if (sampled.link_behind_wall[i] > 0)
                rows.first_link_behind_wall = std::min(rows.first_link_behind_wall, first + i);
    }
}

// Where a build for another processor is run: one row after the other.
template <>
void fill_block<double>(const RowContext& context, RowBlock& rows) {
    rows.first_link_behind_wall = rows.count;
    for (int i = rows.count - 1; i >= 0; --i) {
        const double t = rows.t[i], theta = (t - context.dense.t0) / context.dense.h;
        const Row row = make_row(context, t, context.dense(theta), theta);
        for (std::size_t column = 0; column < column_count; ++column) rows.value[column][i] = row.value[column];
        if (row.link_behind_wall) rows.first_link_behind_wall = i;
    }
}

}  // namespace

void fill_row_block(const RowContext& context, RowBlock& rows) {
    static const int lanes = widest(RowTypes{}, 4);
    run_at_width(RowTypes{}, lanes, [&]<class T>() ARM3R_INLINE_LAMBDA { fill_block<T>(context, rows); });
}

}  // namespace arm3r
