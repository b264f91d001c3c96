#include "linear_algebra.hpp"

#include <Eigen/Dense>

namespace arm3r {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
    return Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues();
}

namespace evaluated {

Vector::Vector(double x, double y, double z) : v(x, y, z) {}
Vector::Vector(const Vec3<double>& from) : v(from) {}
double Vector::operator[](int i) const { return v[i]; }
const double* Vector::data() const { return v.data(); }
double Vector::dot(const Vector& b) const { return v.dot(b.v); }
double Vector::norm() const { return v.norm(); }
Vector Vector::normalized() const { return {v.normalized()}; }

Matrix::Matrix(const Mat3<double>& from) : m(from) {}
double& Matrix::operator()(int i, int j) { return m(i, j); }
Matrix Matrix::transpose() const { return {m.transpose()}; }
Matrix Matrix::inverse() const { return {m.inverse()}; }

Vector operator-(const Vector& a) { return {-a.v}; }
Vector operator+(const Vector& a, const Vector& b) { return {a.v + b.v}; }
Vector operator-(const Vector& a, const Vector& b) { return {a.v - b.v}; }
Vector operator*(double a, const Vector& b) { return {a * b.v}; }
Vector operator*(const Vector& a, double b) { return {a.v * b}; }
Vector operator/(const Vector& a, double b) { return {a.v / b}; }
Matrix operator-(const Matrix& a) { return {-a.m}; }
Matrix operator+(const Matrix& a, const Matrix& b) { return {a.m + b.m}; }
Matrix operator-(const Matrix& a, const Matrix& b) { return {a.m - b.m}; }
Matrix operator*(const Matrix& a, double b) { return {a.m * b}; }
Matrix operator*(const Matrix& a, const Matrix& b) { return {a.m * b.m}; }
Vector operator*(const Matrix& a, const Vector& b) { return {a.m * b.v}; }

Matrix identity() { return {Mat3<double>::Identity()}; }
Matrix diagonal(const Vector& a) { return {a.v.asDiagonal()}; }
Matrix outer_product(const Vector& a, const Vector& b) { return {a.v * b.v.transpose()}; }
double distance(const Vector& a, const Vector& b) { return (a.v - b.v).cwiseAbs().maxCoeff(); }

PseudoInverse pseudo_inverse(const Matrix& a) {
    const Eigen::JacobiSVD<Mat3<double>> svd(a.m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Vec3<double> values = svd.singularValues();
    const auto large = values.array() > 1e-9 * values[0];
    const Vec3<double> inverse = large.select(values.cwiseInverse(), 0.0);
    return {{svd.matrixV() * inverse.asDiagonal() * svd.matrixU().transpose()}, int(large.count())};
}

}  // namespace evaluated
}  // namespace arm3r
