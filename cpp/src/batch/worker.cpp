#include "batch/worker.hpp"

#include <limits>
#include <utility>

#include "batch/lane_group.hpp"
#include "record/metrics.hpp"
#include "run/adaptive_run.hpp"
#include "validate/size_limits.hpp"

namespace arm3r {
namespace {

constexpr std::size_t runs_at_a_time = 256, most_aside = 1024;

auto lineups_of(const Setup& first) {
    if (first.solver.method == Solver::taylor) return march_by_taylor;
    return has_memory(first.plant) ? march_with_memory : march_by_rk4;
}

}  // namespace

Crew::Crew(Work& work) : work_(work), params_(work.variation.params.begin(), work.variation.params.end()) {}

void Crew::run() {
    std::size_t run;
    Setup setup;
    while (take(run))
        if (prepare(run, setup)) march(setup, run);
}

void Crew::march(const Setup& first, std::size_t run) {
    if (!first.solver.marches()) {
        store(run, run_adaptively(first, {.should_stop = &work_.stop, .rows = false}));
    } else {
        lineups_of(first)(work_.lanes, *this, first, run);
        again_.insert(again_.end(), aside_.begin(), aside_.end());
        aside_.clear();
    }
}

bool Crew::next(const Structure& structure, Setup& setup, std::size_t& run) {
    while (aside_.size() < most_aside && take(run)) {
        if (!prepare(run, setup)) continue;
        if (structure_of(setup) == structure) return true;
        aside_.push_back(run);
    }
    return false;
}

bool Crew::take(std::size_t& run) {
    if (first_ == last_ && again_.empty()) {
        const std::size_t runs = work_.variation.runs;
        first_ = std::min(runs, work_.next.fetch_add(runs_at_a_time));
        last_ = std::min(runs, first_ + runs_at_a_time);
    }
    if (first_ < last_) {
        run = first_++;
        return true;
    }
    if (again_.empty()) return false;
    run = again_.back();
    again_.pop_back();
    return true;
}

// False where there is nothing to simulate: its row is then filled in.
bool Crew::prepare(std::size_t run, Setup& setup) {
    const Variation& variation = work_.variation;
    for (std::size_t j = 0; j < variation.varied.size(); ++j)
        params_[variation.varied[j]] = variation.values[j * variation.runs + run];
    if (is_stopped()) return refuse(run, ARM3R_RUN_STOPPED), false;
    const std::optional<Setup> valid = work_.check(params_);
    if (!valid) return refuse(run, ARM3R_RUN_INVALID), false;
    setup = *valid;
    if (has_too_many_steps(setup)) return refuse(run, ARM3R_RUN_BUDGET), false;
    return true;
}

void Crew::store(std::size_t run, const Metrics& metrics) {
    double* cell = work_.results + run;
    for (const SummaryNumber& number : summary_table()) {
        *cell = number.of(metrics) + 0.0;
        cell += work_.variation.runs;
    }
    work_.done.fetch_add(1, std::memory_order_relaxed);
}

void Crew::refuse(std::size_t run, arm3r_outcome why) {
    for (std::size_t i = 0; i < summary_table().size(); ++i)
        work_.results[i * work_.variation.runs + run] = std::numeric_limits<double>::quiet_NaN();
    work_.results[run] = double(why);  // the outcome is the first column
    work_.done.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace arm3r
