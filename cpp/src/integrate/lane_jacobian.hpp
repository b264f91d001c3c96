#pragma once
// The Jacobian of the equations of motion of one lane, exact to rounding, by Dual: what the stiff method needs; docs/model.md
// (5.6). It is compiled once, for lanes of any width.

#include <optional>

#include "arm3r/ode/linearization.hpp"
#include "arm3r/plant.hpp"
#include "control/compiled_laws.hpp"

namespace arm3r {

// What the equations of a lane take besides time and state, constant within a step.
struct LaneInputs {
    ContactForceMode force_mode;
    bool touching, separated;
    double contact, force_phase, latest;
    Vec3<double> held_torque;
};

// N is state_size, or full_size where a controller remembers something.
template <std::size_t N>
class LaneJacobian {
public:
    void load(const Plant<double>& plant);
    // f and its Jacobian at (t, y), with `memory` components of a controller in use.
    void find(const LaneInputs& inputs, double t, const State<double, N>& y, std::size_t memory, State<double, N>& f0,
              Linearization<N>& jacobian);

private:
    using D = Dual<derivatives_per_pass>;

    std::optional<Plant<double>> plant_;
    std::optional<RightHandSide<double, D>> rhs_;
};

// The fastest rate of the equations, 1/s: from df/dy of the velocities, and from the square root of that of the
// positions.
template <std::size_t N>
double fastest_answer(const Linearization<N>& jacobian);

}  // namespace arm3r
