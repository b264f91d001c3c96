// One controller per lane.

#include "control/compiled_laws.hpp"

#include "arm3r/numbers/eigen_traits.hpp"

namespace arm3r {
namespace {

template <class T>
using Memory = std::array<T, law_memory>;

void of_two(const Controller<Pack<2>>& controller, const Measurement<Pack<2>>& sensed, const Memory<Pack<2>>& memory,
            Command<Pack<2>>& command) {
    control_law(controller, sensed, memory, command);
}

#if ARM3R_WIDE_PACKS
ARM3R_FOR_FOUR void of_four(const Controller<Pack<4>>& controller, const Measurement<Pack<4>>& sensed,
                            const Memory<Pack<4>>& memory, Command<Pack<4>>& command) {
    control_law(controller, sensed, memory, command);
}

ARM3R_FOR_EIGHT void of_eight(const Controller<Pack<8>>& controller, const Measurement<Pack<8>>& sensed,
                              const Memory<Pack<8>>& memory, Command<Pack<8>>& command) {
    control_law(controller, sensed, memory, command);
}
#endif

}  // namespace

template <>
LawFunction<Pack<2>, Pack<2>> compiled_law() {
    return of_two;
}

#if ARM3R_WIDE_PACKS
template <>
LawFunction<Pack<4>, Pack<4>> compiled_law() {
    return of_four;
}

template <>
LawFunction<Pack<8>, Pack<8>> compiled_law() {
    return of_eight;
}
#endif

}  // namespace arm3r
