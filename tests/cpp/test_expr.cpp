#include <bit>
#include <random>

#include "arm3r/numbers/eigen_traits.hpp"
#include "check.hpp"

namespace arm3r {

TEST_SUITE(expr)

// Every operation that can be recorded.
template <class T>
static Eigen::Matrix<T, 3, 1> formula(const T& x, const T& y) {
    const auto [s, c] = sincos(x * y);
    const T bent = select((x < y || !(x <= -y)) && x != T(0.0), tanh(x - 0.5), atan2(y, -x));
    const T clamped = min(max(s, T(-0.5)), abs(c)) + copysign(sqrt(abs(x)), y);
    Eigen::Matrix<T, 3, 3> m = Eigen::Matrix<T, 3, 3>::Identity() * 2.0;
    m(0, 1) = bent;
    m(2, 0) = acos(c) / (2.0 + s);
    m(2, 1) = exp(x) - log(abs(y)) * power(abs(y), x) + power(abs(x), 1.5);
    return m * Eigen::Matrix<T, 3, 1>(clamped, hypot2(x, y), T(1.0)) + 0.5 * m.col(1);
}

struct Recording {
    Tape tape;
    Recording() {
        const Expr x = tape.input(), y = tape.input();
        for (const Expr& result : formula(x, y)) tape.output(result);
    }
};

static bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

TEST_CASE(plays_back_to_the_bits_of_the_formula_itself) {
    const Recording recording;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-3.0, 3.0);
    for (int i = 0; i < 2000; ++i) {
        Pack<4> in[2], out[3];
        for (int lane = 0; lane < 4; ++lane)
            for (Pack<4>& x : in) x.set(lane, unit(random));
        recording.tape.play<Pack<4>>(in, out);
        for (int lane = 0; lane < 4; ++lane) {
            const double numbers[] = {in[0][lane], in[1][lane]};
            double played[3];
            recording.tape.play<double>(numbers, played);
            const auto direct = formula(numbers[0], numbers[1]);
            for (int k = 0; k < 3; ++k)
                REQUIRE((same_bits(played[k], direct[k]) && same_bits(out[k][lane], direct[k])));
        }
    }
}

TEST_CASE(plays_with_derivatives) {
    const Recording recording;
    const Dual<2> in[] = {Dual<2>::variable(0.3, 0), Dual<2>::variable(0.7, 1)};
    Dual<2> out[3];
    recording.tape.play<Dual<2>>(in, out);
    const auto direct = formula(in[0], in[1]);
    for (int k = 0; k < 3; ++k) CHECK(out[k].slope == direct[k].slope);
}

TEST_CASE(an_equal_expression_is_recorded_once) {
    Tape tape;
    const Expr x = tape.input(), y = tape.input();
    tape.output((x + y) * (x + y));
    CHECK(tape.count(Op::input) == 2);
    CHECK(tape.count(Op::add) == 1);
    CHECK(tape.count(Op::multiply) == 1);
    CHECK(tape.nodes().size() == 4u);
}

TEST_CASE(constants_are_computed_at_once_and_signed_zeros_kept_apart) {
    Tape tape;
    const Expr x = tape.input();
    tape.output(x + sqrt(Expr(4.0)) * 3.0);
    tape.output(copysign(x, 0.0));
    tape.output(copysign(x, -0.0));
    CHECK(tape.count(Op::sqrt) == 0);
    CHECK(tape.count(Op::constant) == 3);
    double out[3];
    tape.play<double>(std::array{1.0}, out);
    CHECK(out[0] == 7.0);
    CHECK(out[1] == 1.0);
    CHECK(out[2] == -1.0);
}

TEST_CASE(sincos_near_records_the_full_sine) {
    Tape tape;
    const Expr x = tape.input();
    tape.output(sincos_near(Expr(x - 0.01), sincos(Expr(x - 0.01)), x).sin);
    double out[1];
    tape.play<double>(std::array{0.4}, out);
    CHECK(out[0] == sincos(0.4).sin);
}

TEST_CASE(wrong_use_is_refused) {
    Tape one, other;
    CHECK_THROWS(one.input() + other.input(), std::invalid_argument);
    double none[1];
    CHECK_THROWS(one.play<double>({}, none), std::invalid_argument);
}

TEST_SUITE_END()

}  // namespace arm3r
