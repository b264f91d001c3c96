#include "record/end_messages.hpp"

#include "base/number_text.hpp"

namespace arm3r {

std::string step_budget_message(double t) {
    return "solver.max_steps is used up at t = " + shortest(t) +
           " s; stiff friction or contact, or a tolerance too tight?";
}

std::string event_storm_message(double t) {
    return "more than 4096 contact events, the last at t = " + shortest(t) + " s";
}

}  // namespace arm3r
