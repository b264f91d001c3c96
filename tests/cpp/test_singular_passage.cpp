#include "run/singular_passage.hpp"

#include "check.hpp"
#include "fixtures.hpp"

namespace arm3r {

TEST_SUITE(singular_passage)

namespace {

// A step in which every component moves as a random polynomial: of an interpolant, or of a series.
DenseOutput random_step(Random& random, double size) {
    DenseOutput dense;
    dense.h = random.in(0.01, 0.3);
    dense.order = random.in(0, 1) < 0.5 ? -1 : 6;
    for (FullState& c : dense.c)
        for (std::size_t i = 0; i < motion_size; ++i) c[i] = random.in(-size, size);
    for (std::size_t i = 0; i < 3; ++i) dense.c[0][i] = random.in(-1.5, 1.5);
    return dense;
}

}  // namespace

TEST_CASE(no_component_changes_by_more_than_its_bound) {
    Random random(5);
    for (int n = 0; n < 400; ++n) {
        const DenseOutput dense = random_step(random, 2);
        for (std::size_t i = 0; i < motion_size; ++i) {
            double most = 0;
            for (int k = 0; k <= 50; ++k)
                most = std::max(most, std::abs(dense.component(i, k / 50.0) - dense.component(i, 0.0)));
            CHECK(most <= dense.most_change(i));
        }
    }
}

TEST_CASE(the_first_passage_is_that_of_a_close_look) {
    Random random(6);
    int passages = 0, none = 0;
    for (int n = 0; n < 2000; ++n) {
        const Arm<double> arm = (n % 2 ? random_elbow_params(random) : random_params(random)).arm();
        const DenseOutput dense = random_step(random, random.in(0, 1) < 0.5 ? 0.05 : 1.0);
        const auto pose_at = [&](double theta) { return pose(angles(dense.motion(theta))); };
        const auto factors = [&](double theta) {
            return std::array{sine_of_bend(arm, pose_at(theta)), radius(arm, pose_at(theta)) / reach(arm)};
        };
        constexpr int looks = 500;
        const auto start = factors(0);
        std::optional<double> seen;
        for (int k = 1; k <= looks && !seen; ++k) {
            const auto here = factors(k / double(looks));
            if (start[0] * here[0] < 0 || start[1] * here[1] < 0) seen = k / double(looks);
        }
        const std::optional<double> found = first_passage(arm, dense, 1);
        if (seen) {
            CHECK(found.has_value());
            CHECK(*found <= *seen);
            CHECK(*found >= *seen - 1.01 / looks);
        }
        ++(found ? passages : none);
    }
    CHECK(passages > 100);
    CHECK(none > 500);
}

TEST_SUITE_END()

}  // namespace arm3r
