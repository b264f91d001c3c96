#include "validate/square_matrix.hpp"

#include <cmath>
#include <cstdint>

#include "arm3r/numbers/elementary.hpp"

namespace arm3r {

SquareMatrix identity(std::size_t n) {
    SquareMatrix one(n);
    for (std::size_t i = 0; i < n; ++i) one(i, i) = 1;
    return one;
}

SquareMatrix product(const SquareMatrix& a, const SquareMatrix& b) {
    SquareMatrix c(a.n);
    for (std::size_t i = 0; i < a.n; ++i)
        for (std::size_t k = 0; k < a.n; ++k) {
            const double factor = a(i, k);
            if (factor == 0) continue;
            for (std::size_t j = 0; j < a.n; ++j) c(i, j) += factor * b(k, j);
        }
    return c;
}

double norm(const SquareMatrix& a) {
    double largest = 0;
    for (std::size_t i = 0; i < a.n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < a.n; ++j) sum += std::abs(a(i, j));
        if (!(sum <= largest)) largest = sum;  // NaN too
    }
    return largest;
}

SquareMatrix exponential(const SquareMatrix& a, double h) {
    constexpr int terms = 18;
    int squarings = 0;
    for (double size = norm(a) * h; size > 0.5 && squarings < 60; size *= 0.5) ++squarings;
    SquareMatrix step = a;
    for (double& x : step.a) x *= h / double(std::uint64_t(1) << squarings);
    SquareMatrix sum = identity(a.n), term = sum;
    for (int k = 1; k <= terms; ++k) {
        term = product(term, step);
        for (double& x : term.a) x /= k;
        for (std::size_t i = 0; i < sum.a.size(); ++i) sum.a[i] += term.a[i];
    }
    for (int k = 0; k < squarings; ++k) sum = product(sum, sum);
    return sum;
}

double log_spectral_radius(SquareMatrix a, double enough) {
    constexpr int most = 26;      // squarings
    double total = 0, power = 1;  // ln of the norm of A^power is total + ln |a|
    for (int k = 0;; ++k) {
        const double size = norm(a);
        if (size == 0) return -infinite;
        total += log(size);
        if (total < 0 || total > enough || k == most || !std::isfinite(total)) return total / power;
        for (double& x : a.a) x /= size;
        a = product(a, a);
        total *= 2, power *= 2;
    }
}

}  // namespace arm3r
