#pragma once
// The rows of a run: when they stand, and where they go. The memory is taken before the first step.

#include "ledger.hpp"

namespace arm3r {

class RowLog {
public:
    // Reserves all rows. Throws Error ARM3R_E_SIZE_CAP when there would be too many of them.
    RowLog(const Setup& setup, Run& run);

    // All rows before `until`, from the solution within the step, while go_on() holds.
    template <class GoOn>
    void log_until(double until, const Scene& scene, GoOn go_on) {
        const double end = std::min(until, last_time());
        while (time_of(run_.rows + together - 1) < end && go_on()) log_together(scene);
        while (time_of(run_.rows) < end && go_on()) {
            const double t = time_of(run_.rows), theta = (t - scene.inside.t0) / scene.inside.h;
            log(scene, t, scene.inside(theta), theta);
        }
    }

    void log(const Scene& scene, double t, const FullState& y, double theta);

    // When a link other than at its tip was first behind the wall, s; < 0: never.
    double link_behind_wall_since() const { return link_behind_wall_since_; }

private:
    double time_of(std::size_t row) const { return double(row) * setup_.log_every; }
    double last_time() const {
        return setup_.stop - 1e-9 * setup_.log_every;
    }  // the end of the run is a row of its own
    void log_together(const Scene& scene);
    void note_link_behind_wall(double t);

    const Setup& setup_;
    Run& run_;
    double link_behind_wall_since_ = -1;
};

}  // namespace arm3r
