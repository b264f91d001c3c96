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
        : worker_(worker), batch_key_(batch_key_of(first)) {
        for (Part& part : parts_) part.lane_run.emplace(first);
        parts_[0].lane_run->load_lane(0, first);
        parts_[0].run[0] = run;
        for (Part& part : parts_)
            for (int lane = &part == &parts_[0] ? 1 : 0; lane < Integrator::lanes; ++lane) fill(part, lane);
    }

    ARM3R_INLINE void run() {
        for (Part& part : parts_) part.lane_run->start_lanes();
        while (true) {
            Integrator* running[Integrator::together];
            int count = 0;
            for (Part& part : parts_) {
                Integrator& lane_run = *part.lane_run;
                while ((lane_run.any_ended() || worker_.is_stopped()) && refill(part)) lane_run.start_lanes();
                if (lane_run.any_running()) running[count++] = &lane_run;
            }
            if (count == 0) return;
            if constexpr (Integrator::lanes == 1) advance(*running[0], infinite);
            else if constexpr (Integrator::together == 1) running[0]->step();
            else Integrator::step_together(running, count);
        }
    }

private:
    // A lane run and the setups of its lanes, which stay where they are.
    struct Part {
        std::optional<Integrator> lane_run;
        std::array<std::size_t, Integrator::lanes> run{};
        std::array<std::optional<Setup>, Integrator::lanes> setup;
    };

    bool fill(Part& part, int lane) {
        if (!worker_.next(batch_key_, part.run[lane], part.setup[lane])) return false;
        part.lane_run->load_lane(lane, *part.setup[lane]);
        return true;
    }

    // Runs that have ended are stored and their lanes refilled; returns whether there are new runs.
    [[gnu::noinline]] bool refill(Part& part) {
        bool any_new = false;
        Integrator& lane_run = *part.lane_run;
        lane_run.clear_failures();
        for (int lane = 0; lane < Integrator::lanes; ++lane) {
            if (!lane_run.is_running(lane)) continue;
            if (worker_.is_stopped() && !lane_run.has_ended(lane)) lane_run.stop_lane(lane, ARM3R_RUN_STOPPED);
            if (!lane_run.has_ended(lane)) continue;
            worker_.store(part.run[lane], lane_run.metrics(lane));
            if (fill(part, lane)) any_new = true;
            else lane_run.clear_lane(lane);
        }
        return any_new;
    }

    BatchWorker& worker_;
    const BatchKey batch_key_;
    std::array<Part, Integrator::together> parts_;
};

// Packs as wide as the registers; wider packs are slow.
template <template <class> class Integrator>
void run_lane_groups(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_at_width(LaneTypes{}, lanes, [&]<class T>() ARM3R_INLINE_LAMBDA {
        std::make_unique<LaneGroup<Integrator<T>>>(worker, first, run)->run();
    });
}

}  // namespace arm3r
