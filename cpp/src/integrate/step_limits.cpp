#include "integrate/step_limits.hpp"

#include <algorithm>
#include <cmath>

namespace arm3r {

double max_wall_step(const Wall<double>& wall) {
    double h = infinite;
    if (wall.motion == Motion::sinusoid) h = std::min(h, 1 / (16 * wall.sinusoid.frequency));
    if (wall.rotation == Rotation::sinusoid) h = std::min(h, 1 / (16 * wall.turn_sinusoid.frequency));
    if (wall.rotation == Rotation::constant) h = std::min(h, two_pi / (16 * std::abs(wall.turn_rate)));
    return h;
}

}  // namespace arm3r
