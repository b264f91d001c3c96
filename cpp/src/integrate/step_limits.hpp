#pragma once
// How long a step may be for the sake of the wall, which no error estimate sees; docs/model.md (5.2). All in s.

#include "arm3r/plant.hpp"

namespace arm3r {

// A sixteenth of the period with which the wall swings or turns.
double longest_look(const Wall<double>& wall);

// A quarter of the shortest half period of the present contact, so that it cannot come and go within a step;
// infinite for one so damped that it does not swing.
double contact_time(const Plant<double>& plant, const WallState<double>& wall, const Pose<double>& p,
                    const Indentation<double>& in);

// Nine tenths of the time after which a contact of Hunt and Crossley ends at its present rate, for no error estimate sees what
// a step beyond depth 0 gets wrong; but not less than the time in which the spring gives out a negligible rest of its energy.
// Infinite for other laws, and while the depth grows.
double time_to_break(const Contact<double>& contact, const Indentation<double>& in, double contact_time, double rtol);

}  // namespace arm3r
