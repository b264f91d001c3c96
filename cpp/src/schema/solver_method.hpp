#pragma once

namespace arm3r {

enum class SolverMethod { dopri5, rk4, taylor, rodas4, automatic };  // (5.1) to (5.7)
enum class StepEvents { grid, located };  // of rk4: whether a step ends where contact or a formula of time changes

}  // namespace arm3r
