#pragma once
// The rows of a run: their instants and their memory, which is allocated before the first step. All that changes
// belongs to the run.

#include "record/energy_balance.hpp"

namespace arm3r {

inline double time_of(const Setup& setup, std::size_t row) { return setup.start + double(row) * setup.log_every; }
// The start and the end of the run always have a row, however long the interval is.
inline bool stands_before(const Setup& setup, std::size_t row, double until) {
    const double t = time_of(setup, row);
    return t < until && (row == 0 || t < setup.stop - 1e-9 * setup.log_every);
}
// How many rows a run has that reaches its end.
std::size_t row_count(const Setup& setup);

class RowLog {
public:
    RowLog(const Setup& setup, Run& run) : setup_(setup), run_(run) {}

    // Allocates the memory of all rows; refuse_too_large() (size_limits.hpp) has checked that they are not too many.
    void reserve(const RowPlan& plan);

    // Writes all rows before `until`, from the dense output of the step, while keep_going() holds.
    template <class KeepGoing>
    void log_until(double until, const RowContext& context, KeepGoing keep_going) {
        for (int count = due_rows(until); count > 0 && keep_going(); count = due_rows(until)) {
            if (count == 1) log_one_by_one(context, std::array{time_of(run_.rows)});
            else log_block(context, count);
        }
    }

    bool is_due(double until) const { return stands_before(run_.rows, until); }

    // Writes a row. A row with a number that is not finite is not written: it ends the run.
    void log(const RowContext& context, double t, const FullState& y, double theta);

    // The time of the last row, s; the start of the run if there is none.
    double last_time() const { return run_.rows ? run_.data[run_.rows - 1] : setup_.start; }

private:
    double time_of(std::size_t row) const { return arm3r::time_of(setup_, row); }
    bool stands_before(std::size_t row, double until) const { return arm3r::stands_before(setup_, row, until); }
    // Visits the columns that are kept: the index of each, and its cell of the next row.
    template <class Visit>
    void each_cell(Visit visit) {
        double* cell = run_.data.get() + run_.rows;
        for (const auto* columns : {&run_.columns, &run_.hidden})
            for (const std::size_t column : *columns) visit(column, cell), cell += run_.capacity;
    }
    // How many rows before `until` are not yet written, at most a block of them.
    int due_rows(double until) const {
        int count = 0;
        while (count < rows_per_block && stands_before(run_.rows + static_cast<std::size_t>(count), until)) ++count;
        return count;
    }
    void log_block(const RowContext& context, int count);
    void log_one_by_one(const RowContext& context, std::span<const double> t);
    void record_link_behind_wall(double t);
    void check_workspace(const RowContext& context, double t, const FullState& y);
    void end_at_bad_row(const Row& row, double t);

    const Setup& setup_;
    Run& run_;
};

}  // namespace arm3r
