#pragma once
// One thread's share of a batch: takes runs from the common supply, lets them march in lanes, fills in their rows.

#include <atomic>
#include <span>
#include <vector>

#include "batch/batch.hpp"
#include "lanes/lane_run.hpp"
#include "validate/validate.hpp"

namespace arm3r {

// What the threads of a batch share. The rows are each written by one thread.
struct Work {
    const Variation& variation;
    const Checker check;
    double* const results;
    const int lanes;  // as BatchOptions::lanes
    std::atomic<std::size_t> next = 0, done = 0;
    std::atomic<bool> stop = false;
};

class Crew {
public:
    explicit Crew(Work& work);

    // Until the supply is used up.
    void run();

    // The next run whose structure is `structure`; those of others are put aside.
    bool next(const Structure& structure, Setup& setup, std::size_t& run);
    void store(std::size_t run, const Metrics& metrics);
    void refuse(std::size_t run, arm3r_outcome why);  // not begun: its row has no other number
    bool is_stopped() const { return work_.stop.load(std::memory_order_relaxed); }

private:
    bool take(std::size_t& run);
    bool prepare(std::size_t run, Setup& setup);
    void march(const Setup& first, std::size_t run);

    Work& work_;
    std::vector<double> params_;
    std::size_t first_ = 0, last_ = 0;  // what is left of the runs taken from the supply
    std::vector<std::size_t> again_, aside_;
};

}  // namespace arm3r
