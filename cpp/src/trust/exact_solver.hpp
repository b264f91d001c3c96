#pragma once
// What a solution is computed with that others are compared with: steps end at contacts and jumps, whatever their place
// within the steps of another method.

#include "setup/setup.hpp"

namespace arm3r {

inline Solver exact_solver(Solver solver) {
    solver.method = SolverMethod::dopri5;
    solver.rtol = 1e-12, solver.atol = 1e-15;
    solver.max_step = infinite;
    return solver;
}

}  // namespace arm3r
