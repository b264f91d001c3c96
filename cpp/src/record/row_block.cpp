#include "record/row_values.hpp"

namespace arm3r {
namespace {

// As many rows side by side as the registers hold, one such group after the other.
template <int N>
ARM3R_INLINE void sample_groups(const Scene& scene, const double* t, RowBlock& rows) {
    using Group = Pack<N>;
    rows.first_link_behind_wall = together;
    for (int first = together - N; first >= 0; first -= N) {
        const Group at = Group::load(t + first);
        const Group theta = (at - scene.inside.t0) / scene.inside.h;
        State<Group, full_size> y{};
        for (std::size_t i = 0; i < scene.inside.size; ++i) y[i] = scene.inside.component(i, theta);
        Sampled<Group> sampled;
        sample_into(scene, at, y, theta, sampled);
        for (std::size_t i = 0; i < column_count; ++i) sampled.value[i].store(rows.value[i] + first);
        for (int i = N - 1; i >= 0; --i)
            if (sampled.link_behind_wall[i] > 0) rows.first_link_behind_wall = first + i;
    }
}

void by_two(const Scene& scene, const double* t, RowBlock& rows) { sample_groups<2>(scene, t, rows); }
#if ARM3R_WIDE_PACKS
ARM3R_FOR_FOUR void by_four(const Scene& scene, const double* t, RowBlock& rows) { sample_groups<4>(scene, t, rows); }
#endif

}  // namespace

void sample_together(const Scene& scene, const double* t, RowBlock& rows) {
#if ARM3R_WIDE_PACKS
    static const bool has_four = widest_lanes() >= 4;  // by eight takes twice as long: more numbers than registers
    if (has_four) return by_four(scene, t, rows);
#endif
    by_two(scene, t, rows);
}

}  // namespace arm3r
