#pragma once
// The rows of the runs of a batch: chosen columns, in memory of the caller.

#include <span>

#include "batch/variation.hpp"
#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

struct BatchRows {
    std::span<const std::size_t> columns;  // indices into column_table
    std::size_t room = 0;                  // rows of a run, at most
    double* data = nullptr;                // row k of column j of run i is data[(i*columns.size() + j)*room + k]

    // The same run with these columns in its log, as far as it can have them. Throws Error where there is no room for
    // all of its rows.
    Setup with_columns(const Setup& setup, std::size_t run) const;
    // Copies the rows of a run; NaN stands after the last one, and where the run does not have a column.
    void store(std::size_t run, const RowTable& rows) const;
    // The runs first to last - 1 have no rows.
    void clear(std::size_t first, std::size_t last) const;
};

// The most rows that a valid run of the variation can have. Throws Error where a run has too many rows, or where none of
// them has one of the columns.
std::size_t most_rows(const Variation& variation, std::span<const std::size_t> columns);

}  // namespace arm3r
