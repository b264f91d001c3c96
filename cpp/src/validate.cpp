// The rules of the flat parameters: what each key allows, then what only holds between keys (setup.cpp).

#include <cmath>

#include "numbers.hpp"
#include "schema.hpp"
#include "setup.hpp"

namespace arm3r {
namespace {

std::string item_path(const Key& key, std::size_t item, std::size_t count) {
    return count == 1 ? key.path : key.path + "[" + std::to_string(item) + "]";
}

std::string range_of(const Key& key) {
    const Bounds& b = key.bounds;
    return std::string(b.open_low ? "(" : "[") + shortest(b.low) + ", " + shortest(b.high) + (b.open_high ? ")" : "]") +
           (key.unit.empty() ? "" : " " + key.unit) + (key.allow_infinity ? " or inf" : "");
}

bool within(const Key& key, double value) {
    if (std::isinf(value)) return value > 0 && (key.allow_infinity || key.form == Form::vector_or_word);
    const Bounds& b = key.bounds;
    return (b.open_low ? value > b.low : value >= b.low) && (b.open_high ? value < b.high : value <= b.high);
}

// How many of a key's places must hold a number, given its form and the first of them.
std::size_t expected_count(const Key& key, std::span<const double> params) {
    if (key.form == Form::number_or_vector && std::isnan(params[key.offset + 1])) return 1;
    if (key.form == Form::by_choice) return choice_of(params, key.when_key) == key.when.front() ? 1 : key.size;
    return key.size;
}

Problem missing(const Key& key, std::size_t count) {
    return {.code = "scenario.missing_key",
            .path = key.path,
            .message = "this must be given",
            .got = "",
            .allowed = (count == 1 ? "a number" : "a list of " + std::to_string(count) + " numbers") +
                       (key.unit.empty() ? "" : ", " + key.unit),
            .hint = ""};
}

// A choice must be the index of one of its words; everything else is read only when all of them are.
void check_choice(const Key& key, std::span<const double> params, std::vector<Problem>& problems) {
    const double stored = params[key.offset];
    if (std::isnan(stored) && key.unset == "as the plant") return;
    const double count = key.kind == Kind::choice ? double(key.choices.size()) : 2;
    if (!(stored >= 0 && stored < count && stored == std::floor(stored)))
        problems.push_back({.code = "scenario.choice",
                            .path = key.path,
                            .message = "no such choice",
                            .got = shortest(stored),
                            .allowed = "an index from 0 to " + shortest(count - 1),
                            .hint = ""});
}

void check_numbers(const Key& key, std::span<const double> params, std::vector<Problem>& problems) {
    const std::size_t count = expected_count(key, params);
    std::size_t absent = 0;
    for (std::size_t i = 0; i < count; ++i) absent += std::isnan(params[key.offset + i]);
    if (absent == count && !key.unset.empty()) return;
    if (absent > 0) {
        problems.push_back(missing(key, count));
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double value = params[key.offset + i];
        if (!within(key, value))
            problems.push_back({.code = "scenario.range",
                                .path = item_path(key, i, count),
                                .message = "out of range",
                                .got = shortest(value),
                                .allowed = range_of(key),
                                .hint = ""});
        else if (key.kind == Kind::integer && value != std::floor(value))
            problems.push_back({.code = "scenario.type",
                                .path = item_path(key, i, count),
                                .message = "not a whole number",
                                .got = shortest(value),
                                .allowed = range_of(key),
                                .hint = ""});
    }
}

// A slender link has no volume to take its mass from.
void check_slender(std::span<const double> params, std::vector<Problem>& problems) {
    for (const char* link : {"arm.link1", "arm.link2", "arm.link3"}) {
        const std::string mass = std::string(link) + ".mass";
        if (choice_of(params, std::string(link) + ".shape") == "slender" && std::isnan(param(params, mass))) {
            Problem problem = missing(*find_key(mass), 1);
            problem.hint = "a slender link has no density: give its mass";
            problems.push_back(problem);
        }
    }
}

bool is_choice(const Key& key) {
    return key.kind == Kind::choice || key.kind == Kind::flag || key.kind == Kind::section;
}

}  // namespace

std::vector<Problem> validate(std::span<const double> params) {
    if (params.size() != param_count())
        return {{.code = "argument.size",
                 .path = "",
                 .message = "wrong number of parameters",
                 .got = std::to_string(params.size()),
                 .allowed = std::to_string(param_count()),
                 .hint = ""}};
    std::vector<Problem> problems;
    for (const Key& key : schema())
        if (is_choice(key)) check_choice(key, params, problems);
    if (!problems.empty()) return problems;
    for (const Key& key : schema())
        if (!is_choice(key) && key_exists(key, params)) check_numbers(key, params, problems);
    check_slender(params, problems);
    return problems.empty() ? check_setup(params) : problems;
}

}  // namespace arm3r
