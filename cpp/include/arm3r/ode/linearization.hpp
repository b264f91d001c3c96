#pragma once
// How the right-hand side of y' = f(t, y) changes with state and time, exact to rounding, by Dual. A state of N components
// begins with Motion that move; Books quadratures come next, on which nothing depends; then the memory of a controller,
// of which the leading ones are in use.

#include "arm3r/numbers/dual.hpp"
#include "arm3r/ode/integrators.hpp"

namespace arm3r {

// The place in the state of the k-th component that the motion depends on.
template <std::size_t Motion, std::size_t Books>
constexpr std::size_t place_of(std::size_t k) {
    return k < Motion ? k : k + Books;
}

template <std::size_t N>
struct Linearization {
    std::array<State<double, N>, N>
        by_state;              // [i][j]: df_i/dy_j; columns of the books and of idle memory mean nothing
    State<double, N> by_time;  // df_i/dt
};

// f0 and its derivatives at (t, y), with `memory` components of memory in use. f is a right-hand side over Dual<K>, asked
// once for every K of state and time; its values have the bits of the one over double.
template <std::size_t Motion, std::size_t Books, int K, std::size_t N, class F>
void linearize(F& f, double t, const State<double, N>& y, std::size_t memory, State<double, N>& f0,
               Linearization<N>& slopes) {
    using D = Dual<K>;
    const std::size_t moving = Motion + memory;
    for (std::size_t first = 0; first <= moving; first += K) {
        State<D, N> x, dx;
        for (std::size_t i = 0; i < N; ++i) x[i] = D(y[i]);
        for (std::size_t k = first; k < first + K && k < moving; ++k)
            x[place_of<Motion, Books>(k)].slope[k - first] = 1.0;
        D now(t);
        if (moving < first + K) now.slope[moving - first] = 1.0;
        f.begin_step(x);
        f(now, x, dx);
        for (std::size_t i = 0; i < Motion + Books + memory; ++i) {
            f0[i] = dx[i].number;
            for (std::size_t k = first; k < first + K && k < moving; ++k)
                slopes.by_state[i][place_of<Motion, Books>(k)] = dx[i].slope[k - first];
            if (moving < first + K) slopes.by_time[i] = dx[i].slope[moving - first];
        }
    }
}

}  // namespace arm3r
