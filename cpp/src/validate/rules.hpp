#pragma once
// The rules between keys, by what they concern.

#include <cmath>
#include <optional>

#include "base/number_text.hpp"
#include "schema/param_access.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// What no single key can break: the mass matrix over the whole workspace (3.10), the start, what a method cannot do.
// The setup, where no rule is broken.
std::optional<Setup> check_setup(std::span<const double> params, Findings& findings);

// Smallest M11 and smallest determinant of the lower block over all poses, and the link angles where they occur (3.10).
struct WorstPose {
    double value;
    double q2, q3;  // rad, slide
};
WorstPose smallest_M11(const Lumped<double>& lumped);
WorstPose smallest_lower_determinant(const Lumped<double>& lumped);

template <Name path>
void check_direction(std::span<const double> params, Findings& findings) {
    const Vec3<double> given = vector_at<path>(params);
    if (sqrt(dot(given, given)) < 1e-9)
        findings.add([] {
            return Problem{.code = "scenario.range",
                           .path = std::string(path),
                           .message = "a direction needs a length",
                           .got = "[0, 0, 0]",
                           .allowed = "any vector that is not zero"};
        });
}

template <Name path>
std::size_t length_of(std::span<const double> params) {
    std::size_t length = 0;
    while (length < most_knots && !std::isnan(at<path>(params, length))) ++length;
    return length;
}

template <Name column, Name t>
void check_length(std::span<const double> params, const char* hint, Findings& findings) {
    const std::size_t length = length_of<column>(params), knots = length_of<t>(params);
    if (length != knots)
        findings.add([&] {
            return Problem{.code = "scenario.table",
                           .path = std::string(column),
                           .message = "not as long as " + std::string(t),
                           .got = std::to_string(length) + " numbers",
                           .allowed = std::to_string(knots) + " numbers",
                           .hint = hint};
        });
}

// The lists of a table say one thing each of the same instants, in their order.
template <Name t, Name... columns>
void check_table(std::span<const double> params, const char* hint, Findings& findings) {
    (check_length<columns, t>(params, hint, findings), ...);
    for (std::size_t i = 1; i < length_of<t>(params); ++i) {
        const double before = at<t>(params, i - 1), here = at<t>(params, i);
        if (!(before < here))
            findings.add([&] {
                return Problem{.code = "scenario.table",
                               .path = std::string(t) + "[" + std::to_string(i) + "]",
                               .message = "the instants of a table must increase",
                               .got = shortest(here) + " after " + shortest(before),
                               .allowed = "more than the one before"};
            });
    }
}

// Of the controller and its reference: what the keys alone tell, before there is a Setup, and what shows in it.
void check_controller_keys(std::span<const double> params, Findings& findings);
void check_controller(std::span<const double> params, const Setup& setup, Findings& findings);

// Of sampling, sensors, observer and push, and of the methods that go with them.
void check_sampling_keys(std::span<const double> params, Findings& findings);
void check_sampling(std::span<const double> params, const Setup& setup, Findings& findings);

}  // namespace arm3r
