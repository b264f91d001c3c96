#pragma once
// A run as text: CSV, the JSON summary, and the summary for people.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "checks.hpp"
#include "simulation.hpp"

namespace arm3r {

// What a summary is made of.
struct Results {
    const Run& run;
    const std::string& name;
    const std::string& scenario;  // YAML; "" where the run came from bare parameters
    const std::vector<CheckResult>& checks;
};

std::string summary_json(const Results& results);
std::string report(const Results& results);

// The numbers of a summary that a check can name: "peak_force", "steps.accepted", ...
std::vector<std::string> summary_number_names();
double summary_number(const Run& run, std::string_view name);

// In pieces; the sink returns false to stop. False where it did.
bool write_csv(const Run& run, const std::function<bool(std::string_view)>& sink);

// 64-bit FNV-1a over the columns' bytes, column after column, doubles in little-endian order.
std::uint64_t fnv1a64(const Run& run);

}  // namespace arm3r
