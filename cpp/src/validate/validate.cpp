// The rules of the flat parameters: what each key allows, then what only holds between keys (setup.cpp).

#include "validate/validate.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "schema/param_access.hpp"
#include "setup/make_controller.hpp"
#include "setup/setup.hpp"
#include "validate/rules.hpp"

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

// Up to its last number.
std::size_t given_count(const Key& key, std::span<const double> params) {
    std::size_t count = key.size;
    while (count > 0 && std::isnan(params[key.offset + count - 1])) --count;
    return count;
}

// How many of a key's places must hold a number, given its form and the first of them.
std::size_t expected_count(const Key& key, std::span<const double> params) {
    if (key.form == Form::number_or_vector && std::isnan(params[key.offset + 1]) && std::isnan(params[key.offset + 2]))
        return 1;
    if (key.form == Form::by_choice) return takes_list(key, params) ? key.size : 1;
    if (key.form == Form::list) return std::max(key.fewest, given_count(key, params));
    return key.size;
}

Problem missing(const Key& key, std::size_t count) {
    return {.code = "scenario.missing_key",
            .path = key.path,
            .message = "this must be given",
            .allowed = (count == 1 ? "a number" : "a list of " + list_sizes(key) + " numbers") +
                       (key.unit.empty() ? "" : ", " + key.unit)};
}

// A choice must be the index of one of its words; everything else is read only when all of them are.
void check_choice(const Key& key, std::span<const double> params, Findings& findings) {
    const double stored = params[key.offset];
    if (std::isnan(stored) && key.unset == "as the plant") return;
    const double count = key.kind == Kind::choice ? double(key.choices.size()) : 2;
    if (!(stored >= 0 && stored < count && stored == std::floor(stored)))
        findings.add([&] {
            return Problem{.code = "scenario.choice",
                           .path = key.path,
                           .message = "no such choice",
                           .got = shortest(stored),
                           .allowed = "an index from 0 to " + shortest(count - 1)};
        });
}

void check_number(const Key& key, double value, std::size_t item, std::size_t count, Findings& findings) {
    const auto broken = [&](const char* code, const char* message) {
        findings.add([&] {
            return Problem{.code = code,
                           .path = item_path(key, item, count),
                           .message = message,
                           .got = shortest(value),
                           .allowed = range_of(key)};
        });
    };
    if (!within(key, value)) broken("scenario.range", "out of range");
    else if (key.kind == Kind::integer && value != std::floor(value)) broken("scenario.type", "not a whole number");
}

void check_numbers(const Key& key, std::span<const double> params, Findings& findings) {
    const std::size_t count = expected_count(key, params);
    std::size_t absent = 0;
    for (std::size_t i = 0; i < count; ++i) absent += std::isnan(params[key.offset + i]);
    if (absent == count && !key.unset.empty()) return;
    if (absent > 0) return findings.add([&] { return missing(key, count); });
    for (std::size_t i = 0; i < count; ++i) check_number(key, params[key.offset + i], i, count, findings);
}

template <Name path>
void need_number(std::span<const double> params, const char* hint, Findings& findings) {
    if (!std::isnan(at<path>(params))) return;
    findings.add([&] {
        Problem problem = missing(known_key(path), 1);
        problem.hint = hint;
        return problem;
    });
}

// What a shape cannot give must be given.
template <Name link>
void check_slender(std::span<const double> params, Findings& findings) {
    if (is<link + ".shape", "slender">(params))
        need_number<link + ".mass">(params, "a slender link has no density: give its mass", findings);
}

void check_shapes(std::span<const double> params, Findings& findings) {
    check_slender<"arm.link1">(params, findings);
    check_slender<"arm.link2">(params, findings);
    check_slender<"arm.link3">(params, findings);
    if (!is<"arm.link1.shape", "explicit">(params)) return;
    const char* hint = "shape explicit takes nothing from a shape";
    need_number<"arm.link1.mass">(params, hint, findings);
    need_number<"arm.link1.com">(params, hint, findings);
    need_number<"arm.link1.inertia_axial">(params, hint, findings);
}

template <Name path>
void check_inertia(std::span<const double> params, Findings& findings) {
    const Vec3<double> inertia = vector_at<path>(params);
    for (int i = 0; i < 3; ++i) {
        const double own = inertia[i], others = inertia[(i + 1) % 3] + inertia[(i + 2) % 3];
        if (own > others * (1 + 1e-12))
            findings.add([&] {
                return Problem{.code = "scenario.inertia",
                               .path = std::string(path),
                               .message = "no body has one principal inertia above the sum of the other two",
                               .got = shortest(own) + " > " + shortest(others),
                               .allowed = "Ix <= Iy + Iz, and so on in turn"};
            });
    }
}

