// One controller at several instants, one row per lane: the laws of the lanes, with the same controller in every lane.

#include "arm3r/control/control_laws.hpp"
#include "arm3r/lanes.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/widths.hpp"
#include "control/compiled_laws.hpp"

namespace arm3r {
namespace {

template <class T>
void of_rows(const Controller<double>& controller, const Measurement<T>& sensed,
             const std::array<T, law_memory>& memory, Command<T>& command) {
    Controller<T> in_every_lane;
    copy_controller_choices(controller, in_every_lane);
    const auto copy = [](T& to, double from) { to = T(from); };
    each_law_number(copy, in_every_lane, controller);
    each_arm_number(copy, in_every_lane.model, controller.model);
    for (int i = 0; i < 3; ++i) copy(in_every_lane.torque[i], controller.torque[i]);
    compiled_law<T, T>()(in_every_lane, sensed, memory, command);
}

}  // namespace

#define ARM3R_COMPILED_LAW(T)               \
    template <>                             \
    LawFunction<double, T> compiled_law() { \
        return of_rows;                     \
    }
ARM3R_ROW_PACKS(ARM3R_COMPILED_LAW)

}  // namespace arm3r
