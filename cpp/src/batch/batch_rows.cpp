#include "batch/batch_rows.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "record/row_log.hpp"
#include "schema/schema.hpp"
#include "validate/size_limits.hpp"
#include "validate/validate.hpp"

namespace arm3r {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

ColumnSet set_of(std::span<const std::size_t> columns) {
    ColumnSet set;
    for (const std::size_t column : columns) set.set(column);
    return set;
}

// Whether the instants of the rows differ from run to run.
bool varies_instants(const Variation& variation) {
    return std::ranges::any_of(variation.varied,
                               [](std::size_t number) { return key_at(number).path.starts_with("time."); });
}

Setup with_log(Setup setup, const ColumnSet& columns) {
    setup.logged = (columns & possible_columns(setup)).set(ColumnIndex("t"));
    return setup;
}

}  // namespace

Setup BatchRows::with_columns(const Setup& setup, std::size_t run) const {
    const Setup chosen = with_log(setup, set_of(columns));
    refuse_too_large(chosen);
    if (const std::size_t rows = row_count(chosen); rows > room)
        throw Error(ARM3R_E_SIZE, "rows: run " + std::to_string(run) + " has " + std::to_string(rows) +
                                      " rows, and row_count is " + std::to_string(room) +
                                      "; arm3r_batch_row_count says how many are needed");
    return chosen;
}

void BatchRows::store(std::size_t run, const RowTable& rows) const {
    double* out = data + run * columns.size() * room;
    for (const std::size_t index : columns) {
        const std::span<const double> column = rows.find(index);
        std::fill(std::ranges::copy(column, out).out, out + room, nothing);
        out += room;
    }
}

void BatchRows::clear(std::size_t first, std::size_t last) const {
    const std::size_t size = columns.size() * room;
    std::fill(data + first * size, data + last * size, nothing);
}

std::size_t most_rows(const Variation& variation, std::span<const std::size_t> columns) {
    const ColumnSet wanted = set_of(columns);
    const Checker check(variation.params, variation.varied);
    const bool alike = !varies_instants(variation);
    std::vector<double> params(variation.params.begin(), variation.params.end());
    std::size_t most = 0;
    ColumnSet missing = wanted;
    std::optional<Setup> without;  // a run that does not have the columns that are missing
    for (std::size_t run = 0; run < variation.runs && !(alike && most > 0 && missing.none()); ++run) {
        variation.put(run, params);
        std::optional<Setup> setup = check(params);
        if (!setup || has_too_many_steps(*setup)) continue;
        missing &= ~possible_columns(*setup);
        const Setup chosen = with_log(*setup, wanted);
        refuse_too_large(chosen);
        most = std::max(most, row_count(chosen));
        if (missing.any()) without = std::move(setup);
    }
    if (most == 0 || missing.none()) return most;
    without->logged = missing;
    throw Error(ARM3R_E_SCENARIO, missing_columns(*without, "columns"));
}

}  // namespace arm3r
