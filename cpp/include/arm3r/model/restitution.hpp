#pragma once
// The damping with which a mass leaves a contact at a given fraction e (restitution) of its impact speed; docs/model.md
// (4.12), (4.13).

#include "arm3r/numbers/real.hpp"

namespace arm3r {

// The zero of an f that decreases on [low, high], by bisection to the last bit.
template <class F>
double bisect(const F& f, double low, double high) {
    for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high))
        (f(middle) > 0 ? low : high) = middle;
    return high;
}

// acos(zeta)/sqrt(1 - zeta^2), continued beyond zeta = 1.
inline double damped_angle(double zeta) {
    const double z = (zeta - 1) / (zeta + 1);
    if (abs(z) < 0.01) {  // 2 artanh(sqrt(z))/(sqrt(z) (1 + zeta)), a series in z
        double sum = 0;
        for (int k = 8; k >= 0; --k) sum = sum * z + 1.0 / (2 * k + 1);
        return 2 * sum / (1 + zeta);
    }
    const double root = sqrt(abs(1 - zeta) * (1 + zeta));
    return (zeta < 1 ? acos(zeta) : log(zeta + root)) / root;
}

// zeta = c/(2 sqrt(k m)) of a Kelvin-Voigt contact for 0 < e <= 1 (4.12).
inline double damping_ratio_for(double e) {
    const double wanted = -log(e);
    const auto residual = [&](double zeta) { return wanted - 2 * zeta * damped_angle(zeta); };
    return wanted > 0 ? bisect(residual, 0.0, 1 / sqrt(e)) : 0;
}

// x - ln(1 + x).
inline double x_minus_log1p(double x) {
    if (abs(x) > 0.1) return x - log(1 + x);
    double sum = 0;
    for (int k = 20; k >= 2; --k) sum = 1.0 / k - x * sum;
    return x * x * sum;
}

// beta v of a Hunt-Crossley contact with impact speed v, for 0 < e <= 1 (4.13).
inline double hunt_crossley_number_for(double e) {
    const auto residual = [&](double y) { return x_minus_log1p(y) - x_minus_log1p(-e * y); };
    const double first_order = 1.5 * (1 - e);
    return first_order > 0 ? bisect(residual, 0.5 * first_order, 1 / e) : 0;
}

}  // namespace arm3r
