#pragma once
// The instants at which formulas of time change: of the wall's motion, the reference, an external force; docs/model.md
// (5.8).

#include "setup/setup.hpp"

namespace arm3r {

// The next instant after t at which the formula of the wall's motion changes; infinite for none.
double next_knot(const Wall<double>& wall, double t);
// The same for a reference: of the motion or of the force.
double next_knot(const Reference<double>& reference, double t);

// The next instant after t, s, at which a formula of time changes: of the wall's motion, the reference, an external
// force. A sampled controller sees its reference at samples only, but its metrics (8.10) at every instant.
double next_knot(const Setup& setup, double t);
// The next instant at which the value of such a formula jumps, so that the steps before and after it use different
// values; and the instant before.
double next_jump(const Setup& setup, double t);
double just_before(double t);

// Moves jumps that differ by rounding only from the end of the run, from a sample or the end of a fixed step exactly onto
// it.
void set_jumps_on_clock(Setup& setup);

// The jumps within steps: of fixed ones, since the others end there.
std::vector<double> jumps_within_steps(const Setup& setup);

}  // namespace arm3r
