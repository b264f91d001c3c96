#include "arm3r/numbers/eigen_traits.hpp"
#include "lanes/lane_taylor.hpp"
#include "lanes/single_run_template.hpp"

namespace arm3r {

template void LaneTaylor<double>::step_outlined();
template bool LaneTaylor<double>::take_step_outlined();
template void LaneTaylor<double>::finish_step_outlined();

SingleRunMethod single_run_by_taylor() { return single_run_by<LaneTaylor<double>>(); }

}  // namespace arm3r
