#pragma once
// Parameters that differ from run to run in a few numbers.

#include <span>

namespace arm3r {

// Run i has `params`, but values[j*runs + i] in the place of number varied[j].
struct Variation {
    std::span<const double> params;
    std::span<const std::size_t> varied;
    std::span<const double> values;
    std::size_t runs;

    // Writes the varied numbers of a run into a copy of `params`.
    void put(std::size_t run, std::span<double> copy) const {
        for (std::size_t j = 0; j < varied.size(); ++j) copy[varied[j]] = values[j * runs + run];
    }
};

// Throws Error where a varied number does not exist, is named twice, or stands for a choice; or where a number in
// `params` that stands for a choice is none of its words.
void check_variation(const Variation& variation);

}  // namespace arm3r
