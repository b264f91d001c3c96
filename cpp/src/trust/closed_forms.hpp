#pragma once
// What theory says of the contacts of a run, in closed form, beside the run's own numbers; docs/model.md (9.1) to
// (9.5).

#include <string_view>
#include <vector>

#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

struct ClosedForm {
    std::string_view name, unit;  // of the summary number that it stands beside
    double own, form;
    double allowed;  // how far theory and tolerance let the two differ
};

struct ClosedForms {
    double effective_mass = Metrics::unknown, approach_speed = Metrics::unknown;  // kg, m/s, at the first contact
    std::vector<ClosedForm> forms;                                                // those that say something
};

ClosedForms closed_forms(const Setup& setup, const Run& run);

}  // namespace arm3r
