#pragma once
// Linear algebra that is compiled once for all tests: each of Eigen's decompositions takes g++ ten seconds, and each
// formula in Eigen's expressions half of one.

#include <Eigen/Core>

#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);
double determinant(const Mat3<double>& A);
Vec3<double> cross_product(const Vec3<double>& a, const Vec3<double>& b);
Mat3<double> rotation(double angle, const Vec3<double>& axis);

// Vectors and matrices of three numbers; every operation is a function.
namespace evaluated {

struct Vector {
    Vec3<double> v;

    Vector() = default;
    Vector(double x, double y, double z);
    Vector(const Vec3<double>& from);
    operator const Vec3<double>&() const { return v; }
    double operator[](int i) const;
    const double* data() const;
    double dot(const Vector& b) const;
    double norm() const;
    Vector normalized() const;
};

struct Matrix {
    Mat3<double> m;

    Matrix() = default;
    Matrix(const Mat3<double>& from);
    double& operator()(int i, int j);
    Matrix transpose() const;
    Matrix inverse() const;
};

Vector operator-(const Vector& a);
Vector operator+(const Vector& a, const Vector& b);
Vector operator-(const Vector& a, const Vector& b);
Vector operator*(double a, const Vector& b);
Vector operator*(const Vector& a, double b);
Vector operator/(const Vector& a, double b);
Matrix operator-(const Matrix& a);
Matrix operator+(const Matrix& a, const Matrix& b);
Matrix operator-(const Matrix& a, const Matrix& b);
Matrix operator*(const Matrix& a, double b);
Matrix operator*(const Matrix& a, const Matrix& b);
Vector operator*(const Matrix& a, const Vector& b);

Matrix identity();
Matrix diagonal(const Vector& a);
Matrix outer_product(const Vector& a, const Vector& b);
double distance(const Vector& a, const Vector& b);

struct PseudoInverse {
    Matrix matrix;
    int rank;  // as many singular values as are at least 1e-9 of the largest
};
PseudoInverse pseudo_inverse(const Matrix& a);

}  // namespace evaluated
}  // namespace arm3r
