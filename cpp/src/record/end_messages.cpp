#include "record/end_messages.hpp"

#include <cmath>

#include "arm3r/numbers/elementary.hpp"
#include "base/number_text.hpp"
#include "record/row.hpp"

namespace arm3r {

std::string at_time(double t) { return " at t = " + shortest(t) + " s"; }

std::string step_budget_message(double t) { return "solver.max_steps is used up" + at_time(t); }

std::string event_storm_message(double t) {
    return "more than 4096 contact events, the last at t = " + shortest(t) + " s";
}

std::string step_collapse_message(double h, double t) {
    return "the step fell to " + shortest(h) + " s" + at_time(t) +
           ": the motion changes faster than the clock resolves";
}

std::string ill_conditioned_message(double t) {
    return "the mass matrix is no longer positive definite to rounding" + at_time(t);
}

std::string divergence_message(const std::array<double, 3>& q, const std::array<double, 3>& qd, double t) {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string joint = "joint " + std::to_string(i + 1);
        if (!(std::abs(q[i]) <= sincos_limit)) return joint + " turned beyond 1e5 rad" + at_time(t);
        if (!(std::abs(qd[i]) <= rate_limit))
            return joint + " turns at " + rounded(qd[i], 3) + " rad/s" + at_time(t) + ", beyond 1e5 rad/s";
    }
    return "the motion is no longer finite after t = " + shortest(t) + " s";
}

}  // namespace arm3r
