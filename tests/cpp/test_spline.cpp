#include <array>
#include <cmath>

#include "base/spline.hpp"
#include "check.hpp"

namespace arm3r {

TEST_SUITE(splines)

// scipy.interpolate.make_interp_spline(t, s, k=5) with first and second derivative 0 at both ends, its derivatives at t.
TEST_CASE(five_points_as_scipy_joins_them) {
    const std::array t{0.5, 1.1, 1.4, 2.9, 3.3}, s{0.2, -0.1, 0.4, 0.35, 1.3};
    std::array<double, 5> v, a;
    minimum_jerk_through(t, s, v, a);
    const std::array wanted_v{0.0, 7.480050417082027e-01, 1.794528013144971, 4.402397424249933, 0.0};
    const std::array wanted_a{0.0, 9.853141056976163, -4.811078086273149, -0.669041993392308, 0.0};
    for (std::size_t i = 0; i < t.size(); ++i) {
        CHECK(std::abs(v[i] - wanted_v[i]) < 1e-13);
        CHECK(std::abs(a[i] - wanted_a[i]) < 1e-12);
    }
}

TEST_CASE(sixteen_points_as_scipy_joins_them) {
    const std::array t{0.2170158759300675, 0.7287963637924619, 2.341281570944936,  3.5264975412704533,
                       3.7600483936392317, 4.654645927100356,  5.638795958474982,  6.000286842017285,
                       7.482712287265254,  7.75437272611199,   8.567267697578531,  9.624911053690191,
                       10.514635693497837, 11.70889290780221,  13.197676593021923, 15.112397739952314};
    const std::array s{0.48194538850678587,  -0.2385536065733667, 0.9577587029597641,  -0.19980212906658,
                       0.02425956507666462,  1.545820851212812,   0.5451055226876446,  -0.505228735614018,
                       -0.1828389745977349,  0.5405251317548021,  1.9350880340988528,  -0.2696203273419135,
                       -0.24355867907910456, 1.0023136012756912,  -0.8864599431605871, -0.291720232439864};
    const std::array wanted_v{0.0,
                              -2.5144340097211022,
                              0.42195238967223253,
                              0.40624898929010456,
                              1.4317382803649588,
                              0.98310488466455348,
                              -2.8220078395213402,
                              -2.7225739012916770,
                              2.5530175000829392,
                              2.7186553972940377,
                              -0.22531126530362885,
                              -1.8758826307811225,
                              1.4819710048027155,
                              -0.32503901054963402,
                              -0.68513754966046425,
                              0.0};
    const std::array wanted_a{0.0,
                              0.59188456971684111,
                              -6.0352492130136008,
                              5.2710534356436396,
                              3.2597858210687050,
                              -3.3734538522423385,
                              -1.8895993245085689,
                              2.4248372492334407,
                              1.1665134649477187,
                              -0.06148632761572588,
                              -6.2396071534457294,
                              4.1129356773851713,
                              1.5116255987192289,
                              -2.9608009075777488,
                              2.3768127185220300,
                              0.0};
    std::array<double, 16> v, a;
    minimum_jerk_through(t, s, v, a);
    for (std::size_t i = 0; i < t.size(); ++i) {
        CHECK(std::abs(v[i] - wanted_v[i]) < 1e-12);
        CHECK(std::abs(a[i] - wanted_a[i]) < 1e-12);
    }
}

TEST_CASE(two_points_are_joined_from_rest_to_rest) {
    const std::array t{1.0, 3.0}, s{0.2, -0.4};
    std::array v{9.0, 9.0}, a{9.0, 9.0};
    minimum_jerk_through(t, s, v, a);
    CHECK((v[0] == 0 && v[1] == 0 && a[0] == 0 && a[1] == 0));
}

TEST_CASE(points_of_one_minimum_jerk_motion_give_it_back) {
    const std::array t{1.0, 1.7, 2.2, 3.0};
    std::array<double, 4> s, v, a;
    const auto motion = [](double at) {
        const double x = (at - 1) / 2;
        return 0.3 + 0.8 * x * x * x * (10 + x * (6 * x - 15));
    };
    for (std::size_t i = 0; i < t.size(); ++i) s[i] = motion(t[i]);
    minimum_jerk_through(t, s, v, a);
    for (const std::size_t i : {1, 2}) {
        const double x = (t[i] - 1) / 2;
        CHECK(std::abs(v[i] - 0.8 / 2 * 30 * x * x * (1 - x) * (1 - x)) < 1e-13);
        CHECK(std::abs(a[i] - 0.8 / 4 * 60 * x * (1 - x) * (1 - 2 * x)) < 1e-12);
    }
}

TEST_SUITE_END()

}  // namespace arm3r
