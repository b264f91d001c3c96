#include "run/run_recorder.hpp"

#include <algorithm>
#include <cmath>

#include "base/callback.hpp"
#include "base/number_text.hpp"
#include "record/end_messages.hpp"
#include "run/singular_passage.hpp"
#include "schema/choice_words.hpp"
#include "setup/make_controller.hpp"
#include "setup/time_instants.hpp"
#include "validate/size_limits.hpp"
#include "validate/warnings.hpp"

namespace arm3r {
namespace {

constexpr std::int64_t steps_per_reading = 256;  // of the clock

const Setup& small_enough(const Setup& setup, bool rows) {
    refuse_too_large(setup, rows);
    if (std::vector<Problem> problems = missing_columns(setup); rows && !problems.empty())
        throw Error(ARM3R_E_SCENARIO, std::move(problems));
    return setup;
}

}  // namespace

RunRecorder::RunRecorder(const Setup& setup, const RunOptions& options)
    : setup_(small_enough(setup, options.rows)), options_(options) {
    run_.t_end = setup_.start;
    run_.has_user_law = setup_.controller().type == ControllerType::user;
    seeks_singular_pose_ = options.judges && inverts_jacobian(setup_.controller());
    if (!options.rows) return;
    jumps_ = jumps_within_steps(setup_);
    plan_ = make_row_plan(setup_, options.kept, options.judges);
    row_log().reserve(plan_);
    run_.has_wall = setup_.plant.has_wall;
    run_.method = word_of(setup_.solver.method);
    run_.torque_limit = without_negative_zero(setup_.plant.arm.torque_limit);
    run_.events.reserve(static_cast<std::size_t>(max_events));
    if (options.judges) run_.warnings = scenario_warnings(setup);
}

void RunRecorder::start_contact(ContactMode mode) {
    mode_ = mode;
    if (is_touching(mode)) contacts_.begin(setup_.start);
}

void RunRecorder::start_rows(const FullState& y, const FullState& f, double energy_at_start) {
    energy_at_start_ = energy_at_start;
    if (is_touching(mode_)) record(Event::make, setup_.start, y);
    constexpr double a_moment = 1e-3;  // s
    FullState ahead;
    for (std::size_t i = 0; i < full_size; ++i) ahead[i] = y[i] + a_moment * f[i];
    dense_.assign(hermite(setup_.start, a_moment, y, f, ahead, f));
    if (options_.rows && setup_.stop > setup_.start)
        row_log().log(row_context(), setup_.start, y, 0.0);  // whatever becomes of the first step
}

void RunRecorder::record_contact_change(const ContactChange& change, const FullState& y) {
    if (!is_out_of_range(y)) log_until(change.t);
    dense_.c[0][work_of_wall] += change.gained;  // for the rows of this step that are still to come
    dense_.c[0][dissipated] += change.lost;
    contacts_.add(change);
    if (change.makes()) record(Event::make, change.t, y);
    if (change.breaks()) record(Event::brk, change.t, y);
    mode_ = change.to;
}

void RunRecorder::record(Event::Type type, double t, const FullState& y) {
    if (options_.rows && double(run_.events.size()) < max_events)
        run_.events.push_back({type, t, angles_out(setup_, angles(y)), rates_out(setup_, rates(y)),
                               without_negative_zero(tip_position(setup_.plant.arm, pose(angles(y))))});
}

void RunRecorder::seek_singular_pose(double theta) {
    if (const std::optional<double> at = first_passage(setup_.controller().model, dense_, theta))
        run_.singular_passage = {dense_.t0 + *at * dense_.h, angles_out(setup_, angles(dense_.motion(*at)))};
}

void RunRecorder::end(arm3r_outcome outcome, std::string message) {
    if (run_.outcome != ARM3R_RUN_OK) return;
    run_.outcome = outcome;
    run_.message = std::move(message);
}

bool RunRecorder::poll(std::int64_t steps) {
    const bool stop = (options_.stop && *options_.stop) || (options_.should_stop && *options_.should_stop);
    if (stop) end(ARM3R_RUN_STOPPED, "stopped" + at_time(run_.t_end));
    steps_since_reading_ += steps;
    if (steps_since_reading_ >= steps_per_reading) steps_since_reading_ = 0, read_clock();
    return is_running();
}

void RunRecorder::read_clock() {
    const double elapsed = stopwatch_.seconds();
    if (options_.time_limit > 0 && elapsed > options_.time_limit)
        end(ARM3R_RUN_BUDGET,
            "the time limit of " + shortest(options_.time_limit) + " s is used up" + at_time(run_.t_end));
    if (!options_.progress || elapsed < next_report_) return;
    next_report_ = elapsed + 0.02;
    const std::int32_t answer =
        call_back(options_.progress, options_.user, run_.t_end, setup_.stop, run_.steps.accepted + run_.steps.rejected);
    if (answer < 0) throw Error(ARM3R_E_CALLBACK, "the progress function asked to stop with " + std::to_string(answer));
    if (answer > 0) end(ARM3R_RUN_STOPPED, "stopped" + at_time(run_.t_end));
}

// Adds the cause of a bad end to the message, if it is known, or else advice.
void RunRecorder::explain(const FullState& y) {
    const auto is = [&](arm3r_outcome outcome) { return run_.outcome == outcome; };
    const bool is_numerical = is(ARM3R_RUN_DIVERGED) || is(ARM3R_RUN_ENERGY) || is(ARM3R_RUN_STEP_COLLAPSE);
    if (!is_numerical && !is(ARM3R_RUN_EVENT_STORM) && !is(ARM3R_RUN_BUDGET)) return;
    const double steps_taken = double(run_.steps.accepted + run_.steps.rejected);
    std::optional<std::string> cause;
    if (setup_.digital.sampling.on) cause = oscillation_.error_message(setup_.digital.sampling.period);
    if (!cause) cause = known_cause(setup_);
    if (!cause) cause = singular_pose(setup_, run_, angles(y));
    if (cause) run_.message += "; " + *cause;
    else if (is(ARM3R_RUN_BUDGET) && steps_taken >= setup_.solver.max_steps)
        run_.message += "; stiff friction or contact, or a tolerance too tight?";
    else if (is(ARM3R_RUN_ENERGY)) run_.message += std::string("; ") + accuracy_advice(setup_.solver);
}

// From a row at the end, whatever the log has.
std::optional<EndValues> RunRecorder::end_values(const FullState& y, double theta) const {
    const bool is_finite = std::ranges::all_of(y, [](double value) { return std::isfinite(value); });
    if (!is_finite || is_out_of_range(y)) return {};
    const RowPlan plan = plan_of_end();
    const Row row = make_row(row_context(plan), run_.t_end, y, theta);
    const auto three = [&](ColumnIndex first) {
        return std::array{row.value[first], row.value[first + 1], row.value[first + 2]};
    };
    EndValues end{three("qdd1"), three("tau1"), three("f_on_wall_x"), 0, 0};
    const Plant<double>& plant = setup_.plant;
    if (plant.has_wall) {
        const Indentation<double> tip =
            tip_indentation(plant, wall_at(plant.wall, run_.t_end), pose(angles(y)), Vec3<double>(y[3], y[4], y[5]));
        end.depth = tip.depth;
        end.beside = -inside_outline(plant.wall, tip);
    }
    return end;
}

Run RunRecorder::finish(const FullState& y, double theta, const EnergyTotals& totals) {
    if (is_running()) {
        log_until(run_.t_end);
        if (options_.rows) row_log().log(row_context(), run_.t_end, y, theta);
        if (const std::optional<std::string> error_message = balance_error(setup_.solver, totals)) {
            if (is_strict(setup_.solver)) end(ARM3R_RUN_ENERGY, *error_message);
            else run_.warnings.push_back(*error_message + "; " + accuracy_advice(setup_.solver));
        }
    }
    explain(y);
    if (is_running() && options_.judges && !setup_.digital.sampling.on)
        if (const std::optional<std::string> passed = singular_pose(setup_, run_, angles(y));
            passed && !known_cause(setup_))
            run_.warnings.push_back(*passed + (setup_.ends_steps_at_singular_poses()
                                                   ? ""
                                                   : "; steps may miss torques that last for microseconds there: "
                                                     "compare with a small solver.max_step"));
    if (options_.rows && options_.judges) run_.at_end = end_values(y, theta);
    if (options_.judges) {
        const auto warn = [this](const std::optional<std::string>& text) {
            if (text) run_.warnings.push_back(*text);
        };
        if (is_running() || run_.outcome == ARM3R_RUN_DIVERGED) warn(missed_contact(setup_, run_, contacts_.contacts));
        if (is_running()) warn(friction_in_residual(setup_, run_)), warn(jump_at_contact(setup_, run_));
    }
    if (run_.link_behind_wall_since >= 0)
        run_.warnings.push_back("a link other than at its tip is behind the wall from t = " +
                                shortest(run_.link_behind_wall_since) + " s on; only the tip feels the wall");
    if (run_.out_of_reach_since >= 0)
        run_.warnings.push_back(
            "the point that the admittance gives its joint loop is out of the arm's reach from t = " +
            shortest(run_.out_of_reach_since) + " s on, by at most " + shortest(run_.out_of_reach_by) +
            " m; the arm is stretched towards it");
    run_.t_end = std::max(run_.t_end, row_log().last_time());
    run_.ledger_residual = totals.residual;
    run_.energy_residual_max = std::max(run_.energy_residual_max, totals.residual);
    run_.elapsed_s = stopwatch_.seconds();
    return std::move(run_);
}

}  // namespace arm3r
