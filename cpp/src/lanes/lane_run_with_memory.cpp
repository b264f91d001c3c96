#include "lanes/lane_run_members.hpp"

namespace arm3r {

ARM3R_LANE_RUN(double, full_size)
#if !ARM3R_ONE_LANE
ARM3R_LANE_RUN(Pack<2>, full_size)
#endif
#if ARM3R_WIDE_PACKS
ARM3R_LANE_RUN(Pack<4>, full_size)
ARM3R_LANE_RUN(Pack<8>, full_size)
#endif

}  // namespace arm3r
