#pragma once
// A batch worker, one per thread: it fetches runs, integrates them in lanes, and writes their rows.

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "batch/batch.hpp"
#include "batch/summary_buffer.hpp"
#include "lanes/lane_run.hpp"
#include "validate/validate.hpp"

namespace arm3r {

// The data that the threads of a batch share. Each row is written by one thread.
struct BatchJob {
    const Variation& variation;
    const Checker check;
    double* const results;
    const std::vector<std::size_t> summary;  // the columns of the results, of summary_table()
    const int lanes;                         // as BatchOptions::lanes
    const std::optional<BatchRows>& rows;
    const BatchLaw& law;
    const std::function<void()> poll;  // empty, or what the calling thread does during a run and after it
    std::size_t at_once = 1;           // runs that a worker fetches from the common supply
    std::atomic<std::size_t> next = 0, done = 0;
    std::atomic<bool> failed = false, stop = false;
};

class BatchWorker {
public:
    explicit BatchWorker(BatchJob& job);

    // Works until there are no more runs.
    void run();

    // Makes the setup of the next run with the key `batch_key` in place and writes its number into `run`; returns whether
    // there is one. Runs with other keys are deferred.
    bool next(const BatchKey& batch_key, std::size_t& run, std::optional<Setup>& setup);
    void store(std::size_t run, const Metrics& metrics);

    RunOptions run_options() const;
    // Whether rows are wanted: then a run has a setup with their columns, and its record is stored.
    bool records() const { return job_.rows.has_value(); }
    Setup with_rows(const Setup& setup, std::size_t run) const { return job_.rows->with_columns(setup, run); }
    void store_with_rows(std::size_t run, const Run& done);
    bool is_stopped() const { return job_.stop.load(std::memory_order_relaxed); }

private:
    bool fetch(std::size_t& run);
    // Makes the setup of a run in place; returns false if there is nothing to simulate, and its row is complete.
    bool prepare(std::size_t run, std::optional<Setup>& setup);
    void run_group(const Setup& first, std::size_t run);
    void run_with_law(const Setup& setup, std::size_t run);
    void run_alone(const Setup& setup, const RunOptions& options, std::size_t run);
    // The runs first to last - 1 were not started: their rows have no number but the outcome.
    void refuse(std::size_t first, std::size_t last, arm3r_outcome why);
    void refuse_rest();  // all runs that no worker has started

    BatchJob& job_;
    const MetricGroups metrics_;  // that the summary needs
    std::vector<double> params_;
    SummaryBuffer summaries_;
    std::size_t first_ = 0, last_ = 0;  // the runs that were fetched and not yet started
    std::vector<std::size_t> retry_, deferred_;
};

}  // namespace arm3r
