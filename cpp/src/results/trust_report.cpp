#include "results/trust_report.hpp"

#include <cmath>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "results/report_lines.hpp"

namespace arm3r {
namespace {

std::string json(const ClosedForm& one) {
    return "{\"name\": " + json_string(one.name) + ", \"unit\": " + json_string(one.unit) +
           ", \"own\": " + json_number(one.own) + ", \"closed_form\": " + json_number(one.form) +
           ", \"allowed\": " + json_number(one.allowed) + "}";
}

std::vector<std::string> cells(const ClosedForm& one) {
    const std::string unit = " " + std::string(one.unit);
    const double apart = std::abs(one.own - one.form);
    return {"  " + std::string(one.name), rounded(one.own, 10) + unit, "closed form " + rounded(one.form, 10) + unit,
            "apart by " + rounded(apart, 2) + (apart > one.allowed ? ", more than allowed:" : ", allowed"),
            rounded(one.allowed, 2)};
}

}  // namespace

std::string json(const ClosedForms& found) {
    std::string forms;
    for (const ClosedForm& one : found.forms) forms += (forms.empty() ? "" : ",\n    ") + json(one);
    return "{\"effective_mass\": " + json_number(found.effective_mass) +
           ", \"approach_speed\": " + json_number(found.approach_speed) + ", \"numbers\": [" + forms + "]}";
}

std::string json(const Horizon& horizon) {
    return "{\"horizon\": " + json_number(horizon.t) + ", \"error\": " + json_number(trusted_error) +
           ", \"to_the_end\": " + (horizon.is_end ? "true" : "false") +
           ", \"end_error\": " + json_number(horizon.end_error) +
           ", \"end_error_at\": " + json_number(horizon.end_error_at) + ", \"growth\": " + json_number(horizon.growth) +
           ", \"cause\": " + json_string(horizon.cause) + "}";
}

std::string closed_form_lines(const ClosedForms& found) {
    if (found.forms.empty()) return {};
    std::vector<std::vector<std::string>> lines;
    for (const ClosedForm& one : found.forms) lines.push_back(cells(one));
    const std::string met =
        std::isnan(found.approach_speed) ? "" : ", met at " + rounded(found.approach_speed, 5) + " m/s";
    return line("closed forms",
                "effective mass " + rounded(found.effective_mass, 7) + " kg" + met + ", at the first contact") +
           aligned(lines);
}

std::string horizon_line(const Horizon& horizon) {
    const std::string at_end = horizon.cause.empty() ? "at the end " : "at " + rounded(horizon.end_error_at, 6) + " s ";
    return line("trust", "joint angles right to " + rounded(trusted_error, 1) + " rad " +
                             (horizon.is_end ? "to the end" : "until " + rounded(horizon.t, 6) + " s") +
                             "; a small change of the start grows " + rounded(horizon.growth, 2) + "-fold" +
                             (horizon.is_end ? "" : " until then") + "; error " + at_end +
                             rounded(horizon.end_error, 2) + " rad" +
                             (horizon.cause.empty() ? "" : "; " + visible(horizon.cause, 400)));
}

}  // namespace arm3r
