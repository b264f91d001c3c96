#pragma once
// What a control law remembers, at the start. The plant knows this and the address of a law, and not the laws
// (control_laws.hpp): a change of a law compiles the files of the laws alone.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

// The memory of the law at the start.
template <class P, class T>
ARM3R_INLINE std::array<T, law_memory> memory_at_start(const Controller<P>& controller, const Measurement<T>& sensed) {
    std::array<T, law_memory> memory;
    for (T& number : memory) number = T(0.0);
    if (controller.type == ControllerType::admittance) {
        const DesiredMotion<T> desired = desired_motion_at(controller.reference, sensed.t);
        for (std::size_t i = 0; i < 3; ++i) {
            memory[i] = desired.position[i];
            memory[3 + i] = desired.velocity[i];
        }
    }
    if (controller.type == ControllerType::energy_tank) memory[0] = T(controller.gains.tank_energy);
    return memory;
}

}  // namespace arm3r
