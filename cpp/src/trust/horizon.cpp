#include "trust/horizon.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/number_text.hpp"
#include "batch/simulation.hpp"
#include "schema/columns.hpp"
#include "trust/exact_solver.hpp"
#include "validate/size_limits.hpp"

namespace arm3r {
namespace {

constexpr double rounding_unit = 0x1p-53;
constexpr double least_rtol = 1e-14, least_tol = 1e-16;  // smaller ones make no run more exact
constexpr double direction[] = {0.6, 0.48, -0.64};       // of the change of the start: a unit vector

// The tolerance of the run that is to be more exact, and half of it. Where a smaller one would make no run more exact, it
// is at least another one: the steps then differ, and with them the rounding.
struct Refinement {
    int halvings;
    bool once_more;
};
constexpr Refinement exact_run{6, false}, more_exact_run{6, true};

double refined(double tolerance, double least, const Refinement& by) {
    const double exact = std::min(std::max(std::ldexp(tolerance, -by.halvings), least), tolerance / 2);
    return by.once_more ? exact / 2 : exact;
}

// A fixed step has no tolerance, and a contact may lie in the same place of all steps that divide it: another method
// takes its place.
Setup refined(Setup setup, const Refinement& by) {
    Solver& solver = setup.solver;
    if (solver.method == SolverMethod::rk4) {
        solver = exact_solver(solver);
        if (by.once_more) solver.rtol /= 2, solver.atol /= 2;
    } else {
        solver.rtol = refined(solver.rtol, least_rtol, by);
        solver.atol = refined(solver.atol, 0, by);
        solver.tol = refined(solver.tol, least_tol, by);
    }
    solver.max_steps *= 8;
    return setup;
}

// rad: far above the error of a step, so that the errors of the two runs do not count.
double change_of_start(const Solver& solver) {
    return std::clamp(1e3 * (solver.method == SolverMethod::taylor ? solver.tol : solver.rtol), 1e-11, 1e-6);
}

Setup changed(Setup setup, double change) {
    for (int i = 0; i < 3; ++i) setup.q[i] += change * direction[i];
    return setup;
}

bool is_cut_short(const Run& run) { return run.outcome == ARM3R_RUN_STOPPED || run.outcome == ARM3R_RUN_BUDGET; }

// The joint angles and rates of a run's rows.
struct Trajectory {
    std::span<const double> t;
    std::array<std::span<const double>, 6> y;

    explicit Trajectory(const Run& run) : t(run.find(ColumnIndex("t"))) {
        for (std::size_t i = 0; i < y.size(); ++i) y[i] = run.find(ColumnIndex("q1") + i);
    }

    // How many rows stand at the same times as those of another run; the last one of a run that failed does not.
    std::size_t common_rows(const Trajectory& other) const {
        std::size_t rows = std::min(t.size(), other.t.size());
        for (const auto& values : y) rows = std::min(rows, values.size());
        return rows > 0 && t[rows - 1] != other.t[rows - 1] ? rows - 1 : rows;
    }
    double angle_distance(const Trajectory& other, std::size_t row) const {
        double largest = 0;
        for (std::size_t i = 0; i < 3; ++i) largest = std::max(largest, std::abs(y[i][row] - other.y[i][row]));
        return largest;
    }
    double distance(const Trajectory& other, std::size_t row) const {
        double sum = 0;
        for (std::size_t i = 0; i < 6; ++i) sum += (y[i][row] - other.y[i][row]) * (y[i][row] - other.y[i][row]);
        return std::sqrt(sum);
    }
};

// Up to when a comparison of runs tells something, and why no longer.
struct Comparable {
    double t = INFINITY;  // s
    std::string cause;

    void include(double other, const std::string& why) {
        if (other < t) t = other, cause = why;
    }
};

std::string text_of(const SingularPassage& passage) {
    return "at " + rounded(passage.t, 6) + " s the arm passes the singular pose q = " + rounded(passage.q, 4) +
           " rad, where the law inverts the Jacobian: its torque may last there for less than a step, and no tolerance "
           "tells";
}

// Torques that are held from sample to sample have no peak between them, and steps that end at singular poses see it.
Comparable limit_of(const Setup& setup, const Run& own, std::span<const Run> others) {
    Comparable limit;
    const auto pass = [&](const Run& run) {
        if (run.singular_passage && !setup.digital.sampling.on && !setup.ends_steps_at_singular_poses())
            limit.include(run.singular_passage->t, text_of(*run.singular_passage));
    };
    pass(own);
    for (const Run& run : others) {
        pass(run);
        if (run.outcome != ARM3R_RUN_OK && run.t_end < own.t_end)
            limit.include(run.t_end, "a more exact run ends at " + rounded(run.t_end, 6) + " s: " + run.message);
    }
    return limit;
}

}  // namespace

ColumnSet states_in_log() {
    ColumnSet states;
    for (std::size_t i = ColumnIndex("t"); i <= ColumnIndex("qd3"); ++i) states.set(i);
    return states;
}

std::optional<Horizon> horizon_of(const Setup& setup, const Run& run, const RunOptions& options) {
    Setup states = setup;
    states.logged = states_in_log();
    const Setup exact = refined(states, exact_run), more_exact = refined(states, more_exact_run);
    if (is_cut_short(run) || has_too_many_steps(more_exact)) return {};
    const double change = change_of_start(exact.solver);
    const Run runs[] = {simulate(exact, options), simulate(more_exact, options),
                        simulate(changed(exact, change), options)};
    const Trajectory own(run), z(runs[0]), half(runs[1]), beside(runs[2]);
    if (std::ranges::any_of(runs, is_cut_short)) return {};
    const Comparable limit = limit_of(setup, run, runs);
    std::size_t rows = std::min({own.common_rows(z), own.common_rows(half), own.common_rows(beside)});
    while (rows > 1 && own.t[rows - 1] > limit.t) --rows;
    if (rows == 0) return {};
    const auto growth = [&](std::size_t row) { return beside.distance(z, row) / change; };
    const auto error = [&](std::size_t row) {
        return own.angle_distance(z, row) + z.angle_distance(half, row) + rounding_unit * growth(row);
    };
    std::size_t good = 0;
    while (good < rows && error(good) <= trusted_error) ++good;
    const std::size_t last = good == 0 ? 0 : good - 1;
    return Horizon{own.t[last],     good == own.t.size(), error(rows - 1),
                   own.t[rows - 1], growth(last),         rows < own.t.size() ? limit.cause : ""};
}

}  // namespace arm3r
