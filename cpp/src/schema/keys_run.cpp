// The keys of the start, of a push from outside, of the method and of the log.

#include "schema/keys.hpp"

#include <numbers>

#include "schema/choice_words.hpp"
#include "schema/columns.hpp"
#include "schema/key_builders.hpp"

namespace arm3r {
namespace {

Key log_columns() {
    Key key = list_of(1, column_count,
                      number("time.log_columns", {unset}, Source::ours, {0, double(column_count - 1)}, "",
                             "Names of the columns of the log; t is always one. The rest is not computed, and nothing "
                             "but the log changes."));
    for (const Column& column : column_table) key.choices.emplace_back(column.name);
    key.word = "names that `arm3r columns` lists";
    return of_kind(Kind::column, derived("all that the run has", key));
}

}  // namespace

void append_start(std::vector<Key>& keys) {
    keys.push_back(of_kind(
        Kind::angle,
        number(
            "initial.q", {0, -30 * std::numbers::pi / 180, 60 * std::numbers::pi / 180}, Source::lecture, {-1e5, 1e5},
            "rad",
            "Joint angles at the start. The default is the lecture's pose: [0, -30 deg, 60 deg], or [0, 30 deg, -60 deg] in the slide convention.")));
    keys.push_back(of_kind(Kind::angle, number("initial.qd", {0, 0, 0}, Source::lecture, {-1e6, 1e6}, "rad/s",
                                               "Joint rates at the start; 10 deg means 10 deg/s.")));
}

void append_push(std::vector<Key>& keys) {
    keys.push_back(of_kind(
        Kind::section,
        number(
            "push", {0}, Source::ours, no_bounds, "",
            "An external force on the tip, beside that of the wall; a force sensor measures it too. Absent: none.")));
    keys.push_back(
        number("push.force", {0, 0, 0}, Source::ours, {-1e9, 1e9}, "N", "The external force on the tip, base axes."));
    keys.push_back(number("push.start", {0}, Source::ours, an_instant, "s", "When the external force begins."));
    keys.push_back(number("push.rise", {0}, Source::ours, {0, 1e9}, "s",
                          "How long the external force grows linearly before it is constant."));
    keys.push_back(or_infinite(
        number("push.duration", {infinite}, Source::ours, {0, 1e9}, "s", "How long the external force lasts.")));
}

void append_solver(std::vector<Key>& keys) {
    keys.push_back(choice(
        "solver.method", words_of<SolverMethod>(), Source::ours,
        "dopri5: Dormand-Prince 5(4), adaptive; rk4: classical Runge-Kutta, fixed step; taylor: power series, adaptive; rodas4: Rosenbrock 4(3) for stiff contact, adaptive; auto: dopri5, and rodas4 where the motion is stiff."));
    keys.push_back(where("solver.method", {"dopri5", "rodas4", "auto"},
                         number("solver.rtol", {1e-9}, Source::ours, {2.220446049250313e-14, 0.1}, "",
                                "Relative tolerance of a step; not below 100 times the rounding unit.")));
    keys.push_back(
        where("solver.method", {"dopri5", "rodas4", "auto"},
              number("solver.atol", {1e-12}, Source::ours, {1e-20, 1}, "rad, rad/s", "Absolute tolerance of a step.")));
    keys.push_back(where("solver.method", {"taylor"},
                         number("solver.tol", {1e-9}, Source::ours, {1e-15, 1e-2}, "rad, rad/s",
                                "Tolerance of a step: absolute below 1, relative above.")));
    keys.push_back(where("solver.method", {"dopri5", "taylor", "rodas4", "auto"},
                         derived("no limit", number("solver.max_step", {unset}, Source::ours, {1e-12, 1e9}, "s",
                                                    "Maximum step size."))));
    keys.push_back(where("solver.method", {"rk4"},
                         number("solver.step", {1e-3}, Source::ours, {1e-12, 1e9}, "s", "Step size of rk4.")));
    keys.push_back(where(
        "solver.method", {"rk4"},
        choice(
            "solver.events", words_of<StepEvents>(), Source::ours,
            "Where a step of rk4 ends. grid: at multiples of solver.step alone; located: also at samples, where contact begins or ends, and where a formula of time changes, so that rk4 keeps its order there.")));
    keys.push_back(of_kind(Kind::integer, number("solver.max_steps", {1e7}, Source::ours, {1, 1e9}, "",
                                                 "Accepted and rejected steps after which the run ends as `budget`.")));
}

void append_time(std::vector<Key>& keys) {
    keys.push_back(
        number("time.stop", {10}, Source::ours, an_instant, "s", "End of the run; one at time.start gives one row."));
    keys.push_back(
        number("time.log_every", {0.01}, Source::ours, {1e-12, 1e9}, "s",
               "Time between rows; the start and the end are always rows, and the log never changes the steps."));
    keys.push_back(number("time.start", {0}, Source::ours, an_instant, "s",
                          "Start of the run: rows, samples and fixed steps count from it, and `initial` holds there. "
                          "wall.point stays the place at t = 0, and no other key is shifted."));
    keys.push_back(log_columns());
}

}  // namespace arm3r
