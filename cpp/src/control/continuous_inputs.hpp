#pragma once
// What a continuous controller knows besides the state: the true contact, constant within a step.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

struct ContinuousInputs {
    double contact = 0, force_phase = 0;  // 1 or 0

    // Updates them after a change of contact; the law's integral is reset when contact ends (7.4).
    void update(const ControllerChoices& controller, bool is_touching, double& integral) {
        contact = is_touching ? 1 : 0;
        force_phase = force_phase_after(controller.switching, contact, force_phase);
        if (!is_touching && integrates_force(controller.type)) integral = 0;
    }
};

}  // namespace arm3r
