#pragma once
// Runs of one structure side by side in the lanes of a thread; each method is built in a file of its own.

#include "batch/worker.hpp"

namespace arm3r {

// The run and those of its structure that follow, in lanes (lineup.hpp): by RK4, by RK4 with a continuous controller's
// memory in the state, by power series.
void march_by_rk4(int lanes, Crew& crew, const Setup& first, std::size_t run);
void march_with_memory(int lanes, Crew& crew, const Setup& first, std::size_t run);
void march_by_taylor(int lanes, Crew& crew, const Setup& first, std::size_t run);

}  // namespace arm3r
