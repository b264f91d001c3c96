#pragma once
// Which motions have a Taylor kernel of their own; the program derive_taylor makes one for each line of the list.

#include <array>

#include "arm3r/plant.hpp"

namespace arm3r {

// What is expanded: the state; where the tip is on the plate: depth, across1, across2; and the work of each torque since.
enum : std::size_t { signals_size = 3, works_at = state_size + signals_size, quantities = works_at + 3 };

// What a motion is made of. `control`: a constant torque may also be none, with a torque of zero.
struct Recipe {
    Controls control = Controls::none;
    bool damping = false;   // and the books of control and damping
    bool azimuth = false;   // q1 matters: oblique gravity, or a wall
    bool signals = false;   // where the tip is on the plate
    bool force = false;     // the contact law holds
    bool friction = false;  // dry
};

// The cheapest first.
inline constexpr std::array recipes = [] {
    constexpr Controls torque = Controls::constant, gravity = Controls::gravity_compensation;
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
