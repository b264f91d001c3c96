#pragma once
// Groups of runs with the same batch key, in lanes, by one method; each method is compiled in a file of its own.

#include <array>
#include <memory>
#include <optional>

#include "arm3r/numbers/widths.hpp"
#include "batch/lane_group.hpp"
#include "lanes/lane_record.hpp"
#include "lanes/run_loop.hpp"

namespace arm3r {

// Integrates runs with the same batch key until there are no more; the first one stays with its caller.
template <class Method>
class LaneGroup {
public:
    LaneGroup(BatchWorker& worker, const Setup& first, std::size_t run)
        : worker_(worker), batch_key_(batch_key_of(first)) {
        for (Part& part : parts_) prepare(part, first);
        parts_[0].run[0] = run;
        load(parts_[0], 0, first);
        for (Part& part : parts_)
            for (int lane = &part == &parts_[0] ? 1 : 0; lane < Method::lanes; ++lane) fill(part, lane);
    }

    ARM3R_INLINE void run() {
        for (Part& part : parts_) start(part);
        while (true) {
            RunLoop<Method>* running[Method::together];
            int count = 0;
            for (Part& part : parts_) {
                RunLoop<Method>& lane_run = *part.lane_run;
                while ((lane_run.any_ended() || worker_.is_stopped()) && refill(part)) start(part);
                if (lane_run.any_running()) running[count++] = &lane_run;
            }
            if (count == 0) return;
            if (worker_.records()) forget_dense_outputs();
            RunLoop<Method>::step_together(running, count);
            if (worker_.records()) record_step();
        }
    }

private:
    // A lane run and the setups of its lanes, which stay where they are.
    struct Part {
        std::optional<RunLoop<Method>> lane_run;
        std::array<std::size_t, Method::lanes> run{};
        std::array<std::optional<Setup>, Method::lanes> setup;
        std::array<std::unique_ptr<LaneRecord<Method>>, Method::lanes> record;  // where rows are wanted
        std::array<bool, Method::lanes> is_new{};                               // loaded since the last start
    };

    void prepare(Part& part, const Setup& first) {
        RunLoop<Method>& lane_run = part.lane_run.emplace(first);
        if (!worker_.records()) return;
        lane_run.keep_for_rows();
        lane_run.set_observer(
            [&part](int lane, const ContactChange& change) { part.record[lane]->record_change(change); });
    }

    bool fill(Part& part, int lane) {
        if (!worker_.next(batch_key_, part.run[lane], part.setup[lane])) return false;
        load(part, lane, *part.setup[lane]);
        return true;
    }
    void load(Part& part, int lane, const Setup& setup) {
        part.lane_run->load_lane(lane, setup);
        if (!worker_.records()) return;
        part.record[lane] = std::make_unique<LaneRecord<Method>>(worker_.with_rows(setup, part.run[lane]),
                                                                 worker_.run_options(), *part.lane_run, lane);
        part.is_new[lane] = true;
    }

    ARM3R_INLINE void start(Part& part) {
        part.lane_run->start();
        if (worker_.records()) start_records(part);
    }

    // ---- the records of the lanes

    template <class Visit>
    void each_record(Visit visit) {
        for (Part& part : parts_)
            for (int lane = 0; lane < Method::lanes; ++lane)
                if (part.lane_run->is_running(lane)) visit(part, lane, *part.record[lane]);
    }

    [[gnu::noinline]] void start_records(Part& part) {
        for (int lane = 0; lane < Method::lanes; ++lane) {
            if (!std::exchange(part.is_new[lane], false)) continue;
            part.record[lane]->record_contact_at_start();
            part.record[lane]->record_start();
        }
    }
    [[gnu::noinline]] void forget_dense_outputs() {
        each_record([](Part&, int, LaneRecord<Method>& record) { record.forget_dense_output(); });
    }
    // A row that is not a finite number ends its run.
    [[gnu::noinline]] void record_step() {
        each_record([](Part& part, int lane, LaneRecord<Method>& record) {
            record.record_step();
            record.update_row_context();
            if (!record.is_running()) part.lane_run->stop_lane(lane, record.outcome());
        });
    }
    void store(Part& part, int lane) {
        if (!worker_.records()) return worker_.store(part.run[lane], part.lane_run->metrics(lane));
        worker_.store_with_rows(part.run[lane], part.record[lane]->record_end());
    }

    // Runs that have ended are stored and their lanes refilled; returns whether there are new runs.
    [[gnu::noinline]] bool refill(Part& part) {
        bool any_new = false;
        RunLoop<Method>& lane_run = *part.lane_run;
        lane_run.clear_failures();
        for (int lane = 0; lane < Method::lanes; ++lane) {
            if (!lane_run.is_running(lane)) continue;
            if (worker_.is_stopped() && !lane_run.has_ended(lane)) lane_run.stop_lane(lane, ARM3R_RUN_STOPPED);
            if (!lane_run.has_ended(lane)) continue;
            store(part, lane);
            if (fill(part, lane)) any_new = true;
            else lane_run.clear_lane(lane);
        }
        return any_new;
    }

    BatchWorker& worker_;
    const BatchKey batch_key_;
    std::array<Part, Method::together> parts_;
};

// Packs as wide as the registers; wider packs are slow.
template <template <class> class Method>
void run_lane_groups(int lanes, BatchWorker& worker, const Setup& first, std::size_t run) {
    run_at_width(LanePacks{}, lanes, [&]<class T>() ARM3R_INLINE_LAMBDA {
        std::make_unique<LaneGroup<Method<T>>>(worker, first, run)->run();
    });
}

}  // namespace arm3r
