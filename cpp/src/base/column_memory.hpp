#pragma once
// Memory for the rows of a run: one block, in large pages where the system offers them. A run of 10 000 rows is over in
// less time than it takes to be given its memory in small pages.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace arm3r {

struct FreeRows {
    void operator()(double* block) const;
};

using RowMemory = std::unique_ptr<double[], FreeRows>;

// Not initialised. Throws std::bad_alloc.
RowMemory allocate_rows(std::size_t doubles);

// Columns lie one after the other in one block: column i is data[i*capacity .. i*capacity + rows), first those of the
// log, then the hidden ones.
struct RowTable {
    std::vector<std::size_t> columns;  // of the log: indices into column_table (columns.hpp), in order
    std::vector<std::size_t> hidden;   // that only the program itself reads: for checks, messages and horizon
    std::size_t rows = 0, capacity = 0;
    RowMemory data;

    RowTable() = default;
    RowTable(RowTable&&) = default;
    RowTable& operator=(RowTable&&) = default;
    RowTable(const RowTable& other);

    // Allocates memory for this many rows of `columns` and `hidden`.
    void reserve(std::size_t capacity);
    std::span<const double> column(std::size_t i) const { return {data.get() + i * capacity, rows}; }
    // The column with an index into column_table, hidden or not; empty where it is not kept.
    std::span<const double> find(std::size_t index) const;
};

}  // namespace arm3r
