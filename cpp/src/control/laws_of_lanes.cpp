// One controller per lane.

#include "arm3r/control/control_laws.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/widths.hpp"
#include "control/compiled_laws.hpp"

namespace arm3r {
namespace {

struct ControlLaw {
    template <class T>
    ARM3R_INLINE void operator()(const Controller<T>& controller, const Measurement<T>& sensed,
                                 const std::array<T, law_memory>& memory, Command<T>& command) const {
        control_law(controller, sensed, memory, command);
    }
};

}  // namespace

#define ARM3R_COMPILED_LAW(T)                                                             \
    template <>                                                                           \
    LawFunction<T, T> compiled_law() {                                                    \
        return Outlined<T>::call<ControlLaw, const Controller<T>&, const Measurement<T>&, \
                                 const std::array<T, law_memory>&, Command<T>&>;          \
    }                                                                                     \
    ARM3R_CALLED_BY_LAWS(, T, T)
ARM3R_PACKS(ARM3R_COMPILED_LAW)

}  // namespace arm3r
