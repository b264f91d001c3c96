#pragma once
// The instants at which formulas of time alone change: of the wall's course, the setpoint, a push; docs/model.md (5.8).

#include "setup/setup.hpp"

namespace arm3r {

// The next instant after t at which the wall's course changes its formula; infinite for none.
double next_knot(const Wall<double>& wall, double t);

// The next instant after t, s, at which a formula of time alone changes: of the wall's course, the setpoint, a load.
double next_knot(const Setup& setup, double t);
// The next at which what it gives jumps, so that the steps before and after see different values; and the instant before.
double next_jump(const Setup& setup, double t);
double just_before(double t);

// Jumps that lie on a sample, on the end of a fixed step or of the run, but for rounding, are put there to the bit.
void set_jumps_on_clock(Setup& setup);

}  // namespace arm3r
