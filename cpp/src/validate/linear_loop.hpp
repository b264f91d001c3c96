#pragma once
// The control loop linearised at rest in the pose of the start: how fast its fastest mode grows, free and in contact.
// What has no linearisation is left out: dry friction, limits, quantisation, noise, switching; and so is gravity, which a
// law compensates or which is none of its loop.

#include <optional>

#include "setup/setup.hpp"

namespace arm3r {

// 1/s: slower growth is not told from rounding, or does not show within a run.
inline constexpr double least_growth = 0.1;

struct LoopGrowth {
    double per_second;  // 1/s, of the logarithm of the fastest mode; below 0: an upper bound
    double period;      // s, of sampling; 0: a continuous loop
};

// Where the tip is: free, or in a wall that stands still and pushes with the force that the law wants, or hardly at all.
enum class TipPlace { free, in_contact };

// Empty where there is no such loop: no law, one of the user's own, one that keeps a reserve of energy, no wall that acts on the arm; or where
// delays make it too large. The second form takes another period of sampling, s; delays stay the same in samples.
std::optional<LoopGrowth> loop_growth(const Setup& setup, TipPlace place);
std::optional<LoopGrowth> loop_growth(const Setup& setup, TipPlace place, double period);

// 1/s: of the fastest mode of a continuous loop, free or in contact, whichever is faster.
std::optional<double> fastest_rate(const Setup& setup);

}  // namespace arm3r
