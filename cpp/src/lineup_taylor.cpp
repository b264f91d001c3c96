#include "lineup.hpp"
#include "taylor_march.hpp"

namespace arm3r {

void march_by_taylor(int lanes, Crew& crew, const Setup& first, std::size_t run) {
    Lineups<TaylorMarch>::of(lanes, crew, first, run);
}

}  // namespace arm3r
