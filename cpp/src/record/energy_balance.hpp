#pragma once
// The energy balance of a run and its evaluation; docs/model.md (4.9).

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "arm3r/numbers/lane_access.hpp"
#include "record/row.hpp"
#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// What the balance of a run is judged by, J: the largest energy throughput and residual so far; the scale of the rounding
// errors of a step, which is the largest energy of motion and of the contact, and what the weight can do over the reach
// of the arm; the largest forces times that reach, by which a rounding error of the position becomes an energy; the steps,
// and the errors that the method estimated of them, added up in units of its tolerance; and the inertia of links 2 and 3,
// kg m^2. None of them knows where an energy, a height or a time is zero.
struct EnergyTotals {
    double throughput = 0, residual = 0, scale = 0, force_times_reach = 0, steps = 0, errors = 0, inertia = 0;
};

// The limit of the residual at the end, and whether a larger one is an outcome of the run or only a warning.
double balance_limit(const Solver& solver, const EnergyTotals& totals);
bool is_strict(const Solver& solver);

// The message if the balance is not closed, or nothing.
std::optional<std::string> balance_error(const Solver& solver, const EnergyTotals& totals);

// Of every lane.
template <class T>
class EnergyBalance {
public:
    void start(int lane, const Energies<double>& energies) {
        const auto set = [lane](T& x, double value) { Lanes<T>::set(x, lane, value); };
        set(energy_at_start_, energies.sum());
        set(potential_at_start_, energies.potential);
        set(residual_, 0), set(throughput_, 0), set(errors_, 0);
        set(stored_, energies.kinetic + energies.contact);
    }

    // Updates the residual and the maxima after each step, or where there was one.
    template <std::size_t N>
    ARM3R_INLINE void update_where(const typename Lanes<T>::Mask& here, const Energies<T>& now, const State<T, N>& y) {
        if (in_all_lanes(here)) return update(now, y);
        const EnergyBalance before = *this;
        update(now, y);
        residual_ = select(here, residual_, before.residual_);
        throughput_ = select(here, throughput_, before.throughput_);
        stored_ = select(here, stored_, before.stored_);
    }
    template <std::size_t N>
    ARM3R_INLINE void update(const Energies<T>& now, const State<T, N>& y) {
        const T residual = energy_residual(y, now.sum(), energy_at_start_);
        residual_ = max(residual_, select(residual == residual, abs(residual), T(infinite)));
        const T works = max(abs(y[work_of_actuators]), max(abs(y[work_of_wall]), abs(y[dissipated])));
        throughput_ = max(max(throughput_, works), max(now.kinetic, abs(now.potential - potential_at_start_)));
        stored_ = max(stored_, T(now.kinetic + now.contact));
    }

    // error: what the method estimates of the step that was taken, in units of its tolerance.
    ARM3R_INLINE void add_error_where(const typename Lanes<T>::Mask& here, const T& error) {
        errors_ = errors_ + select(here, error, T(0.0));
    }

    double energy_at_start(int lane) const { return Lanes<T>::get(energy_at_start_, lane); }  // J
    // peak_force: N, of the wall.
    EnergyTotals totals(int lane, const Plant<double>& plant, double peak_force, double steps) const {
        return {.throughput = Lanes<T>::get(throughput_, lane),
                .residual = Lanes<T>::get(residual_, lane),
                .scale = Lanes<T>::get(stored_, lane) + weight_times_reach(plant.arm),
                .force_times_reach = largest_force(plant, peak_force) * reach(plant.arm),
                .steps = steps,
                .errors = Lanes<T>::get(errors_, lane),
                .inertia = plant.arm.lumped.B2 + plant.arm.lumped.B3};
    }

private:
    static double largest_force(const Plant<double>& plant, double peak_force) {
        const Vec3<double>& push = plant.external_force.force;
        return (plant.acts_on_arm ? peak_force : 0) + (plant.external_force.on ? std::sqrt(dot(push, push)) : 0);
    }

    T energy_at_start_{0.0}, potential_at_start_{0.0}, residual_{0.0}, throughput_{0.0}, stored_{0.0}, errors_{0.0};
};

// A residual that is NaN counts as infinite.
inline void include_residual(double& largest, double residual) {
    const double size = std::isnan(residual) ? infinite : std::abs(residual);
    largest = std::max(largest, size);
}

}  // namespace arm3r
