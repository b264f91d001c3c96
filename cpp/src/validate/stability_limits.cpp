#include "validate/stability_limits.hpp"

#include <algorithm>
#include <cmath>

namespace arm3r {

bool is_stable(double m, double b, double c, double d) {  // Routh
    return b > 0 && c > 0 && (d == 0 || b * c > m * d);
}

// (M s^2 + B s + K)(s^2 + 2 z w s + w^2) + k_e w^2: the stiffness at which the last but one Routh number is zero.
double admittance_limit(double M, double B, double K, double w, double z) {
    const double a4 = M, a3 = B + 2 * z * w * M, a2 = K + 2 * z * w * B + w * w * M, a1 = 2 * z * w * K + w * w * B;
    return (a3 * a2 * a1 - a4 * a1 * a1) / (a3 * a3 * w * w) - K;
}

// M s^3 + B s^2 + (K + k_e) s + K k_r k_e
double reference_gain_limit(double M, double B, double K, double k_e) { return B * (K + k_e) / (M * K * k_e); }

double max_period(double Kp, double Kd) { return std::min(2 * Kd / Kp, 2 / Kd); }

// M^-1 P = J^-1 A S J with A = J M^-1 J^-1 and S = E E^T, E any two directions across n: it shares its eigenvalues, but
// for a zero, with E^T A E.
double projected_mobility(const Arm<double>& arm, const Pose<double>& p, const Vec3<double>& n) {
    const Mat3<double> J = jacobian(arm, p), K = inverse_jacobian(arm, p), M = mass_matrix(arm, p);
    const double lower = M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2);
    const auto A = [&](const Vec3<double>& along) {
        const Vec3<double> v = times(K, along);
        if (arm.is_elbow) return times(J, elbow_arm::by_inverse_mass(arm, p, v));
        return times(J, Vec3<double>(v[0] / M(0, 0), (M(2, 2) * v[1] - M(1, 2) * v[2]) / lower,
                                     (M(1, 1) * v[2] - M(1, 2) * v[1]) / lower));
    };
    const Vec3<double> aside = std::abs(n[2]) < 0.9 ? Vec3<double>(0, 0, 1) : Vec3<double>(0, 1, 0);
    const Vec3<double> across = cross(n, aside), e1 = across / std::sqrt(dot(across, across)), e2 = cross(e1, n);
    const Vec3<double> A1 = A(e1), A2 = A(e2);
    const double half_trace = 0.5 * (dot(e1, A1) + dot(e2, A2));
    const double determinant = dot(e1, A1) * dot(e2, A2) - dot(e1, A2) * dot(e2, A1);
    const double discriminant = half_trace * half_trace - determinant;
    return discriminant > 0 ? half_trace - std::sqrt(discriminant) : half_trace;
}

}  // namespace arm3r
