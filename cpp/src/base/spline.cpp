#include "base/spline.hpp"

#include <vector>

namespace arm3r {
namespace {

// Velocity and acceleration at one point, or the right-hand side for them.
struct Pair {
    double v, a;
};

struct Block {  // of the matrix: rows and columns v, a
    double vv, va, av, aa;
};

Pair times(const Block& B, const Pair& x) { return {B.vv * x.v + B.va * x.a, B.av * x.v + B.aa * x.a}; }
Pair minus(const Pair& x, const Pair& y) { return {x.v - y.v, x.a - y.a}; }

Block transposed(const Block& B) { return {B.vv, B.av, B.va, B.aa}; }

Block inverse(const Block& B) {
    const double det = B.vv * B.aa - B.va * B.av;
    return {B.aa / det, -B.va / det, -B.av / det, B.vv / det};
}

Block times(const Block& A, const Block& B) {
    return {A.vv * B.vv + A.va * B.av, A.vv * B.va + A.va * B.aa, A.av * B.vv + A.aa * B.av, A.av * B.va + A.aa * B.aa};
}

Block minus(const Block& A, const Block& B) { return {A.vv - B.vv, A.va - B.va, A.av - B.av, A.aa - B.aa}; }

// The jumps of the fourth and third derivative at a point as a function of v, a at this point: l and r are the
// intervals before and after it.
Block own(double l, double r) {
    const double mixed = 36 / (r * r) - 36 / (l * l);
    return {192 / (l * l * l) + 192 / (r * r * r), mixed, mixed, 9 / l + 9 / r};
}

// The same as a function of v, a at the point before it.
Block of_before(double l) { return {168 / (l * l * l), 24 / (l * l), -24 / (l * l), -3 / l}; }

Pair asked(double l, double before, double r, double after) {
    return {360 * (before / (l * l * l * l) + after / (r * r * r * r)),
            60 * (after / (r * r * r) - before / (l * l * l))};
}

}  // namespace

// Symmetric and positive definite: elimination from the front, block by block.
void minimum_jerk_through(std::span<const double> t, std::span<const double> s, std::span<double> v,
                          std::span<double> a) {
    const std::size_t last = t.size() - 1;
    std::vector<Block> inverses(last);
    std::vector<Pair> rest(last);
    for (std::size_t i = 1; i < last; ++i) {
        const double l = t[i] - t[i - 1], r = t[i + 1] - t[i];
        Block diagonal = own(l, r);
        rest[i] = asked(l, s[i] - s[i - 1], r, s[i + 1] - s[i]);
        if (i > 1) {
            const Block factor = times(of_before(l), inverses[i - 1]);
            diagonal = minus(diagonal, times(factor, transposed(of_before(l))));
            rest[i] = minus(rest[i], times(factor, rest[i - 1]));
        }
        inverses[i] = inverse(diagonal);
    }
    Pair next{0, 0};
    v[last] = a[last] = v[0] = a[0] = 0;
    for (std::size_t i = last - 1; i > 0; --i) {
        const double r = t[i + 1] - t[i];
        next = times(inverses[i], minus(rest[i], times(transposed(of_before(r)), next)));
        v[i] = next.v, a[i] = next.a;
    }
}

void move_with_minimum_jerk(QuinticTable<double>& table) {
    table.set_knots(table.t.size());
    minimum_jerk_through(table.t, table.s, table.v, table.a);
}

}  // namespace arm3r
