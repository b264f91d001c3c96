#include "batch/batch.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <numeric>
#include <system_error>
#include <thread>
#include <vector>

#include "arm3r/numbers/widths.hpp"
#include "base/callback.hpp"
#include "base/error.hpp"
#include "batch/worker.hpp"
#include "platform/threads.hpp"
#include "validate/validate.hpp"

namespace arm3r {
namespace {

constexpr std::size_t min_runs_per_thread = 64, min_runs_with_rows = 4;
// Of the runs that a worker fetches at once: so few that all workers end at about the same time.
constexpr std::size_t fetches_per_thread = 8, most_at_once = 256, most_with_rows = 16;
constexpr std::chrono::milliseconds poll_interval{5}, report_interval{20};
using Clock = std::chrono::steady_clock;

// Asks the threads to stop before they are joined, also if the calling thread leaves by an exception or is ended in a
// callback.
struct StopGuard {
    std::atomic<bool>& stop;
    ~StopGuard() { stop = true; }
};

std::vector<std::size_t> wanted_columns(const BatchOptions& options) {
    if (options.summary) return {options.summary->begin(), options.summary->end()};
    std::vector<std::size_t> all(summary_table().size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

class Batch {
public:
    Batch(const Variation& variation, const BatchOptions& options, double* results)
        : options_(options),
          job_{variation,
               Checker(variation.params, variation.varied),
               results,
               wanted_columns(options),
               options.lanes ? widest(LaneTypes{}, options.lanes) : max_lanes(),
               options.rows,
               options.law,
               poll_of_this_thread()} {}

    void run() {
        if (job_.poll) BatchWorker(job_).run();
        else run_in_threads();
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    // A law that is not re-entrant is called by the calling thread, which then works itself; as it does where it is the
    // only one that there can be.
    std::function<void()> poll_of_this_thread() {
        if (platform::has_threads && (!options_.law.function || options_.law.reentrant)) return {};
        return [this] { poll_caller(); };
    }

    void run_in_threads() {
        const std::size_t runs = job_.variation.runs;
        const std::size_t wanted = options_.threads > 0 ? options_.threads : platform::allowed_cpus();
        const std::size_t runs_per_thread = options_.law.function ? 1
                                            : options_.rows       ? min_runs_with_rows
                                                                  : min_runs_per_thread;
        const std::size_t count = std::clamp<std::size_t>(runs / runs_per_thread, 1, wanted);
        if (!options_.law.function)
            job_.at_once = std::clamp<std::size_t>(runs / (fetches_per_thread * count), 1,
                                                   options_.rows ? most_with_rows : most_at_once);
        std::vector<std::jthread> threads;
        const StopGuard stop_guard{job_.stop};
        threads.reserve(count);
        try {
            while (threads.size() < count) threads.emplace_back([this] { run_worker(); });
        } catch (const std::system_error&) {  // fewer threads are enough
            if (threads.empty()) throw;
        }
        while (!has_ended(threads.size())) poll_caller();
    }

    void run_worker() {
        const EndOfWorker end{*this};
        try {
            BatchWorker(job_).run();
        } catch (const platform::ThreadEnd&) {
            fail_by_thread_end();
            throw;
        } catch (...) {
            if (!platform::caught_thread_end()) return fail(std::current_exception());
            fail_by_thread_end();
            platform::continue_thread_end();
        }
    }

    void fail_by_thread_end() {
        fail(std::make_exception_ptr(Error(ARM3R_E_CALLBACK, "the law ended the thread that called it")));
    }

    void end_worker() {
        const std::lock_guard lock(mutex_);
        ended_ += 1;
        wake_.notify_one();
    }

    // A thread counts as ended also where a law ended it (pthread_exit).
    struct EndOfWorker {
        Batch& batch;
        ~EndOfWorker() { batch.end_worker(); }
    };

    void fail(std::exception_ptr failure) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::move(failure);
        job_.failed = true;
        job_.stop = true;
    }

    bool has_ended(std::size_t threads) {
        std::unique_lock lock(mutex_);
        return wake_.wait_for(lock, poll_interval, [&] { return ended_ == threads; });
    }

    // The calling thread forwards a request to stop and reports progress.
    void poll_caller() {
        if (options_.stop && *options_.stop) job_.stop = true;
        if (!options_.progress || Clock::now() < next_report_) return;
        next_report_ = Clock::now() + report_interval;
        const std::int32_t answer = call_back(options_.progress, options_.user, std::int64_t(job_.done.load()),
                                              std::int64_t(job_.variation.runs));
        if (answer != 0) job_.stop = true;
        if (answer < 0)
            fail(std::make_exception_ptr(
                Error(ARM3R_E_CALLBACK, "the progress function asked to stop with " + std::to_string(answer))));
    }

    const BatchOptions& options_;
    BatchJob job_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::size_t ended_ = 0;
    std::exception_ptr failure_;
    Clock::time_point next_report_ = Clock::now() + report_interval;
};

}  // namespace

void run_batch(const Variation& variation, const BatchOptions& options, double* results) {
    check_variation(variation);
    if (options.lanes > 0 && !has_registers_for(options.lanes))
        throw Error(ARM3R_E_VALUE,
                    "lanes: this processor, or this build, has no registers for " + std::to_string(options.lanes));
    if (variation.varied.empty()) valid_setup(variation.params);  // throws what is wrong in all runs alike
    Batch(variation, options, results).run();
}

}  // namespace arm3r
