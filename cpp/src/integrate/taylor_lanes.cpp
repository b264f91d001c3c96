#include "integrate/taylor_expand.hpp"

namespace arm3r {

#define ARM3R_EXPAND(T)                                                                                       \
    template void expand(Kernel, const Plant<T>&, const T&, const State<T, state_size>&, const Pose<T>&, int, \
                         Expansion<T>&);
ARM3R_LANE_PACKS(ARM3R_EXPAND)

}  // namespace arm3r
