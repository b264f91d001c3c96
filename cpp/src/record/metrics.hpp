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

// In the order of a batch's table.
const std::vector<SummaryNumber>& summary_table();

}  // namespace arm3r
