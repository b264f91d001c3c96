#pragma once
// The checks of a scenario file, compared with a run.

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/yaml_tree.hpp"
#include "record/run_data.hpp"

namespace arm3r {

struct Check {
    enum Subject { column, event, count, summary } subject = column;
    std::string name;
    std::string what;       // the column, "make" or "break", or the field of the summary
    std::string minus;      // a second column, taken off row by row; or ""
    std::string of;         // min | max | max_abs | range | final; or "": the row at `at`
    double at = 0;          // s
    std::size_t index = 0;  // of the event
    std::optional<double> equals, below, above;
    double abs = 0, rel = 0;  // tolerances of `equals`: either suffices
};

struct CheckResult {
    std::string name;
    bool passed = false;
    std::optional<double> value;  // none: there was nothing to measure, see `reason`
    std::string limit;            // "equals 50 (abs 1e-6)"
    std::optional<double> deviation;
    std::string reason;
};

// How a check may be written: its subject says which keys it has.
struct CheckForm {
    std::string subject;
    std::vector<std::string> keys;
};

std::vector<CheckForm> check_forms();

// The words that a key of a check takes, except names of columns; none for a number or a text.
std::vector<std::string> words_of_check(std::string_view key);

// Reads a list of checks; its errors are added to `problems`. `params` determine the rows of the run, `columns` are its
// columns (indices into column_table).
std::vector<Check> read_checks(const Node& list, std::span<const double> params, std::span<const std::size_t> columns,
                               const std::string& file, std::vector<Problem>& problems);

// `params`: those of the run. On part of a run, only the rows and events that exist can be judged.
// The columns that the checks read.
ColumnSet columns_in(const std::vector<Check>& checks);

std::vector<CheckResult> evaluate(const std::vector<Check>& checks, const Run& run, std::span<const double> params);

}  // namespace arm3r
