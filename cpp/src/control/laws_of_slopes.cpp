// With slopes, for the Jacobian of a stiff method.

#include "control/compiled_laws.hpp"

#include "arm3r/numbers/eigen_traits.hpp"

namespace arm3r {
namespace {

template <class T>
using Memory = std::array<T, law_memory>;

void of_dual(const Controller<double>& controller, const Sensed<Dual<slopes_at_once>>& sensed,
             const Memory<Dual<slopes_at_once>>& memory, Command<Dual<slopes_at_once>>& command) {
    law(controller, sensed, memory, command);
}

}  // namespace

template <>
LawFunction<double, Dual<slopes_at_once>> compiled_law() {
    return of_dual;
}

}  // namespace arm3r
