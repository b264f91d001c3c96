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
    if (key.form == Form::number_or_vector && std::isnan(params[key.offset + 1]) && std::isnan(params[key.offset + 2]))
        return 1;
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

bool is_choice(const Key& key) {
    return key.kind == Kind::choice || key.kind == Kind::flag || key.kind == Kind::section;
}

void need_number(std::span<const double> params, const std::string& path, const char* hint,
                 std::vector<Problem>& problems) {
    if (!std::isnan(param(params, path))) return;
    problems.push_back(missing(*find_key(path), 1));
    problems.back().hint = hint;
}

// What a shape cannot give must be given.
void check_shapes(std::span<const double> params, std::vector<Problem>& problems) {
    for (const char* link : {"arm.link1", "arm.link2", "arm.link3"})
        if (choice_of(params, std::string(link) + ".shape") == "slender")
            need_number(params, std::string(link) + ".mass", "a slender link has no density: give its mass", problems);
    if (choice_of(params, "arm.link1.shape") == "explicit")
        for (const char* key : {"arm.link1.mass", "arm.link1.com", "arm.link1.inertia_axial"})
            need_number(params, key, "shape explicit takes nothing from a shape", problems);
}

void check_inertia(std::span<const double> params, const std::string& path, std::vector<Problem>& problems) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double own = param(params, path, i),
                     others = param(params, path, (i + 1) % 3) + param(params, path, (i + 2) % 3);
        if (own > others * (1 + 1e-12))
            problems.push_back({.code = "scenario.inertia",
                                .path = path,
                                .message = "no body has one principal inertia above the sum of the other two",
                                .got = shortest(own) + " > " + shortest(others),
                                .allowed = "Ix <= Iy + Iz, and so on in turn",
                                .hint = ""});
    }
}

// The rules of `arm`, its keys and what holds between them.
std::vector<Problem> arm_problems(std::span<const double> params) {
    std::vector<Problem> problems;
    for (const Key& key : schema())
        if (key.path.starts_with("arm.") && !is_choice(key) && key_exists(key, params))
            check_numbers(key, params, problems);
    check_shapes(params, problems);
    check_inertia(params, "arm.link2.inertia", problems);
    check_inertia(params, "arm.link3.inertia", problems);
    return problems;
}

// The controller's copy must be an arm too: what is not given there is the plant's.
std::vector<Problem> model_problems(std::span<const double> params) {
    std::vector<Problem> problems = arm_problems(with_model(params));
    for (Problem& problem : problems) problem.path.replace(0, std::string_view("arm").size(), "controller.model");
    return problems;
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
    problems = arm_problems(params);
    for (const Key& key : schema())
        if (!key.path.starts_with("arm.") && !is_choice(key) && key_exists(key, params))
            check_numbers(key, params, problems);
    if (problems.empty() && choice_of(params, "controller.type") == "gravity_compensation")
        problems = model_problems(params);
    return problems.empty() ? check_setup(params) : problems;
}

}  // namespace arm3r
