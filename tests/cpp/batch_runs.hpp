#pragma once
// Batches of the tests and their condition: the numbers of each run are those of the run alone, bit for bit, for every
// width and number of threads.

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "arm3r/numbers/widths.hpp"

#include "batch/batch.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "record/metrics.hpp"

namespace arm3r {

// Runs that differ in some numbers: varied[j] is values[j][i] in run i.
struct Runs {
    Params base;
    std::vector<std::string> names;
    std::vector<std::vector<double>> values;

    std::size_t count() const { return values.front().size(); }

    Params alone(std::size_t run) const {
        Params params = base;
        for (std::size_t j = 0; j < names.size(); ++j) params.set(names[j], values[j][run]);
        return params;
    }

    std::vector<double> together(const BatchOptions& options) const {
        std::vector<std::size_t> varied;
        std::vector<double> flat;
        for (std::size_t j = 0; j < names.size(); ++j) {
            varied.push_back(param_index(names[j]));
            flat.insert(flat.end(), values[j].begin(), values[j].end());
        }
        std::vector<double> results(summary_table().size() * count(), -1);
        run_batch({base, varied, flat, count()}, options, results.data());
        return results;
    }

    double number(const std::vector<double>& results, std::string_view name, std::size_t run) const {
        for (std::size_t i = 0; i < summary_table().size(); ++i)
            if (summary_table()[i].name == name) return results[i * count() + run];
        throw std::invalid_argument("no such column");
    }
};

inline std::vector<int> widths() {
    std::vector<int> all;
    for (const int lanes : {1, 2, 4, 8})
        if (widest(LaneTypes{}, lanes) == lanes) all.push_back(lanes);
    return all;
}

// Both may be no number; else the bits decide.
inline bool same(double a, double b) { return same_bits(a, b) || (std::isnan(a) && std::isnan(b)); }

inline void check_against_single_runs(const Runs& runs, const std::vector<double>& results) {
    for (std::size_t i = 0; i < runs.count(); ++i) {
        const Run alone = runs.alone(i).run();
        for (std::size_t c = 0; c < summary_table().size(); ++c) {
            const double together = results[c * runs.count() + i], single = summary_table()[c].of(alone) + 0.0;
            CHECK(same(together, single),
                  "run " << i << ", " << summary_table()[c].name << ": " << together << " and " << single);
        }
    }
}

// Every width and number of threads gives the same table; it is returned.
inline std::vector<double> check_widths_and_threads(const Runs& runs) {
    const std::vector<double> reference = runs.together({.threads = 1, .lanes = 1});
    for (const int lanes : widths()) {
        for (const int threads : {1, 3}) {
            const std::vector<double> other = runs.together({.threads = threads, .lanes = lanes});
            CHECK((std::memcmp(other.data(), reference.data(), reference.size() * sizeof(double)) == 0),
                  lanes << " lanes, " << threads << " threads");
        }
    }
    return reference;
}

inline std::vector<double> spread(Random& random, double low, double high, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(random.in(low, high));
    return values;
}

}  // namespace arm3r
