#pragma once
// The summary numbers of a run, in a single run's summary and as a row of a batch's table.

#include <string_view>
#include <vector>

#include "record/contact_tally.hpp"
#include "record/row.hpp"
#include "setup/metric_groups.hpp"

namespace arm3r {

struct SummaryNumber {
    std::string_view name, unit, meaning;
    double (*of)(const Metrics&);  // NaN: the run has no such number
    MetricGroup group = MetricGroup::others;
};

// Writes the numbers of a run that its end tells: the state `y` at t, and the contacts with the peak of the force.
void set_end_values(const Setup& setup, double t, const FullState& y, bool is_touching, const ContactTally& contacts,
                    const Peak& peak, Metrics& metrics);

// The same of what the estimator tells in a lane that is in contact at the end.
template <class T>
void set_estimate(const ControllerState<T>& state, int lane, Metrics& metrics) {
    const auto get = [lane](const T& x) { return Lanes<T>::get(x, lane); };
    if (!(get(state.identifiable) > 0)) return;
    metrics.stiffness_estimate = get(state.stiffness);
    metrics.stiffness_sigma = get(state.stiffness_sigma);
    metrics.wall_speed_estimate = get(state.wall_speed);
}

// In the order of a batch's table.
const std::vector<SummaryNumber>& summary_table();

}  // namespace arm3r
