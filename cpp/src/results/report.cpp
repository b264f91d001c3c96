#include "results/report.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "record/metrics.hpp"
#include "results/csv.hpp"
#include "results/report_lines.hpp"
#include "results/trust_report.hpp"
#include "schema/columns.hpp"

namespace arm3r {

namespace {

// Numbers that only a single run has.
constexpr std::string_view max_residual = "energy_residual_max", wall_clock = "elapsed_s";

const char* type_name(const Event& event) { return event.type == Event::make ? "make" : "break"; }

// ---- JSON

std::string list(const std::vector<std::string>& items, const char* between = ", ") {
    std::string out;
    for (const std::string& item : items) out += (out.empty() ? "" : between) + item;
    return "[" + out + "]";
}

std::string json(const std::array<double, 3>& v) {
    return list({json_number(v[0]), json_number(v[1]), json_number(v[2])});
}

std::string json(const std::optional<double>& value) { return value ? json_number(*value) : "null"; }

std::string json(const Event& event) {
    return std::string("{\"type\": \"") + type_name(event) + "\", \"t\": " + json_number(event.t) +
           ", \"q\": " + json(event.q) + ", \"qd\": " + json(event.qd) + ", \"tip\": " + json(event.tip) + "}";
}

std::string json(const CheckResult& check) {
    return "{\"name\": " + json_string(check.name) + ", \"passed\": " + (check.passed ? "true" : "false") +
           ", \"value\": " + json(check.value) + ", \"limit\": " + json_string(check.limit) +
           ", \"deviation\": " + json(check.deviation) + ", \"reason\": " + json_string(check.reason) + "}";
}

std::string json(const Steps& steps) {
    return "{\"accepted\": " + std::to_string(steps.accepted) + ", \"rejected\": " + std::to_string(steps.rejected) +
           ", \"evaluations\": " + std::to_string(steps.evaluations) + "}";
}

std::string json_column(const Column& column) {
    return "{\"name\": " + json_string(column.name) + ", \"unit\": " + json_string(column.unit) + "}";
}

std::string hash_text(const Run& run) {
    char digits[16];
    const char* end = std::to_chars(digits, digits + 16, fnv1a64(run), 16).ptr;
    const auto size = static_cast<std::size_t>(end - digits);
    return "fnv1a64:" + std::string(16 - size, '0') + std::string(digits, size);
}

template <class Range, class Function>
auto each(const Range& range, Function function) {
    std::vector<decltype(function(*std::begin(range)))> out;
    for (const auto& element : range) out.push_back(function(element));
    return out;
}

// All summary numbers under their names, as a batch's table has them; null where a run has no such number.
std::string metrics_json(const Run& run) {
    return "{" +
           listed(each(summary_table(),
                       [&](const SummaryNumber& number) {
                           return json_string(std::string(number.name)) + ": " + json_number(number.of(run));
                       }),
                  ", ") +
           "}";
}

// ---- for people

// The time span of the run; the start is left out if it is 0 s.
std::string span_text(const Run& run) {
    const std::span<const double> t = run.find(ColumnIndex("t"));
    const bool starts_at_zero = t.empty() || t.front() == 0;
    return (starts_at_zero ? "" : "from " + rounded(t.front(), 9) + " to ") + rounded(run.t_end, 9) + " s";
}

std::string event_lines(const Run& run) {
    constexpr std::size_t most = 8;
    std::string out;
    for (std::size_t i = 0; i < std::min(run.events.size(), most); ++i) {
        const Event& event = run.events[i];
        out +=
            line(event.type == Event::make ? "contact" : "contact lost",
                 "at " + fixed(event.t, 6) + " s (" + rounded(event.t, 16) + "), tip " + rounded(event.tip, 7) + " m");
    }
    if (run.events.size() > most)
        out += line("", "... and " + std::to_string(run.events.size() - most) + " more events");
    if (run.events.empty() && run.has_wall) out += line("contact", "none");
    if (run.at_end && run.at_end->depth > 0 && run.at_end->beside > 0)
        out += line("", "at the end the tip is " + rounded(run.at_end->depth, 4) + " m behind the face and " +
                            rounded(run.at_end->beside, 4) +
                            " m beside the plate, which pushes nothing there; wall.size makes it larger");
    return out;
}

// In the words of ISO/TS 15066, by how long the contact has lasted at t.
std::string kind_of_force(const Run& run, double t) {
    double since = t;
    for (const Event& event : run.events)
        if (event.type == Event::make && event.t <= t) since = event.t;
    return t - since > longest_transient ? "quasi-static" : "transient";
}

std::string force_line(const Run& run) {
    if (!run.has_wall || !run.at_end) return {};
    const auto peak = [&](double force, double t) {
        return "peak " + rounded(force, 10) + " N" +
               (force > 0 ? " (" + kind_of_force(run, t) + ", at " + rounded(t, 6) + " s)" : "");
    };
    std::string out = line("force on wall", rounded(run.at_end->f_on_wall, 7) + " N at " + rounded(run.t_end, 9) +
                                                " s, " + peak(run.peak_force, run.peak_force_time));
    if (run.peak_force > run.first_peak) out += line("first contact", peak(run.first_peak, run.first_peak_time));
    return out;
}

// The metrics of a controller, if there is one.
std::string score_lines(const Run& run) {
    std::string out;
    if (!std::isnan(run.force_error_rms)) {
        out += line("force error", rounded(run.force_error_rms, 4) + " N rms in contact, " +
                                       (std::isnan(run.force_error_peak)
                                            ? "its reference never reached"
                                            : rounded(run.force_error_peak, 4) + " N at most once it was reached"));
        out += line("settling", std::isnan(run.settling_time)
                                    ? "not within 5 % at the end"
                                    : "within 5 % from " + rounded(run.settling_time, 4) + " s after first contact on");
    }
    if (!std::isnan(run.path_error_rms))
        out += line("path error",
                    rounded(run.path_error_rms, 4) + " m rms, " + rounded(run.path_error_max, 4) + " m at most");
    if (run.saturation_share > 0) out += line("saturation", rounded(100 * run.saturation_share, 3) + " % of the time");
    if (!std::isnan(run.stiffness_estimate))
        out += line("wall estimate", rounded(run.stiffness_estimate, 7) + " N/m, moving in with " +
                                         rounded(run.wall_speed_estimate, 5) + " m/s");
    return out;
}

std::vector<std::string> check_cells(const CheckResult& check) {
    std::vector<std::string> cells = {check.passed ? "PASS" : "FAIL", visible(check.name, 60)};
    cells.push_back(check.value ? rounded(*check.value, 13) : "no value");
    cells.push_back(check.limit);
    if (check.deviation) cells.push_back("off by " + rounded(*check.deviation, 3));
    if (!check.value) cells.push_back(visible(check.reason, 120));
    return cells;
}

std::string elapsed_text(double seconds) {
    return seconds < 1 ? rounded(seconds * 1e3, 3) + " ms" : rounded(seconds, 4) + " s";
}

}  // namespace

std::vector<std::string> summary_number_names() {
    std::vector<std::string> names = each(summary_table(), [](const SummaryNumber& n) { return std::string(n.name); });
    names.emplace_back(max_residual);
    names.emplace_back(wall_clock);
    return names;
}

double summary_number(const Run& run, std::string_view name) {
    if (name == max_residual) return run.energy_residual_max;
    if (name == wall_clock) return run.elapsed_s;
    for (const SummaryNumber& number : summary_table())
        if (number.name == name) return number.of(run);
    throw Error(ARM3R_E_INTERNAL, "a summary has no number " + std::string(name));
}

std::string summary_json(const Results& results) {
    const Run& run = results.run;
    std::vector<std::string> columns = each(run.columns, [](std::size_t i) { return json_column(column_table[i]); });
    std::string out = "{\n  \"name\": " + json_string(results.name);
    const auto field = [&](const char* name, const std::string& value) {
        out += ",\n  \"" + std::string(name) + "\": " + value;
    };
    field("outcome", json_string(arm3r_outcome_name(run.outcome)));
    field("message", json_string(run.message));
    field("t_end", json_number(run.t_end));
    field("events", list(each(run.events, [](const Event& event) { return json(event); }), ",\n    "));
    field("checks", list(each(results.checks, [](const CheckResult& check) { return json(check); }), ",\n    "));
    field("contacts", json_number(run.contacts));
    field("contact_time", json_number(run.contact_time));
    field("metrics", metrics_json(run));
    field("torque_limit", json(run.torque_limit));
    field("peak_force", json_number(run.peak_force));
    field("final_force", json_number(run.final_force));
    field("impulse", json_number(run.impulse));
    field("energy_residual_max", json_number(run.energy_residual_max));
    field("ledger_residual", json_number(run.ledger_residual));
    if (results.setup) field("closed_forms", json(closed_forms(*results.setup, run)));
    if (results.horizon) field("trust", json(*results.horizon));
    field("steps", json(run.steps));
    field("solver", "{\"method\": " + json_string(run.method) + ", \"stiff_steps\": " + json_number(run.stiff_steps) +
                        ", \"choices\": " + json_string(run.choices) + "}");
    if (run.has_user_law) field("deterministic", "false");
    field("elapsed_s", json_number(run.elapsed_s));
    field("version", json_string(arm3r_version()));
    field("hash", json_string(hash_text(run)));
    field("warnings", list(each(run.warnings, [](const std::string& warning) { return json_string(warning); })));
    field("rows", std::to_string(run.rows));
    field("columns", list(columns));
    field("scenario", results.scenario.empty() ? "null" : json_string(results.scenario));
    return out + "\n}\n";
}

std::string report(const Results& results) {
    const Run& run = results.run;
    std::string out = visible(results.name, 200) + ": " + arm3r_outcome_name(run.outcome) +
                      (run.message.empty() ? "" : ", " + visible(run.message, 400)) + "\n";
    out += line("simulated", span_text(run) + " in " + std::to_string(run.rows) + " rows");
    out += event_lines(run);
    out += force_line(run);
    if (results.setup) out += closed_form_lines(closed_forms(*results.setup, run));
    out += score_lines(run);
    out += line("energy residual", rounded(run.energy_residual_max, 3) + " J at most");
    out += line("steps", std::to_string(run.steps.accepted) + " accepted, " + std::to_string(run.steps.rejected) +
                             " rejected, " + std::to_string(run.steps.evaluations) + " evaluations");
    if (!run.choices.empty()) out += line("method", run.choices);
    if (results.horizon) out += horizon_line(*results.horizon);
    out += line("wall clock", elapsed_text(run.elapsed_s));
    for (const std::string& warning : run.warnings) out += line("warning", visible(warning, 400));
    return out + aligned(each(results.checks, check_cells));
}

}  // namespace arm3r