// The rules of `arm`, its keys and what holds between them.
void check_arm(std::span<const double> params, const std::vector<const Key*>& keys, Findings& findings) {
    for (const Key* key : keys) check_numbers(*key, params, findings);
    check_shapes(params, findings);
    check_inertia<"arm.link2.inertia">(params, findings);
    check_inertia<"arm.link3.inertia">(params, findings);
}

// The controller's copy must be an arm too: what is not given there is the plant's.
void check_model(std::span<const double> params, const std::vector<const Key*>& keys, Findings& findings) {
    check_arm(with_model(params), keys, findings);
    for (Problem& problem : findings.problems)
        problem.path.replace(0, std::string_view("arm").size(), "controller.model");
}

std::optional<Setup> check_all(std::span<const double> params, const NumberKeys& keys, Findings& findings) {
    check_arm(params, keys.arm, findings);
    for (const Key* key : keys.others) check_numbers(*key, params, findings);
    if (findings.none() && has_model(controls_of(params)) && model_differs(params))
        check_model(params, keys.model, findings);
    return findings.none() ? check_setup(params, findings) : std::nullopt;
}

bool is_choice(const Key& key) {
    return key.kind == Kind::choice || key.kind == Kind::flag || key.kind == Kind::section;
}

void check_choices(std::span<const double> params, Findings& findings) {
    if (params.size() != param_count())
        return findings.add([&] {
            return Problem{.code = "argument.size",
                           .message = "wrong number of parameters",
                           .got = std::to_string(params.size()),
                           .allowed = std::to_string(param_count())};
        });
    for (const Key& key : schema())
        if (is_choice(key)) check_choice(key, params, findings);
}

enum class Part { arm, others };

// The keys of numbers that exist for the choices made.
std::vector<const Key*> number_keys(std::span<const double> params, Part part) {
    std::vector<const Key*> keys;
    for (const Key& key : schema())
        if (key.path.starts_with("arm.") == (part == Part::arm) && !is_choice(key) && key_exists(key, params))
            keys.push_back(&key);
    return keys;
}

NumberKeys number_keys(std::span<const double> params) {
    return {number_keys(params, Part::arm), number_keys(params, Part::others),
            number_keys(with_model(params), Part::arm)};
}

// The same numbers, but in the place of those of controller.model those that they replace.
std::vector<std::size_t> in_plant(std::span<const std::size_t> varied) {
    std::vector<std::size_t> numbers(varied.begin(), varied.end());
    for (const auto [from, to] : model_numbers()) std::ranges::replace(numbers, from, to);
    return numbers;
}

// Leaves the keys in which one of the numbers `varied` is, and those that are wrong in `params`.
void drop_settled(std::vector<const Key*>& keys, std::span<const double> params, std::span<const std::size_t> varied) {
    std::erase_if(keys, [&](const Key* key) {
        const auto has = [&](std::size_t number) { return number - key->offset < key->size; };
        Findings findings(Findings::verdict);
        check_numbers(*key, params, findings);
        return findings.none() && std::ranges::none_of(varied, has);
    });
}

}  // namespace

void refuse_unknown_choices(std::span<const double> params) {
    Findings findings(Findings::messages);
    check_choices(params, findings);
    if (!findings.none()) throw Error(ARM3R_E_SCENARIO, std::move(findings.problems));
}

Validation validate(std::span<const double> params) {
    Findings findings(Findings::messages);
    check_choices(params, findings);
    std::optional<Setup> setup;
    if (findings.none()) setup = check_all(params, number_keys(params), findings);
    return {std::move(findings.problems), std::move(setup)};
}

Setup valid_setup(std::span<const double> params) {
    Validation validation = validate(params);
    if (!validation.setup) throw Error(ARM3R_E_SCENARIO, std::move(validation.problems));
    return *std::move(validation.setup);
}

Checker::Checker(std::span<const double> params, std::span<const std::size_t> varied) {
    Findings findings(Findings::verdict);
    check_choices(params, findings);
    readable_ = findings.none();
    if (!readable_) return;
    keys_ = number_keys(params);
    drop_settled(keys_.arm, params, varied);
    drop_settled(keys_.others, params, varied);
    drop_settled(keys_.model, with_model(params), in_plant(varied));
}

std::optional<Setup> Checker::operator()(std::span<const double> params) const {
    if (!readable_) return {};
    Findings findings(Findings::verdict);
    return check_all(params, keys_, findings);
}

}  // namespace arm3r
