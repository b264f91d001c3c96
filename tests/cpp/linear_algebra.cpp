#include "linear_algebra.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <utility>

namespace arm3r {
namespace {

// A with zeros below its first subdiagonal, by rotations of two rows and columns, which keep eigenvalues.
Eigen::MatrixXd hessenberg_form(Eigen::MatrixXd A) {
    for (Eigen::Index column = 0; column + 2 < A.cols(); ++column) {
        for (Eigen::Index i = A.rows() - 1; i > column + 1; --i) {
            Eigen::JacobiRotation<double> rotation;
            rotation.makeGivens(A(i - 1, column), A(i, column));
            A.applyOnTheLeft(i - 1, i, rotation.adjoint());
            A.applyOnTheRight(i - 1, i, rotation);
            A(i, column) = 0;
        }
    }
    return A;
}

}  // namespace

// From Eigen's Schur form: its EigenSolver takes g++ twice the time and memory.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
    Eigen::RealSchur<Eigen::MatrixXd> schur(A.rows());
    const Eigen::MatrixXd none;
    const Eigen::MatrixXd& T = schur.computeFromHessenberg(hessenberg_form(A), none, false).matrixT();
    if (schur.info() != Eigen::Success)
        throw std::runtime_error("no Schur form: does the matrix have a value that is not finite?");
    Eigen::VectorXcd values = T.diagonal().cast<std::complex<double>>();
    for (Eigen::Index i = 0; i + 1 < T.rows(); ++i) {  // a block of two rows holds a pair
        if (T(i + 1, i) == 0) continue;
        const double mean = (T(i, i) + T(i + 1, i + 1)) / 2, half = (T(i, i) - T(i + 1, i + 1)) / 2;
        const std::complex<double> root = std::sqrt(std::complex<double>(half * half + T(i, i + 1) * T(i + 1, i)));
        values[i] = mean + root;
        values[i + 1] = mean - root;
    }
    return values;
}

// By Gauss and Jordan, on (A, identity): Eigen's decomposition takes g++ three seconds.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) {
    const Eigen::Index n = A.rows();
    Eigen::MatrixXd both(n, 2 * n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) both(i, j) = A(i, j), both(i, n + j) = i == j;
    for (Eigen::Index step = 0; step < n; ++step) {
        Eigen::Index pivot = step;
        for (Eigen::Index i = step + 1; i < n; ++i)
            if (std::abs(both(i, step)) > std::abs(both(pivot, step))) pivot = i;
        const double divisor = both(pivot, step);
        for (Eigen::Index j = 0; j < 2 * n; ++j) {
            std::swap(both(pivot, j), both(step, j));
            both(step, j) /= divisor;
        }
        for (Eigen::Index i = 0; i < n; ++i) {
            const double factor = both(i, step);
            if (i == step) continue;
            for (Eigen::Index j = 0; j < 2 * n; ++j) both(i, j) -= factor * both(step, j);
        }
    }
    return both.rightCols(n);
}

double determinant(const Mat3<double>& A) { return A.determinant(); }
Vec3<double> cross_product(const Vec3<double>& a, const Vec3<double>& b) { return a.cross(b); }
Mat3<double> rotation(double angle, const Vec3<double>& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
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
    const Eigen::JacobiSVD<Mat3<double>, Eigen::NoQRPreconditioner> svd(a.m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Vec3<double> values = svd.singularValues();
    const auto large = values.array() > 1e-9 * values[0];
    const Vec3<double> inverse = large.select(values.cwiseInverse(), 0.0);
    return {{svd.matrixV() * inverse.asDiagonal() * svd.matrixU().transpose()}, int(large.count())};
}

}  // namespace evaluated
}  // namespace arm3r
