#include "lanes/lane_run_members.hpp"

namespace arm3r {

#define ARM3R_WITH_MEMORY(T) ARM3R_LANE_RUN(T, full_size)
ARM3R_LANE_TYPES(ARM3R_WITH_MEMORY)

}  // namespace arm3r
