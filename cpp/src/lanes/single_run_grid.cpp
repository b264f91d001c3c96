#include "arm3r/numbers/eigen_traits.hpp"
#include "lanes/single_rk4.hpp"
#include "lanes/single_run_template.hpp"

namespace arm3r {

template void LaneRk4<double, state_size>::step_outlined();
template bool LaneRk4<double, state_size>::take_step_outlined();
template void LaneRk4<double, state_size>::finish_step_outlined();
template void LaneRk4<double, full_size>::step_outlined();
template bool LaneRk4<double, full_size>::take_step_outlined();
template void LaneRk4<double, full_size>::finish_step_outlined();

SingleRunMethod single_run_on_grid() { return single_run_by<SingleRk4>(); }
SingleRunMethod single_run_on_grid_with_memory() { return single_run_by<LaneRk4<double, full_size>>(); }

}  // namespace arm3r
