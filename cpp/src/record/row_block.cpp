#include "record/row_values.hpp"

namespace arm3r {
namespace {

// As many rows in a pack as the registers hold, one pack after the other.
template <int N>
ARM3R_INLINE void fill_block(const RowContext& context, const double* t, RowBlock& rows) {
    using Group = Pack<N>;
    rows.first_link_behind_wall = rows_per_block;
    for (int first = rows_per_block - N; first >= 0; first -= N) {
        const Group at = Group::load(t + first);
        const Group theta = (at - context.dense.t0) / context.dense.h;
        State<Group, full_size> y{};
        for (std::size_t i = 0; i < context.dense.size; ++i) y[i] = context.dense.component(i, theta);
        RowValues<Group> sampled;
        fill_row(context, at, y, theta, sampled);
        for (std::size_t i = 0; i < column_count; ++i) sampled.value[i].store(rows.value[i] + first);
        for (int i = N - 1; i >= 0; --i)
            if (sampled.link_behind_wall[i] > 0) rows.first_link_behind_wall = first + i;
    }
}

void by_two(const RowContext& context, const double* t, RowBlock& rows) { fill_block<2>(context, t, rows); }
#if ARM3R_WIDE_PACKS
ARM3R_FOR_FOUR void by_four(const RowContext& context, const double* t, RowBlock& rows) {
    fill_block<4>(context, t, rows);
}
#endif

}  // namespace

void make_row_block(const RowContext& context, const double* t, RowBlock& rows) {
#if ARM3R_WIDE_PACKS
    static const bool has_four = max_lanes() >= 4;  // by eight takes twice as long: more numbers than registers
    if (has_four) return by_four(context, t, rows);
#endif
    by_two(context, t, rows);
}

}  // namespace arm3r
