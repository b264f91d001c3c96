#pragma once
// Groups of runs with the same batch key, in lanes, by one method; each method is compiled in a file of its own.

#include <array>
#include <memory>
#include <optional>

#include "arm3r/numbers/widths.hpp"
#include "batch/lane_group.hpp"

namespace arm3r {

// Integrates runs with the same batch key until there are no more; the first one stays with its caller.
template <class Integrator>
class LaneGroup {
public:
    LaneGroup(BatchWorker& worker, const Setup& first, std::size_t run)
        : worker_(worker), batch_key_(batch_key_of(first)), lane_run_(first) {
        lane_run_.load_lane(0, first);
        run_[0] = run;
        for (int lane = 1; lane < Integrator::lanes; ++lane) fill(lane);
    }

    ARM3R_INLINE void run() {
        lane_run_.start_lanes();
        while (true) {
            while ((lane_run_.any_ended() || worker_.is_stopped()) && refill()) lane_run_.start_lanes();
            if (!lane_run_.any_running()) return;
            if constexpr (Integrator::lanes == 1) lane_run_.step_outlined();
            else lane_run_.step();
        }
    }

private:
    bool fill(int lane) {
        if (!worker_.next(batch_key_, run_[lane], setup_[lane])) return false;
        lane_run_.load_lane(lane, *setup_[lane]);
        return true;
    }

    // Runs that have ended are stored and their lanes refilled; returns whether there are new runs.
    [[gnu::noinline]] bool refill() {
        bool any_new = false;
        lane_run_.clear_failures();
        for (int lane = 0; lane < Integrator::lanes; ++lane) {
            if (!lane_run_.is_running(lane)) continue;
            if (worker_.is_stopped() && !lane_run_.has_ended(lane)) lane_run_.stop_lane(lane, ARM3R_RUN_STOPPED);
            if (!lane_run_.has_ended(lane)) continue;
            worker_.store(run_[lane], lane_run_.metrics(lane));
            if (fill(lane)) any_new = true;
            else lane_run_.clear_lane(lane);
        }
        return any_new;
    }

    BatchWorker& worker_;
    const BatchKey batch_key_;
    Integrator lane_run_;
    std::array<std::size_t, Integrator::lanes> run_{};
    std::array<std::optional<Setup>, Integrator::lanes> setup_;
};

// Packs as wide as the registers; wider packs are slow.
template <template <class> class Integrator>
void run_lane_groups(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_at_width(LaneTypes{}, lanes, [&]<class T>() ARM3R_INLINE_LAMBDA {
        std::make_unique<LaneGroup<Integrator<T>>>(worker, first, run)->run();
    });
}

}  // namespace arm3r
