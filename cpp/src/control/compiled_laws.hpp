#pragma once
// The control laws (laws.hpp) behind pointers, built for the widest registers that there are: the right-hand sides of all
// methods call these.

#include "arm3r/control/laws.hpp"
#include "arm3r/numbers/dual.hpp"
#include "arm3r/numbers/pack.hpp"

namespace arm3r {

inline constexpr int slopes_at_once = 10;  // of Dual, in the Jacobian of a stiff method

template <class P, class T>
LawFunction<P, T> compiled_law();

}  // namespace arm3r
