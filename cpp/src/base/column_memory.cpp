#include "base/column_memory.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "platform/memory.hpp"

namespace arm3r {

void FreeRows::operator()(double* block) const { platform::free_aligned(block); }

RowMemory allocate_rows(std::size_t doubles) {
    constexpr std::size_t large_page = std::size_t{1} << 21, cache_line = 64;
    const std::size_t wanted = doubles * sizeof(double);
    const std::size_t unit = wanted >= large_page / 2 ? large_page : cache_line;
    const std::size_t bytes = (wanted + unit - 1) / unit * unit;
    void* block = platform::allocate_aligned(unit, bytes);
    if (!block) throw std::bad_alloc();
    if (unit == large_page) platform::advise_large_pages(block, bytes);
    return RowMemory(static_cast<double*>(block));
}

RowTable::RowTable(const RowTable& other) : columns(other.columns), hidden(other.hidden) {
    if (!other.data) return;
    reserve(other.capacity);
    rows = other.rows;
    for (std::size_t i = 0; i < columns.size() + hidden.size(); ++i)
        std::copy_n(other.data.get() + i * capacity, rows, data.get() + i * capacity);
}

void RowTable::reserve(std::size_t max_rows) {
    capacity = max_rows;
    data = allocate_rows(capacity * (columns.size() + hidden.size()));
}

std::span<const double> RowTable::find(std::size_t index) const {
    if (const auto at = std::ranges::find(columns, index); at != columns.end())
        return column(static_cast<std::size_t>(at - columns.begin()));
    if (const auto at = std::ranges::find(hidden, index); at != hidden.end())
        return column(columns.size() + static_cast<std::size_t>(at - hidden.begin()));
    return {};
}

}  // namespace arm3r
