#pragma once
// One row: everything about one instant, from t and the state at that instant alone. Nothing is remembered.

#include <algorithm>
#include <array>

#include "arm3r/plant.hpp"
#include "arm3r/polynomial.hpp"
#include "control_loop.hpp"

namespace arm3r {

enum class Mode {  // (4.8)
    free,
    contact,
    separated,  // inside a wall that would have to pull to follow the tip
    embedded,   // behind the plate without having come through its face
};

// What the column `contact` tells, and what begins and ends with events.
inline bool is_touching(Mode mode) { return mode == Mode::contact || mode == Mode::separated; }

inline constexpr double smallest_rate = 1e-140;  // rad/s: below it products would be subnormal, and slow

// With room for a controller's memory, whether there is one or not.
using FullState = State<double, full_size>;

// The solution within a step, for any method: an interpolant, or a power series in the seconds since its begin.
struct Inside {
    double t0 = 0, h = 0;
    int order = -1;                 // of the series; < 0: an interpolant
    std::size_t size = state_size;  // components that there are
    std::array<FullState, most_degree + 1> c;

    template <std::size_t N>
    void take(const Interpolant<double, N>& from) {
        t0 = from.t0;
        h = from.h;
        order = -1;
        size = N;
        for (std::size_t i = 0; i < from.c.size(); ++i) std::copy(from.c[i].begin(), from.c[i].end(), c[i].begin());
    }

    // One component at theta, the share of the step: at one instant or at several side by side.
    template <class S>
    ARM3R_INLINE S component(std::size_t i, const S& theta) const {
        return order < 0 ? interpolated(c, i, theta) : summed(i, S(theta * h));
    }

    FullState operator()(double theta) const {
        FullState y{};
        for (std::size_t i = 0; i < size; ++i) y[i] = component(i, theta);
        return y;
    }

private:
    template <class S>
    ARM3R_INLINE S summed(std::size_t i, const S& seconds) const {
        S sum(c[order][i]);
        for (int k = order - 1; k >= 0; --k) sum = sum * seconds + c[k][i];
        return sum;
    }
};

// As it goes out: without negative zeros.
inline std::array<double, 3> plain(const Vec3<double>& v) { return {v[0] + 0.0, v[1] + 0.0, v[2] + 0.0}; }

inline Vec3<double> angles(const FullState& y) { return {y[0], y[1], y[2]}; }
inline Vec3<double> rates(const FullState& y) { return {y[3], y[4], y[5]}; }

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
