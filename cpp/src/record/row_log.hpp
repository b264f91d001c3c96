#pragma once
// The rows of a run: when they stand, and where they go. The memory is taken before the first step. All that changes is
// the run's own.

#include "record/energy_balance.hpp"

namespace arm3r {

class RowLog {
public:
    RowLog(const Setup& setup, Run& run) : setup_(setup), run_(run) {}

    // Takes the memory of all rows; refuse_too_large() (size_cap.hpp) has seen to it that they are not too many.
    void reserve();

    // All rows before `until`, from the solution within the step, while go_on() holds.
    template <class GoOn>
    void log_until(double until, const Scene& scene, GoOn go_on) {
        while (stands_before(run_.rows + together - 1, until) && go_on()) log_together(scene);
        while (stands_before(run_.rows, until) && go_on()) {
            const double t = time_of(run_.rows), theta = (t - scene.inside.t0) / scene.inside.h;
            log(scene, t, scene.inside(theta), theta);
        }
    }

    bool is_due(double until) const { return stands_before(run_.rows, until); }

    // A row with a number that is not finite is not written: it ends the run.
    void log(const Scene& scene, double t, const FullState& y, double theta);

    // Of the last row, s; the start where there is none.
    double last_time() const { return run_.rows ? run_.data[run_.rows - 1] : setup_.start; }

private:
    double time_of(std::size_t row) const { return setup_.start + double(row) * setup_.log_every; }
    // The end of the run is a row of its own; so is its beginning, however long the interval.
    bool stands_before(std::size_t row, double until) const {
        const double t = time_of(row);
        return t < until && (row == 0 || t < setup_.stop - 1e-9 * setup_.log_every);
    }
    void log_together(const Scene& scene);
    void log_one_by_one(const Scene& scene, std::span<const double> t);
    void note_link_behind_wall(double t);
    void note_reach(const Scene& scene, double t, const FullState& y);
    void end_without(const Row& row, double t);

    const Setup& setup_;
    Run& run_;
};

}  // namespace arm3r
