#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "lanes/lane_rk4.hpp"

namespace arm3r {

template <class T>
using PlainMarch = FixedMarch<T>;

void march_by_rk4(int lanes, Crew& crew, const Setup& first, std::size_t run) {
    Lineups<PlainMarch>::of(lanes, crew, first, run);
}

}  // namespace arm3r
