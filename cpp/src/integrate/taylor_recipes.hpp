#pragma once
// Which motions have a Taylor kernel of their own; the program derive_taylor makes one for each line of the list.

#include <array>

#include "arm3r/plant.hpp"

namespace arm3r {

// The expanded quantities: the state; the place of the tip relative to the plate: depth, across1, across2; and the work
// of each torque.
enum : std::size_t { signals_size = 3, works_at = state_size + signals_size, quantities = works_at + 3 };

// Where the torque of a motion comes from. A held torque may also be zero.
enum class TorqueSource { none, held, gravity_compensation };

// The features of a motion.
struct Recipe {
    TorqueSource torque = TorqueSource::none;
    bool damping = false;    // and the quadratures of torque and damping
    bool signals = false;    // where the tip is on the plate
    bool force = false;      // the contact law acts
    bool oblique = false;    // gravity
    bool friction = false;   // dry
    bool even_wall = false;  // it stands still or moves at one velocity
    bool elbow = false;      // an elbow arm, whose rotors spin along their joints
};

// The cheapest first. With oblique gravity or friction, and with an elbow arm, a wall that does not press is one of no stiffness.
inline constexpr std::array recipes = [] {
    constexpr TorqueSource held = TorqueSource::held, gravity = TorqueSource::gravity_compensation;
    return std::array{
        Recipe{},
        Recipe{held, true},
        Recipe{gravity, true},
        Recipe{.torque = gravity, .signals = true, .even_wall = true},
        Recipe{held, true, true},
        Recipe{gravity, true, true},
        Recipe{.torque = gravity, .signals = true, .force = true, .even_wall = true},
        Recipe{held, true, true, true},
        Recipe{gravity, true, true, true},
        Recipe{held, true, false, false, true},
        Recipe{gravity, true, false, false, true},
        Recipe{held, true, true, true, true},
        Recipe{gravity, true, true, true, true},
        Recipe{held, true, true, true, true, true},
        Recipe{gravity, true, true, true, true, true},
        Recipe{.torque = held, .damping = true, .elbow = true},
        Recipe{.torque = gravity, .damping = true, .elbow = true},
        Recipe{.torque = held, .damping = true, .signals = true, .force = true, .elbow = true},
        Recipe{.torque = gravity, .damping = true, .signals = true, .force = true, .elbow = true},
        Recipe{held, true, true, true, true, true, false, true},
        Recipe{gravity, true, true, true, true, true, false, true},
    };
}();

}  // namespace arm3r
