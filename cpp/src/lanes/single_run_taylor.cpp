#include "arm3r/numbers/eigen_traits.hpp"
#include "lanes/lane_taylor.hpp"
#include "lanes/single_run_template.hpp"

namespace arm3r {

SingleRunMethod single_run_by_taylor() { return single_run_by<LaneTaylor<double>>(); }

}  // namespace arm3r
