#pragma once
// Eigen's decompositions, compiled once for all tests: each takes g++ ten seconds.

#include <Eigen/Core>

namespace arm3r {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

}  // namespace arm3r
