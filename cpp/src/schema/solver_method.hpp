#pragma once

namespace arm3r {

enum class SolverMethod { dopri5, rk4, taylor, rodas4, automatic };  // (5.1) to (5.7)

}  // namespace arm3r
