#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "lanes/lane_rk4.hpp"

namespace arm3r {

template <class T>
using MarchWithMemory = FixedMarch<T, full_size>;

void march_with_memory(int lanes, Crew& crew, const Setup& first, std::size_t run) {
    Lineups<MarchWithMemory>::of(lanes, crew, first, run);
}

}  // namespace arm3r
