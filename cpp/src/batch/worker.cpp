#include "batch/worker.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "batch/lane_group.hpp"
#include "batch/law_adapter.hpp"
#include "batch/simulation.hpp"
#include "record/metrics.hpp"
#include "validate/size_limits.hpp"

namespace arm3r {
namespace {

constexpr std::size_t max_deferred = 1024;

MetricGroups groups_of(const std::vector<std::size_t>& summary) {
    MetricGroups groups;
    for (const std::size_t column : summary) groups.add(summary_table()[column].group);
    return groups;
}

auto lane_group_of(const Setup& first) {
    const bool remembers = has_memory(first.plant);
    if (first.solver.method == SolverMethod::taylor) return run_lanes_taylor;
    if (first.solver.is_on_grid()) return remembers ? run_lanes_rk4_controlled : run_lanes_rk4;
    return remembers ? run_lanes_to_events_controlled : run_lanes_to_events;
}

}  // namespace

BatchWorker::BatchWorker(BatchJob& job)
    : job_(job),
      metrics_(groups_of(job.summary)),
      params_(job.variation.params.begin(), job.variation.params.end()),
      summaries_(job.summary, job.results, job.variation.runs) {}

void BatchWorker::run() {
    std::size_t run;
    std::optional<Setup> first;
    while (fetch(run))
        if (prepare(run, first)) run_group(*first, run);
    summaries_.write();
}

void BatchWorker::run_group(const Setup& first, std::size_t run) {
    if (job_.law.function) {
        run_with_law(first, run);
    } else if (job_.lanes == 1) {
        run_alone(first, run_options(), run);
    } else {
        lane_group_of(first)(job_.lanes, *this, first, run);
        retry_.insert(retry_.end(), deferred_.begin(), deferred_.end());
        deferred_.clear();
    }
}

void BatchWorker::run_with_law(const Setup& setup, std::size_t run) {
    const auto poll_during_run = [](void* job, double, double, std::int64_t) -> std::int32_t {
        return static_cast<BatchJob*>(job)->poll(), 0;
    };
    const auto first_user = reinterpret_cast<std::uintptr_t>(job_.law.user);
    void* const user = reinterpret_cast<void*>(first_user + run * job_.law.user_stride);
    LawAdapter law(job_.law.function, user, setup);
    RunOptions options = run_options();
    options.user_law = law.user_law();
    if (job_.poll) options.progress = poll_during_run, options.user = &job_;
    run_alone(setup, options, run);
    if (job_.poll) job_.poll();
}

RunOptions BatchWorker::run_options() const { return {.should_stop = &job_.stop, .rows = records(), .judges = false}; }

void BatchWorker::run_alone(const Setup& setup, const RunOptions& options, std::size_t run) {
    const Run done = simulate(records() ? with_rows(setup, run) : setup, options);
    records() ? store_with_rows(run, done) : store(run, done);
}

void BatchWorker::store_with_rows(std::size_t run, const Run& done) {
    job_.rows->store(run, done);
    store(run, done);
}

bool BatchWorker::next(const BatchKey& batch_key, std::size_t& run, std::optional<Setup>& setup) {
    while (deferred_.size() < max_deferred && fetch(run)) {
        if (!prepare(run, setup)) continue;
        if (batch_key_of(*setup) == batch_key) return true;
        deferred_.push_back(run);
    }
    return false;
}

bool BatchWorker::fetch(std::size_t& run) {
    if (is_stopped()) return refuse_rest(), false;
    if (first_ == last_ && retry_.empty()) {
        const std::size_t runs = job_.variation.runs;
        first_ = std::min(runs, job_.next.fetch_add(job_.at_once));
        last_ = std::min(runs, first_ + job_.at_once);
    }
    if (first_ < last_) {
        run = first_++;
        return true;
    }
    if (retry_.empty()) return false;
    run = retry_.back();
    retry_.pop_back();
    return true;
}

bool BatchWorker::prepare(std::size_t run, std::optional<Setup>& setup) {
    job_.variation.put(run, params_);
    job_.check(params_, setup);
    if (setup) setup->metrics = metrics_;
    if (setup && !has_too_many_steps(*setup)) return true;
    refuse(run, run + 1, setup ? ARM3R_RUN_BUDGET : ARM3R_RUN_INVALID);
    return false;
}

void BatchWorker::store(std::size_t run, const Metrics& metrics) {
    summaries_.add(run, metrics);
    job_.done.fetch_add(1, std::memory_order_relaxed);
}

// A batch that fails returns no table, so its rows are left as they are: to write a million takes a second.
void BatchWorker::refuse_rest() {
    const std::size_t runs = job_.variation.runs, next = std::min(runs, job_.next.exchange(runs));
    if (!job_.failed) {
        refuse(first_, last_, ARM3R_RUN_STOPPED);
        refuse(next, runs, ARM3R_RUN_STOPPED);
        for (const std::size_t run : retry_) refuse(run, run + 1, ARM3R_RUN_STOPPED);
    }
    first_ = last_;
    retry_.clear();
}

void BatchWorker::refuse(std::size_t first, std::size_t last, arm3r_outcome why) {
    const std::size_t runs = job_.variation.runs;
    for (std::size_t i = 0; i < job_.summary.size(); ++i) {
        const bool is_outcome = job_.summary[i] == 0;  // the first of the table
        double* const column = job_.results + i * runs;
        std::fill(column + first, column + last, is_outcome ? double(why) : std::numeric_limits<double>::quiet_NaN());
    }
    if (job_.rows) job_.rows->clear(first, last);
    job_.done.fetch_add(last - first, std::memory_order_relaxed);
}

}  // namespace arm3r
