#pragma once
// Which motions have a Taylor kernel of their own; the program derive_taylor makes one for each line of the list.

#include <array>

#include "arm3r/plant.hpp"

namespace arm3r {

// The expanded quantities: the state; the place of the tip relative to the plate: depth, across1, across2; and the work
// of each torque.
enum : std::size_t { signals_size = 3, works_at = state_size + signals_size, quantities = works_at + 3 };

// The features of a motion. `control`: a constant torque may also be none, with a torque of zero.
struct Recipe {
    ControllerType control = ControllerType::none;
    bool damping = false;   // and the quadratures of control and damping
    bool azimuth = false;   // q1 matters: oblique gravity, or a wall
    bool signals = false;   // where the tip is on the plate
    bool force = false;     // the contact law acts
    bool friction = false;  // dry
};

// The cheapest first.
inline constexpr std::array recipes = [] {
    constexpr ControllerType torque = ControllerType::constant, gravity = ControllerType::gravity_compensation;
    return std::array{
        Recipe{},
        Recipe{torque, true},
        Recipe{gravity, true},
        Recipe{torque, true, true},
        Recipe{gravity, true, true},
        Recipe{torque, true, true, true},
        Recipe{gravity, true, true, true},
        Recipe{torque, true, true, true, true},
        Recipe{gravity, true, true, true, true},
        Recipe{torque, true, true, true, true, true},
        Recipe{gravity, true, true, true, true, true},
    };
}();

}  // namespace arm3r
