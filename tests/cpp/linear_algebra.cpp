#include "linear_algebra.hpp"

#include <Eigen/Eigenvalues>

namespace arm3r {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
    return Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues();
}

}  // namespace arm3r
