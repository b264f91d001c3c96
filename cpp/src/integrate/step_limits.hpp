#pragma once
// Limits of the step because of the wall, which error estimates do not see; docs/model.md (5.2). All in s.

#include "arm3r/plant.hpp"

namespace arm3r {

// A sixteenth of the period of the wall's oscillation or rotation.
double max_wall_step(const Wall<double>& wall);

// A quarter of the shortest half period of the present contact, so that contact cannot begin and end within a step;
// infinite if the contact is damped so much that it does not oscillate.
double contact_time(const Plant<double>& plant, const WallState<double>& wall, const Pose<double>& p,
                    const Indentation<double>& in);

// Nine tenths of the time after which a contact of Hunt and Crossley ends at its present rate, because error estimates
// do not see the error of a step beyond depth 0; but not less than the time in which the spring loses a negligible part
// of its energy. Infinite for other laws, and while the depth grows.
double time_to_break(const Contact<double>& contact, const Indentation<double>& in, double contact_time, double rtol);

}  // namespace arm3r
