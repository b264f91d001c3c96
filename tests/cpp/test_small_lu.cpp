#include "arm3r/numbers/small_lu.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "linear_algebra.hpp"

namespace arm3r {

TEST_SUITE(small_lu)

constexpr std::size_t most = 18;
using Vector = std::array<double, most>;

// Memory beyond n must not be read.
static SmallLu<most> filled(const Eigen::MatrixXd& m) {
    SmallLu<most> lu;
    lu.n = std::size_t(m.rows());
    for (auto& row : lu.a) row.fill(std::nan(""));
    for (Eigen::Index i = 0; i < m.rows(); ++i)
        for (Eigen::Index j = 0; j < m.cols(); ++j) lu.a[std::size_t(i)][std::size_t(j)] = m(i, j);
    return lu;
}

static Eigen::MatrixXd random_matrix(Random& random, Eigen::Index n) {
    return Eigen::MatrixXd::NullaryExpr(n, n, [&] { return random.in(-1, 1); });
}

static double miss(const Eigen::MatrixXd& m, Random& random) {
    const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(m.rows(), [&] { return random.in(-1, 1); }), b = m * x;
    SmallLu<most> lu = filled(m);
    REQUIRE(lu.factorise());
    Vector solution;
    solution.fill(std::nan(""));
    std::copy(b.data(), b.data() + b.size(), solution.begin());
    lu.solve(solution);
    return (Eigen::Map<Eigen::VectorXd>(solution.data(), m.rows()) - x).cwiseAbs().maxCoeff();
}

TEST_CASE(solves_what_was_multiplied) {
    Random random(71);
    for (Eigen::Index n = 1; n <= Eigen::Index(most); ++n) {
        for (int i = 0; i < 100; ++i) {
            const Eigen::MatrixXd m = random_matrix(random, n);
            CHECK(miss(m, random) <= 1e-14 * m.norm() * inverse(m).norm());
        }
    }
}

// Zeros and tiny numbers on the diagonal: without an exchange of rows nothing would be left.
TEST_CASE(exchanges_rows) {
    Random random(72);
    Eigen::MatrixXd cyclic = Eigen::MatrixXd::Zero(6, 6);
    for (Eigen::Index i = 0; i < 6; ++i) cyclic(i, (i + 2) % 6) = double(i + 1);
    CHECK(miss(cyclic, random) <= 1e-15);
    for (int i = 0; i < 100; ++i) {
        Eigen::MatrixXd m = random_matrix(random, 6);
        m.diagonal() *= 1e-14;
        CHECK(miss(m, random) <= 1e-14 * m.norm() * inverse(m).norm());
    }
}

TEST_CASE(refuses_what_is_singular_or_not_finite) {
    Random random(73);
    Eigen::MatrixXd twice = Eigen::MatrixXd::NullaryExpr(5, 5, [&] { return std::round(random.in(-9, 9)); });
    twice.row(3) = twice.row(1);
    CHECK(!filled(twice).factorise());
    CHECK(!filled(Eigen::MatrixXd::Zero(3, 3)).factorise());
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        for (Eigen::Index place = 0; place < 25; ++place) {
            Eigen::MatrixXd m = random_matrix(random, 5);
            m(place) = bad;
            CHECK(!filled(m).factorise(), bad << " at " << place);
        }
        Eigen::MatrixXd upper = Eigen::MatrixXd::Identity(3, 3);
        upper(0, 2) = bad;
        CHECK(!filled(upper).factorise(), bad << " beside zeros");
    }
}

TEST_SUITE_END()

}  // namespace arm3r
