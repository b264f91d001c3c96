#pragma once
// The summary of a run: as JSON, and as text for people.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/run_data.hpp"
#include "results/checks.hpp"
#include "trust/horizon.hpp"

namespace arm3r {

// The parts of a summary.
struct Results {
    const Run& run;
    const std::string& name;
    const std::string& scenario;  // YAML; "" where the run came from bare parameters
    const std::vector<CheckResult>& checks;
    const std::optional<Setup>& setup;
    const std::optional<Horizon>& horizon;  // where it was asked for
};

std::string summary_json(const Results& results);
std::string report(const Results& results);

// The numbers of a summary that a check can name: "peak_force", "steps.accepted", ...
std::vector<std::string> summary_number_names();
double summary_number(const Run& run, std::string_view name);

}  // namespace arm3r
