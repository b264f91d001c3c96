#include "batch/lane_group.hpp"
#include "batch/lane_group_template.hpp"
#include "lanes/lane_taylor.hpp"

namespace arm3r {

void march_by_taylor(int lanes, Crew& crew, const Setup& first, std::size_t run) {
    Lineups<TaylorMarch>::of(lanes, crew, first, run);
}

}  // namespace arm3r
