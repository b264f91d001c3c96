#pragma once
// The summaries of finished runs on their way into the table of a batch, which has a column for each number. They are
// written many runs at a time, column by column: the columns of one run lie so far apart that they displace each other
// from the cache.

#include <array>
#include <vector>

#include "record/metrics.hpp"

namespace arm3r {

class SummaryBuffer {
public:
    // table: `columns` of summary_table(), `runs` numbers each.
    SummaryBuffer(const std::vector<std::size_t>& columns, double* table, std::size_t runs)
        : table_(table), runs_(runs), numbers_(capacity * columns.size()) {
        for (const std::size_t column : columns) columns_.push_back(summary_table()[column].of);
    }

    void add(std::size_t run, const Metrics& metrics) {
        double* number = numbers_.data() + count_ * columns_.size();
        for (const auto of : columns_) *number++ = of(metrics) + 0.0;
        run_[count_++] = run;
        if (count_ == capacity) write();
    }

    void write() {
        for (std::size_t column = 0; column < columns_.size(); ++column) {
            double* const cells = table_ + column * runs_;
            for (std::size_t i = 0; i < count_; ++i) cells[run_[i]] = numbers_[i * columns_.size() + column];
        }
        count_ = 0;
    }

private:
    static constexpr std::size_t capacity = 64;

    double* const table_;
    const std::size_t runs_;
    std::vector<double (*)(const Metrics&)> columns_;
    std::size_t count_ = 0;
    std::vector<double> numbers_;  // of one run after the other
    std::array<std::size_t, capacity> run_{};
};

}  // namespace arm3r
