#pragma once
// The Jacobian of the right-hand side of y' = f(t, y) with respect to state and time, exact to rounding, by Dual. A
// state of N components begins with Motion components; Quadratures components come next, on which nothing depends; then
// the memory of a controller, of which the leading components are in use.

#include "arm3r/numbers/dual.hpp"
#include "arm3r/ode/integrators.hpp"

namespace arm3r {

// The index in the state of the k-th component that the motion depends on.
template <std::size_t Motion, std::size_t Quadratures>
constexpr std::size_t state_index(std::size_t k) {
    return k < Motion ? k : k + Quadratures;
}

template <std::size_t N>
struct Linearization {
    std::array<State<double, N>, N>
        df_dy;               // [i][j]: df_i/dy_j; the columns of the quadratures and of unused memory are undefined
    State<double, N> df_dt;  // df_i/dt
};

// f0 and its Jacobian at (t, y), with `memory` components of memory in use. f is a right-hand side over Dual<K>, called
// once for every K variables; its values have the bits of the one over double.
template <std::size_t Motion, std::size_t Quadratures, int K, std::size_t N, class F>
void linearize(F& f, double t, const State<double, N>& y, std::size_t memory, State<double, N>& f0,
               Linearization<N>& linearization) {
    using D = Dual<K>;
    const std::size_t moving = Motion + memory;
    for (std::size_t first = 0; first <= moving; first += K) {
        State<D, N> x, dx;
        for (std::size_t i = 0; i < N; ++i) x[i] = D(y[i]);
        for (std::size_t k = first; k < first + K && k < moving; ++k)
            x[state_index<Motion, Quadratures>(k)].slope[k - first] = 1.0;
        D now(t);
        if (moving < first + K) now.slope[moving - first] = 1.0;
        f.begin_step(x);
        f(now, x, dx);
        for (std::size_t i = 0; i < Motion + Quadratures + memory; ++i) {
            f0[i] = dx[i].number;
            for (std::size_t k = first; k < first + K && k < moving; ++k)
                linearization.df_dy[i][state_index<Motion, Quadratures>(k)] = dx[i].slope[k - first];
            if (moving < first + K) linearization.df_dt[i] = dx[i].slope[moving - first];
        }
    }
}

}  // namespace arm3r
