// One instant.

#include "control/compiled_laws.hpp"

#include "arm3r/control/control_laws.hpp"
#include "arm3r/numbers/eigen_traits.hpp"

namespace arm3r {
namespace {

template <class T>
using Memory = std::array<T, law_memory>;

void of_double(const Controller<double>& controller, const Measurement<double>& sensed, const Memory<double>& memory,
               Command<double>& command) {
    control_law(controller, sensed, memory, command);
}

}  // namespace

template <>
LawFunction<double, double> compiled_law() {
    return of_double;
}
ARM3R_CALLED_BY_LAWS(, double, double)

}  // namespace arm3r
