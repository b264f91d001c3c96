#pragma once
// Square matrices whose size is known when they are made: products, the exponential, and how fast powers grow.

#include <cstddef>
#include <vector>

namespace arm3r {

struct SquareMatrix {
    std::size_t n;
    std::vector<double> a;  // row by row

    explicit SquareMatrix(std::size_t size) : n(size), a(size * size) {}
    double& operator()(std::size_t i, std::size_t j) { return a[i * n + j]; }
    double operator()(std::size_t i, std::size_t j) const { return a[i * n + j]; }
};

SquareMatrix identity(std::size_t n);
SquareMatrix product(const SquareMatrix& a, const SquareMatrix& b);
double norm(const SquareMatrix& a);  // the largest sum of the sizes of a row

// e^(h A), by a Taylor series of e^(h A / 2^s) and s squarings.
SquareMatrix exponential(const SquareMatrix& a, double h);

// ln of the spectral radius, from the norm of A^(2^k); where that shows that the radius is below 1, an upper bound that is
// below 0. Powers that grow no faster than k^p come out as less than p 1e-6. It stops
// when ln of the norm is `enough`, beside which that of a condition number is small.
double log_spectral_radius(SquareMatrix a, double enough = 500);

}  // namespace arm3r
