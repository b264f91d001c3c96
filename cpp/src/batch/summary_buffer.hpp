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
    // table: summary_table().size() columns of `runs` numbers each.
    SummaryBuffer(double* table, std::size_t runs) : table_(table), runs_(runs), numbers_(capacity * columns_) {}

    void add(std::size_t run, const Metrics& metrics) {
        double* number = numbers_.data() + count_ * columns_;
        for (const SummaryNumber& summary : summary_table()) *number++ = summary.of(metrics) + 0.0;
        run_[count_++] = run;
        if (count_ == capacity) write();
    }

    void write() {
        for (std::size_t column = 0; column < columns_; ++column) {
            double* const cells = table_ + column * runs_;
            for (std::size_t i = 0; i < count_; ++i) cells[run_[i]] = numbers_[i * columns_ + column];
        }
        count_ = 0;
    }

private:
    static constexpr std::size_t capacity = 64;

    double* const table_;
    const std::size_t runs_, columns_ = summary_table().size();
    std::size_t count_ = 0;
    std::vector<double> numbers_;  // of one run after the other
    std::array<std::size_t, capacity> run_{};
};

}  // namespace arm3r
