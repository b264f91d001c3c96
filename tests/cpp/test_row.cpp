
#include "check.hpp"
#include "fixtures.hpp"
#include "record/row.hpp"

using namespace arm3r;

TEST_SUITE(sample_rows)

namespace {

// A step of random numbers: an interpolant, or a power series as the Taylor method has it.
DenseOutput random_step(Random& random, bool is_series) {
    DenseOutput dense{};
    if (!is_series) {
        FullState y0, f0, y1, f1;
        for (FullState* state : {&y0, &f0, &y1, &f1})
            for (double& x : *state) x = random.in(-2, 2);
        dense.assign(hermite(3.0, 0.2, y0, f0, y1, f1));
        return dense;
    }
    dense.t0 = 3.0;
    dense.h = 0.2;
    dense.order = 9;
    for (FullState& of_order : dense.c)
        for (double& x : of_order) x = random.in(-1, 1);
    return dense;
}

Setup random_setup(Random& random, int trial, bool has_law) {
    Params params = trial % 7 < 3 ? random_elbow_params(random) : random_params(random);
    params.set("wall", 1).set("wall.point", random.vector(-1, 1)).set("wall.normal", random.vector(-1, 1));
    params.choose("wall.motion.type", "sinusoid")
        .set("wall.motion.amplitude", 0.1)
        .set("wall.motion.frequency", 2)
        .set("wall.motion.phase", 1);
    params.set("wall.acts_on_arm", trial % 2).choose("controller.type", trial % 3 ? "gravity_compensation" : "none");
    params.choose("controller.algorithm", trial % 5 ? "closed_form" : "recursion");
    const char* const laws[] = {"hybrid", "admittance", "computed_torque", "energy_tank", "adaptive_reference"};
    if (has_law) params.choose("controller.type", laws[trial / 2 % 5]).set("observer", trial % 4 == 1);
    return make_setup(params);
}

}  // namespace

// Rows taken eight at once, in whatever instruction set, are those taken one by one; and a column is the same whatever
// stands beside it.
TEST_CASE(eight_rows_together_are_the_same_bits_as_one_by_one) {
    Random random(7);
    for (int trial = 0; trial < 400; ++trial) {
        const bool has_law = trial % 2;
        const Setup setup = random_setup(random, trial, has_law);
        const DenseOutput dense = random_step(random, !has_law && trial % 3 > 0);
        const ControllerState<double> controller_state{};
        const RowPlan plan = make_row_plan(setup, {});
        const JointConvention convention =
            trial % 4 < 2 ? JointConvention{.sign = {1, -1, -1}, .zero = {0, 0.25 * (trial % 8), 0}}
                          : JointConvention{};
        const auto context_of = [&](const RowPlan& chosen) -> RowContext {
            return {setup.plant, convention,
                    0.5,         static_cast<ContactMode>(trial % 4),
                    dense,       setup.controller(),
                    false,       controller_state,
                    1,           double(trial % 7 < 4),
                    0.0,         {},
                    0.0,         chosen};
        };
        const RowContext context = context_of(plan);
        RowBlock rows;
        rows.count = 1 + trial / 8 % rows_per_block;
        for (int i = 0; i < rows_per_block; ++i) rows.t[i] = 3.0 + 0.025 * std::min(i, rows.count - 1);
        fill_row_block(context, rows);

        Setup with_few_columns = setup;
        for (std::size_t c = 0; c < column_count; ++c) with_few_columns.logged[c] = random.in(0, 1) < 0.1;
        const RowPlan few = make_row_plan(with_few_columns, {}, trial % 3 == 0);
        RowBlock few_rows = rows;
        for (auto& column : few_rows.value) std::fill(std::begin(column), std::end(column), -1e300);
        fill_row_block(context_of(few), few_rows);

        int first_behind = rows.count;
        for (int i = 0; i < rows.count; ++i) {
            const double t = rows.t[i], theta = (t - dense.t0) / dense.h;
            const Row row = make_row(context, t, dense(theta), theta);
            for (const std::size_t c : plan.columns)
                CHECK(same_bits(row.value[c], rows.value[c][i]),
                      column_table[c].name << " of row " << i << ", trial " << trial);
            for (const std::size_t c : few.columns)
                CHECK(same_bits(row.value[c], few_rows.value[c][i]),
                      column_table[c].name << " among few, row " << i << ", trial " << trial);
            if (row.link_behind_wall) first_behind = std::min(first_behind, i);
        }
        CHECK(first_behind == rows.first_link_behind_wall);
        CHECK((first_behind == few_rows.first_link_behind_wall || trial % 3 != 0));
    }
}

TEST_SUITE_END()
