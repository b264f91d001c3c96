#pragma once
// The control laws with gains: each computes a torque from the measurements; docs/model.md, section 7. Each is the
// formula of its paper, for any number type. Slide convention.

#include "arm3r/control/adaptive_reference.hpp"
#include "arm3r/control/admittance.hpp"
#include "arm3r/control/energy_tank.hpp"
#include "arm3r/control/force_laws.hpp"
#include "arm3r/control/impedance_laws.hpp"
#include "arm3r/control/motion_laws.hpp"
#include "arm3r/control/virtual_wall.hpp"

namespace arm3r {

template <class P, class T>
ARM3R_INLINE void control_law(const Controller<P>& controller, const Measurement<T>& sensed,
                              const std::array<T, law_memory>& memory, Command<T>& command) {
    for (T& rate : command.rates) rate = T(0.0);
    command.dtau_dintegral = zero_vector<T>();
    switch (controller.type) {
        case ControllerType::joint_pd: command.tau = joint_pd(controller, sensed); return;
        case ControllerType::computed_torque: command.tau = computed_torque(controller, sensed); return;
        case ControllerType::resolved_acceleration: command.tau = resolved_acceleration(controller, sensed); return;
        case ControllerType::stiffness: command.tau = stiffness_control(controller, sensed); return;
        case ControllerType::joint_stiffness: command.tau = joint_stiffness_control(controller, sensed); return;
        case ControllerType::impedance: command.tau = impedance_control(controller, sensed); return;
        case ControllerType::shaped_impedance: command.tau = shaped_impedance(controller, sensed); return;
        case ControllerType::operational_space:
        case ControllerType::hybrid:
        case ControllerType::parallel: return force_law(controller, sensed, memory[0], command);
        case ControllerType::admittance: return admittance_control(controller, sensed, memory, command);
        case ControllerType::adaptive_reference: return adaptive_reference(controller, sensed, memory, command);
        case ControllerType::energy_tank: return energy_tank(controller, sensed, memory[0], command);
        case ControllerType::virtual_wall: command.tau = virtual_wall(controller, sensed); return;
        default: command.tau = feedforward_torque(controller, sensed.q, sensed.pose); return;
    }
}

// The same function with an address.
template <class P, class T>
void generic_control_law(const Controller<P>& controller, const Measurement<T>& sensed,
                         const std::array<T, law_memory>& memory, Command<T>& command) {
    control_law(controller, sensed, memory, command);
}

}  // namespace arm3r
