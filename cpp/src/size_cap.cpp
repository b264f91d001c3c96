#include "size_cap.hpp"

#include <algorithm>

#include "columns.hpp"
#include "numbers.hpp"

namespace arm3r {
namespace {

constexpr double most_bytes = 2e9;
constexpr double most_fixed_steps = 1e9;

double rounded(double count) { return count < 1e15 ? nearest_integer(count) : count; }

void refuse_above(double needed, double most, Problem problem) {
    if (needed <= most) return;
    problem.got = "about " + shortest(rounded(needed));
    problem.allowed = "at most " + shortest(rounded(most));
    throw Error(ARM3R_E_SIZE_CAP, {std::move(problem)});
}

double fixed_steps_allowed(const Solver& solver) { return std::min(most_fixed_steps, solver.max_steps); }

}  // namespace

bool has_too_many_steps(const Setup& setup) {
    return setup.solver.method == Solver::rk4 && setup.stop / setup.solver.step > fixed_steps_allowed(setup.solver);
}

void refuse_too_large(const Setup& setup, bool rows) {
    if (rows)
        refuse_above(setup.stop / setup.log_every, most_bytes / double(columns_of(setup).size() * sizeof(double)),
                     {.code = "budget.rows",
                      .path = "time.log_every",
                      .message = "the run would need too many rows",
                      .got = "",
                      .allowed = "",
                      .hint = "log less often"});
    if (has_too_many_steps(setup))
        refuse_above(setup.stop / setup.solver.step, fixed_steps_allowed(setup.solver),
                     {.code = "budget.steps",
                      .path = "solver.step",
                      .message = "the run would need too many steps",
                      .got = "",
                      .allowed = "",
                      .hint = "take a larger step, or raise solver.max_steps"});
}

std::vector<std::size_t> columns_of(const Setup& setup) {
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < column_table().size(); ++i)
        if (setup.plant.has_wall || !column_table()[i].only_with_wall) columns.push_back(i);
    return columns;
}

}  // namespace arm3r
