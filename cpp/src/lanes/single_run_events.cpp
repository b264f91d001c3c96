#include "arm3r/numbers/eigen_traits.hpp"
#include "lanes/lane_events.hpp"
#include "lanes/single_run_template.hpp"

namespace arm3r {

SingleRunMethod single_run_to_events() { return single_run_by<LaneEvents<double, state_size>>(); }

}  // namespace arm3r
