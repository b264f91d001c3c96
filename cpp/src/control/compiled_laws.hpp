#pragma once
// The control laws (control_laws.hpp) as function pointers, compiled for the widest registers. The right-hand sides of
// all methods call them.

#include "arm3r/control/control_laws.hpp"
#include "arm3r/numbers/dual.hpp"
#include "arm3r/numbers/pack.hpp"

namespace arm3r {

inline constexpr int derivatives_per_pass = 10;  // of Dual: columns of the Jacobian that one evaluation computes

template <class P, class T>
LawFunction<P, T> compiled_law();

}  // namespace arm3r
