#pragma once
// One row: everything about one instant, from t and the state at that instant alone. Nothing is remembered.

#include <array>

#include "arm3r/plant.hpp"

namespace arm3r {

enum class Mode { free, contact, embedded };  // embedded: behind the plate without having come through its face (4.8)

using FullState = State<double, state_size>;
using Inside = Interpolant<double, state_size>;

inline Vec3<double> angles(const FullState& y) { return {y[0], y[1], y[2]}; }
inline Vec3<double> rates(const FullState& y) { return {y[3], y[4], y[5]}; }

struct Energies {
    double kinetic, potential, contact;  // J
    double sum() const { return kinetic + potential + contact; }
};

Energies energies(const Plant<double>& plant, double t, const FullState& y, Mode mode);

// What the balance leaves over (4.9).
double energy_residual(const FullState& y, double energy, double energy_at_start);

// The columns of columns.cpp in their order, wall columns included; joint vectors in the convention of the faces.
struct Row {
    std::array<double, 46> value;
    bool link_behind_wall;  // the elbow, or a link that is not in contact itself, lies behind the plate
};

// `theta` is where t lies within `inside`, along which the tip position is differentiated (5.4).
Row sample(const Plant<double>& plant, bool simscape, double t, const FullState& y, Mode mode, double energy_at_start,
           const Inside& inside, double theta);

}  // namespace arm3r
