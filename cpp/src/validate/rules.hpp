#pragma once
// The rules between keys, by what they concern.

#include <cmath>
#include <optional>

#include "base/number_text.hpp"
#include "schema/param_access.hpp"
#include "setup/make_elbow.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// What no single key can break: the mass matrix over the whole workspace (3.10), the start, what a method cannot do.
// Makes the setup in place; it is empty where a rule is broken.
void check_setup(std::span<const double> params, std::optional<Setup>& setup, ProblemList& problem_list);
// The same where `setup` is that of parameters that differ in numbers of `initial` and `wall.contact` only, without a law.
void check_start_and_contact(std::span<const double> params, std::optional<Setup>& setup, ProblemList& problem_list);

// How far a point out of reach is, and what is within reach: "2.5 m from joint 2", "0.1 to 2 m".
std::string distance_from_reach(const Arm<double>& arm, const Vec3<double>& tip, bool front);
std::string reach_text(const Arm<double>& arm);
// Of the two factors of det J, where they are zero: "sin(q3)", and where the tip is then.
const char* bend_text(const Arm<double>& arm);
const char* tip_at_axis_text(const Arm<double>& arm);

// Of a planar arm: the least M11, and the least determinant of the lower block (3.10).
WorstPose min_M11(const Lumped<double>& lumped);
WorstPose min_lower_determinant(const Lumped<double>& lumped);

template <Name path>
void check_direction(std::span<const double> params, ProblemList& problem_list) {
    const Vec3<double> given = vector_at<path>(params);
    if (sqrt(dot(given, given)) < 1e-9)
        problem_list.add([] {
            return Problem{.code = "scenario.range",
                           .path = std::string(path),
                           .message = "a direction needs a length",
                           .got = "[0, 0, 0]",
                           .allowed = "any vector that is not zero"};
        });
}

// A key that must be given, as so many numbers.
Problem missing(const Key& key, std::size_t count, std::string hint = {});

template <Name column, Name t>
void check_length(std::span<const double> params, const char* hint, ProblemList& problem_list) {
    const std::size_t length = list_at<column>(params).size(), knots = list_at<t>(params).size();
    if (length == knots) return;
    problem_list.add([&] {
        const Key& key = known_key(column);
        if (length == 0 && key.unset == of_the_file) return missing(key, key.min_size, hint);
        return Problem{.code = "scenario.table",
                       .path = key.path,
                       .message = "not as long as " + std::string(t),
                       .got = std::to_string(length) + " numbers",
                       .allowed = std::to_string(knots) + " numbers",
                       .hint = hint};
    });
}

// The lists of a table must have the same length, and its instants must increase.
template <Name t, Name... columns>
void check_table(std::span<const double> params, const char* hint, ProblemList& problem_list) {
    const std::span<const double> instants = list_at<t>(params);
    const Key& key = known_key(t);
    if (instants.empty()) return problem_list.add([&] { return missing(key, key.min_size, hint); });
    (check_length<columns, t>(params, hint, problem_list), ...);
    for (std::size_t i = 1; i < instants.size(); ++i)
        if (!(instants[i - 1] < instants[i]))
            problem_list.add([&] {
                return Problem{.code = "scenario.table",
                               .path = std::string(t) + "[" + std::to_string(i) + "]",
                               .message = "the instants of a table must increase",
                               .got = shortest(instants[i]) + " after " + shortest(instants[i - 1]),
                               .allowed = "more than the one before"};
            });
}

// Rules of the controller and its reference: those of the keys alone, and those of the Setup.
void check_controller_keys(std::span<const double> params, ProblemList& problem_list);
void check_controller(std::span<const double> params, const Setup& setup, ProblemList& problem_list);

// Rules of sampling, sensors, observer and external force, and of the methods that support them.
void check_sampling_keys(std::span<const double> params, ProblemList& problem_list);
void check_sampling(std::span<const double> params, const Setup& setup, ProblemList& problem_list);

}  // namespace arm3r
