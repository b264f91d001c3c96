#pragma once
// A few linear equations, how many is known when they are solved: LU with partial pivoting, sums in a fixed order.

#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "arm3r/numbers/primitives.hpp"

namespace arm3r {

// Fill n and a, row by row, then factorise() it in place; after that solve() takes any number of right-hand sides.
template <std::size_t Most>
struct SmallLu {
    using Rows = std::array<std::size_t, Most>;

    std::size_t n = 0;
    std::array<std::array<double, Most>, Most> a;

    // False where the matrix is singular or not finite.
    bool factorise() {
        for (std::size_t k = 0; k < n; ++k) {
            if (!raise_pivot(k)) return false;
            a[k][k] = 1.0 / a[k][k];
            for (std::size_t i = k + 1; i < n; ++i) {
                const double l = a[i][k] * a[k][k];
                a[i][k] = l;
                for (std::size_t j = k + 1; j < n; ++j) a[i][j] -= l * a[k][j];
            }
        }
        return true;
    }

    void solve(std::array<double, Most>& x) const {
        for (std::size_t k = 0; k < n; ++k) std::swap(x[k], x[raised_[k]]);
        substitute(a, x, n);
    }
    // Which row became the k-th.
    const Rows& raised() const { return raised_; }

    // Solves n equations whose factors are known, and whose right-hand sides stand in the order of the raised rows.
    template <class T>
    ARM3R_INLINE static void substitute(const std::array<std::array<T, Most>, Most>& factors, std::array<T, Most>& x,
                                        std::size_t n) {
        for (std::size_t i = 1; i < n; ++i)
            for (std::size_t j = 0; j < i; ++j) x[i] = x[i] - factors[i][j] * x[j];
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t j = i + 1; j < n; ++j) x[i] = x[i] - factors[i][j] * x[j];
            x[i] = x[i] * factors[i][i];  // the reciprocal of the pivot
        }
    }

private:
    // NaN loses every comparison and spreads to a column without a pivot.
    bool raise_pivot(std::size_t k) {
        double largest = 0;
        for (std::size_t i = k; i < n; ++i) {
            if (!(abs(a[i][k]) > largest)) continue;
            largest = abs(a[i][k]);
            raised_[k] = i;
        }
        if (!(largest > 0 && largest < infinite)) return false;
        std::swap(a[k], a[raised_[k]]);
        return true;
    }

    Rows raised_;
};

}  // namespace arm3r
