#include "arm3r/numbers/eigen_traits.hpp"
#include "lanes/single_rk4.hpp"
#include "lanes/single_run_template.hpp"

namespace arm3r {

SingleRunMethod single_run_on_grid() { return single_run_by<SingleRk4>(); }
SingleRunMethod single_run_on_grid_with_memory() { return single_run_by<LaneRk4<double, full_size>>(); }

}  // namespace arm3r
