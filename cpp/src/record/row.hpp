#pragma once
// One row: everything about one instant, from t and the state at that instant alone. Nothing is remembered.

#include <algorithm>
#include <array>

#include "arm3r/numbers/polynomial.hpp"
#include "arm3r/plant.hpp"
#include "contact/contact_mode.hpp"
#include "control/sampled_controller.hpp"
#include "integrate/dense_output.hpp"

namespace arm3r {

// As it goes out: without negative zeros.
inline std::array<double, 3> plain(const Vec3<double>& v) { return {v[0] + 0.0, v[1] + 0.0, v[2] + 0.0}; }

struct Energies {
    double kinetic, potential, contact;  // J
    double sum() const { return kinetic + potential + contact; }
};

Energies energies(const Plant<double>& plant, double t, const FullState& y, Mode mode);

// What the balance leaves over (4.9).
template <class T>
ARM3R_INLINE T energy_residual(const State<T, full_size>& y, const T& energy, double energy_at_start) {
    return (energy - energy_at_start) - (y[work_of_actuators] + y[work_of_wall] - y[dissipated]);
}

// J since the start: the dissipated energy in parts (4.9). `at_edges` is known from the changes of contact.
template <class P, class T>
ARM3R_INLINE std::array<T, 4> dissipated_parts(const Plant<P>& plant, const State<T, full_size>& y, double at_edges) {
    const T joints = y[dissipated_in_joints], friction = y[dissipated_in_friction], edges(at_edges);
    const T contact = dissipates_in_contact(plant) ? T(y[dissipated] - joints - friction - edges) : T(0.0);
    return {joints, contact, friction, edges};
}

// The columns of columns.cpp in their order, wall columns included; joint vectors in the convention of the faces.
constexpr std::size_t column_count = 72, residual_column = 45, parts_column = 68;

struct Row {
    std::array<double, column_count> value;
    bool link_behind_wall;  // the elbow, or a link that is not in contact itself, lies behind the plate
};

// What all rows within a step have in common.
struct Scene {
    const Plant<double>& plant;
    bool simscape;
    double energy_at_start;
    Mode mode;
    const Inside& inside;  // the tip position is differentiated along it (5.4)
    const Controller<double>& law;
    bool is_sampled;              // the law is a digital controller's
    const Known<double>& known;   // to it
    double contact, force_phase;  // to a continuous one
    double lost_at_edges;         // J, so far
};

// `theta` is where t lies within the step.
Row sample(const Scene& scene, double t, const FullState& y, double theta);

// Eight rows on the solution within the step, side by side: value[column][row], the same bits as one by one.
constexpr int together = 8;

struct RowBlock {
    alignas(64) double value[column_count][together];
    int first_link_behind_wall;  // the row where Row::link_behind_wall first holds; `together` for none
};

void sample_together(const Scene& scene, const double* t, RowBlock& rows);

}  // namespace arm3r
