#include <boost/test/unit_test.hpp>

#include "fixtures.hpp"
#include "record/row.hpp"

using namespace arm3r;

BOOST_AUTO_TEST_SUITE(sample_rows)

// Rows taken eight at once, in whatever instruction set, are those taken one by one.
BOOST_AUTO_TEST_CASE(eight_rows_together_are_the_same_bits_as_one_by_one) {
    Random random(7);
    for (int trial = 0; trial < 200; ++trial) {
        Params params = random_params(random);
        params.set("wall", 1).set("wall.point", random.vector(-1, 1)).set("wall.normal", random.vector(-1, 1));
        params.choose("wall.motion.type", "sinusoid")
            .set("wall.motion.amplitude", 0.1)
            .set("wall.motion.frequency", 2)
            .set("wall.motion.phase", 1);
        params.set("wall.acts_on_arm", trial % 2)
            .choose("controller.type", trial % 3 ? "gravity_compensation" : "none");
        params.choose("controller.algorithm", trial % 5 ? "closed_form" : "recursion");
        const char* const laws[] = {"hybrid", "admittance", "computed_torque", "energy_tank", "adaptive_reference"};
        const bool has_law = trial % 2;
        if (has_law) params.choose("controller.type", laws[trial / 2 % 5]).set("observer", trial % 4 == 1);
        const Setup setup = make_setup(params);

        FullState y0, f0, y1, f1;
        for (FullState* state : {&y0, &f0, &y1, &f1})
            for (double& x : *state) x = random.in(-2, 2);
        DenseOutput dense;
        dense.assign(hermite(3.0, 0.2, y0, f0, y1, f1));
        const ControllerState<double> controller_state{};
        const RowPlan plan = make_row_plan(setup, {});
        const RowContext context{setup.plant, trial % 4 < 2,         0.5,   static_cast<ContactMode>(trial % 4),
                                 dense,       setup.controller(),    false, controller_state,
                                 1,           double(trial % 7 < 4), 0.0,   plan};
        RowBlock rows;
        rows.count = 1 + trial / 8 % rows_per_block;
        for (int i = 0; i < rows_per_block; ++i) rows.t[i] = 3.0 + 0.025 * std::min(i, rows.count - 1);
        fill_row_block(context, rows);
        int first_behind = rows.count;
        for (int i = 0; i < rows.count; ++i) {
            const double t = rows.t[i], theta = (t - dense.t0) / dense.h;
            const Row row = make_row(context, t, dense(theta), theta);
            for (const std::size_t c : plan.columns)
                BOOST_TEST(same_bits(row.value[c], rows.value[c][i]),
                           column_table[c].name << " of row " << i << ", trial " << trial);
            if (row.link_behind_wall) first_behind = std::min(first_behind, i);
        }
        BOOST_TEST(first_behind == rows.first_link_behind_wall);
    }
}

BOOST_AUTO_TEST_SUITE_END()
