#pragma once
// The control laws with gains: what a controller does with what it senses; docs/model.md, section 7. Each is the formula of
// its paper, for any number type. Slide convention.

#include "arm3r/control/adaptive_reference.hpp"
#include "arm3r/control/admittance.hpp"
#include "arm3r/control/energy_tank.hpp"
#include "arm3r/control/force_laws.hpp"
#include "arm3r/control/impedance_laws.hpp"
#include "arm3r/control/motion_laws.hpp"
#include "arm3r/control/virtual_wall.hpp"

namespace arm3r {

// What the law remembers at the start.
template <class P, class T>
ARM3R_INLINE std::array<T, law_memory> memory_at_start(const Controller<P>& controller, const Sensed<T>& sensed) {
    std::array<T, law_memory> memory;
    for (T& number : memory) number = T(0.0);
    if (controller.type == Controls::admittance) {
        const Wanted<T> wanted = wanted_at(controller.setpoint, sensed.t);
        for (std::size_t i = 0; i < 3; ++i) {
            memory[i] = wanted.position[i];
            memory[3 + i] = wanted.velocity[i];
        }
    }
    if (controller.type == Controls::energy_tank) memory[0] = T(controller.gains.tank_energy);
    return memory;
}

template <class P, class T>
ARM3R_INLINE void law(const Controller<P>& controller, const Sensed<T>& sensed, const std::array<T, law_memory>& memory,
                      Command<T>& command) {
    for (T& rate : command.rates) rate = T(0.0);
    command.per_integral = none<T>();
    switch (controller.type) {
        case Controls::joint_pd: command.tau = joint_pd(controller, sensed); return;
        case Controls::computed_torque: command.tau = computed_torque(controller, sensed); return;
        case Controls::resolved_acceleration: command.tau = resolved_acceleration(controller, sensed); return;
        case Controls::stiffness: command.tau = stiffness_control(controller, sensed); return;
        case Controls::joint_stiffness: command.tau = joint_stiffness_control(controller, sensed); return;
        case Controls::impedance: command.tau = impedance_control(controller, sensed); return;
        case Controls::shaped_impedance: command.tau = shaped_impedance(controller, sensed); return;
        case Controls::operational_space:
        case Controls::hybrid:
        case Controls::parallel: return force_law(controller, sensed, memory[0], command);
        case Controls::admittance: return admittance_control(controller, sensed, memory, command);
        case Controls::adaptive_reference: return adaptive_reference(controller, sensed, memory, command);
        case Controls::energy_tank: return energy_tank(controller, sensed, memory[0], command);
        case Controls::virtual_wall: command.tau = virtual_wall(controller, sensed); return;
        default: command.tau = control(controller, sensed.q, sensed.pose); return;
    }
}

// The same behind a pointer.
template <class P, class T>
void law_by_template(const Controller<P>& controller, const Sensed<T>& sensed, const std::array<T, law_memory>& memory,
                     Command<T>& command) {
    law(controller, sensed, memory, command);
}

}  // namespace arm3r
