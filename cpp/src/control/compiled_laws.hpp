#pragma once
// The control laws (control_laws.hpp) as function pointers, compiled for the widest registers. The right-hand sides of
// all methods call them.

#include "arm3r/control/controllers.hpp"
#include "arm3r/numbers/dual.hpp"
#include "arm3r/numbers/pack.hpp"
#include "arm3r/numbers/widths.hpp"

namespace arm3r {

inline constexpr int derivatives_per_pass = 10;  // of Dual: columns of the Jacobian that one evaluation computes

template <class P, class T>
LawFunction<P, T> compiled_law();

// Long functions that laws call and are not inlined are compiled once, with the laws.
#define ARM3R_CALLED_BY_LAWS(external, P, T)                                                            \
    external template Vec3<T> recursion_inverse_dynamics(const Arm<P>&, const Vec3<T>&, const Vec3<T>&, \
                                                         const Vec3<T>&, const Vec3<T>&);               \
    external template void follow_table(const Reference<P>&, const T&, DesiredMotion<T>&);
#define ARM3R_CALLED_BY_LAWS_OF_LANES(T) ARM3R_CALLED_BY_LAWS(extern, T, T)
ARM3R_CALLED_BY_LAWS(extern, double, double)
ARM3R_CALLED_BY_LAWS(extern, double, Dual<derivatives_per_pass>)
ARM3R_PACKS(ARM3R_CALLED_BY_LAWS_OF_LANES)

}  // namespace arm3r
