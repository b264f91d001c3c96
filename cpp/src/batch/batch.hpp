#pragma once
// Many runs that differ in numbers, on several threads. Each row of the table has the same bits as the run alone.

#include <cstdint>
#include <optional>
#include <span>

#include "arm3r/arm3r.h"
#include "batch/batch_rows.hpp"

namespace arm3r {

// A law of the user's for every run, as arm3r_batch_law describes it.
struct BatchLaw {
    arm3r_law function = nullptr;
    void* user = nullptr;
    std::size_t user_stride = 0;  // bytes
    bool reentrant = false;
};

struct BatchOptions {
    const volatile std::int32_t* stop = nullptr;
    arm3r_batch_progress progress = nullptr;
    void* user = nullptr;
    int threads = 0;  // 0: as many as the CPUs that this process may use
    int lanes = 0;    // 1, 2, 4 or 8; 0: as is fastest
    std::optional<BatchRows> rows = {};
    std::optional<std::span<const std::size_t>> summary = {};  // the columns that are wanted; none given: all
    BatchLaw law = {};
};

// results: the columns that are wanted, of summary_table(), `runs` numbers each. Throws Error where the base or the
// variation is not valid.
void run_batch(const Variation& variation, const BatchOptions& options, double* results);

}  // namespace arm3r
