// With derivatives, for the Jacobian of a stiff method.

#include "control/compiled_laws.hpp"

#include "arm3r/control/control_laws.hpp"
#include "arm3r/numbers/eigen_traits.hpp"

namespace arm3r {
namespace {

template <class T>
using Memory = std::array<T, law_memory>;

void of_dual(const Controller<double>& controller, const Measurement<Dual<derivatives_per_pass>>& sensed,
             const Memory<Dual<derivatives_per_pass>>& memory, Command<Dual<derivatives_per_pass>>& command) {
    control_law(controller, sensed, memory, command);
}

}  // namespace

template <>
LawFunction<double, Dual<derivatives_per_pass>> compiled_law() {
    return of_dual;
}
ARM3R_CALLED_BY_LAWS(, double, Dual<derivatives_per_pass>)

}  // namespace arm3r
