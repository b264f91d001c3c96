#include "batch.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include "error.hpp"
#include "schema.hpp"
#include "summary.hpp"

namespace arm3r {
namespace {

constexpr std::size_t runs_at_a_time = 256;
constexpr std::chrono::milliseconds between_reports{20};

int allowed_threads() {
    cpu_set_t cpus;
    const int allowed = sched_getaffinity(0, sizeof cpus, &cpus) == 0 ? CPU_COUNT(&cpus) : 1;
    return std::max(1, allowed);
}

const Key& key_of(std::size_t number) {
    const auto holds = [&](const Key& key) { return number < key.offset + key.size; };
    return *std::find_if(schema().begin(), schema().end(), holds);
}

void check_variation(const Variation& variation) {
    std::vector<bool> seen(param_count());
    for (const std::size_t number : variation.varied) {
        if (number >= param_count())
            throw Error(ARM3R_E_INDEX, "varied: there is no number " + std::to_string(number) + "; there are " +
                                           std::to_string(param_count()));
        if (seen[number]) throw Error(ARM3R_E_INDEX, "varied: " + param_name(number) + " is named twice");
        seen[number] = true;
        const Key& key = key_of(number);
        if (key.kind == Kind::choice || key.kind == Kind::flag || key.kind == Kind::section)
            throw Error(ARM3R_E_INDEX, "varied: " + key.path + " is no number but a choice; make a batch for each");
    }
}

class Batch {
public:
    Batch(const Variation& variation, const BatchOptions& options, double* results)
        : variation_(variation), options_(options), results_(results) {}

    void run() {
        const std::size_t wanted = options_.threads > 0 ? options_.threads : allowed_threads();
        const std::size_t count = std::clamp<std::size_t>(variation_.runs / runs_at_a_time, 1, wanted);
        std::vector<std::thread> threads;
        for (std::size_t i = 0; i < count; ++i) threads.emplace_back([this] { work(); });
        watch();
        for (std::thread& thread : threads) thread.join();
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    void work() {
        try {
            for (std::size_t first; (first = next_.fetch_add(runs_at_a_time)) < variation_.runs;)
                run_some(first, std::min(first + runs_at_a_time, variation_.runs));
        } catch (...) {
            const std::lock_guard lock(mutex_);
            failure_ = std::current_exception();
            stop_ = 1;
            done_ = variation_.runs;
        }
    }

    void run_some(std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            store(one(i), i);
            done_ += 1;
        }
    }

    Run one(std::size_t i) const {
        std::vector<double> params(variation_.params.begin(), variation_.params.end());
        for (std::size_t j = 0; j < variation_.varied.size(); ++j)
            params[variation_.varied[j]] = variation_.values[j * variation_.runs + i];
        if (validate(params).empty()) return simulate(params, {.stop = &stop_, .rows = false});
        Run invalid;
        invalid.outcome = ARM3R_RUN_INVALID;
        return invalid;
    }

    void store(const Run& run, std::size_t i) {
        double* cell = results_ + i;
        for (const SummaryNumber& number : summary_table()) {
            const bool known = run.outcome != ARM3R_RUN_INVALID || number.name == "outcome";
            *cell = known ? number.of(run) + 0.0 : std::numeric_limits<double>::quiet_NaN();
            cell += variation_.runs;
        }
    }

    // The calling thread hands the wish to stop on, and reports.
    void watch() {
        while (done_ < variation_.runs) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            if (options_.stop && *options_.stop) stop_ = 1;
            if (options_.progress && std::chrono::steady_clock::now() >= next_report_) report();
        }
    }

    void report() {
        next_report_ = std::chrono::steady_clock::now() + between_reports;
        const std::int32_t answer = options_.progress(options_.user, static_cast<std::int64_t>(done_.load()),
                                                      static_cast<std::int64_t>(variation_.runs));
        if (answer != 0) stop_ = 1;
        if (answer >= 0 || failure_) return;
        const std::lock_guard lock(mutex_);
        failure_ = std::make_exception_ptr(
            Error(ARM3R_E_CALLBACK, "the progress function asked to stop with " + std::to_string(answer)));
    }

    const Variation& variation_;
    const BatchOptions& options_;
    double* const results_;
    std::atomic<std::size_t> next_ = 0, done_ = 0;
    volatile std::int32_t stop_ = 0;
    std::mutex mutex_;
    std::exception_ptr failure_;
    std::chrono::steady_clock::time_point next_report_{};
};

}  // namespace

void run_batch(const Variation& variation, const BatchOptions& options, double* results) {
    check_variation(variation);
    if (variation.varied.empty()) {
        std::vector<Problem> problems = validate(variation.params);
        if (!problems.empty()) throw Error(ARM3R_E_SCENARIO, std::move(problems));
    }
    Batch(variation, options, results).run();
}

}  // namespace arm3r
