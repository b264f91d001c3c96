#pragma once
// The summary numbers of a run, in a single run's summary and as a row of a batch's table.

#include <string_view>
#include <vector>

#include "record/run_data.hpp"

namespace arm3r {

struct SummaryNumber {
    std::string_view name, unit, meaning;
    double (*of)(const Metrics&);  // NaN: the run has no such number
};

// In the order of a batch's table.
const std::vector<SummaryNumber>& summary_table();

}  // namespace arm3r
