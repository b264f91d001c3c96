// The rules of the flat parameters: those of each key, then those between keys.

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
    return std::string(b.open_low ? "(" : "[") + yaml_number(b.low) + ", " + yaml_number(b.high) +
           (b.open_high ? ")" : "]") + (key.unit.empty() ? "" : " " + key.unit) + (key.allow_infinity ? " or inf" : "");
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
    if (key.form == Form::list) return std::max(key.min_size, given_count(key, params));
    return key.size;
}

// A choice must be the index of one of its words; everything else is read only when all of them are.
void check_choice(const Key& key, std::span<const double> params, ProblemList& problem_list) {
    const double stored = params[key.offset];
    if (std::isnan(stored) && key.unset == "as the plant") return;
    const double count = key.kind == Kind::choice ? double(key.choices.size()) : 2;
    if (!(stored >= 0 && stored < count && stored == std::floor(stored)))
        problem_list.add([&] {
            return Problem{.code = "scenario.choice",
                           .path = key.path,
                           .message = "no such choice",
                           .got = shortest(stored),
                           .allowed = "an index from 0 to " + shortest(count - 1)};
        });
}

}  // namespace

void check_number(const Key& key, double value, std::size_t item, std::size_t count, ProblemList& problem_list) {
    const auto broken = [&](const char* code, const char* message) {
        problem_list.add([&] {
            return Problem{.code = code,
                           .path = item_path(key, item, count),
                           .message = message,
                           .got = shortest(value),
                           .allowed = range_of(key)};
        });
    };
    if (!within(key, value)) broken("scenario.range", "out of range");
    else if ((key.kind == Kind::integer || key.kind == Kind::column) && value != std::floor(value))
        broken("scenario.type", "not a whole number");
}

namespace {

void check_numbers(const Key& key, std::span<const double> params, ProblemList& problem_list) {
    if (key.any_length && params.size() > param_count())
        if (const std::span<const double> numbers = list_at(params, key); numbers.size() > key.size) {
            for (std::size_t i = 0; i < numbers.size(); ++i)
                check_number(key, numbers[i], i, numbers.size(), problem_list);
            return;
        }
    const std::size_t count = expected_count(key, params);
    std::size_t absent = 0;
    for (std::size_t i = 0; i < count; ++i) absent += std::isnan(params[key.offset + i]);
    if (absent == count && !key.unset.empty()) return;
    if (absent > 0) return problem_list.add([&] { return missing(key, count); });
    for (std::size_t i = 0; i < count; ++i) check_number(key, params[key.offset + i], i, count, problem_list);
}

template <Name path>
void need_number(std::span<const double> params, const char* hint, ProblemList& problem_list) {
    if (!std::isnan(at<path>(params))) return;
    problem_list.add([&] { return missing(known_key(path), 1, hint); });
}

// Numbers that a shape does not determine must be given.
template <Name link>
void check_slender(std::span<const double> params, ProblemList& problem_list) {
    if (is<link + ".shape", "slender">(params))
        need_number<link + ".mass">(params, "a slender link has no density: give its mass", problem_list);
}

// How many numbers the planar or the elbow arm takes where the key lets a user write either.
void check_size(const Key& key, std::span<const double> params, std::size_t of_planar, std::size_t of_elbow,
                bool must_be_given, ProblemList& problem_list) {
    const bool is_elbow = is<"arm.model", "elbow">(params);
    const std::size_t given = given_count(key, params), wanted = is_elbow ? of_elbow : of_planar;
    const std::string& model = choice_of(params, "arm.model");
    if (given == 0 && must_be_given && is_elbow)
        problem_list.add([&] { return missing(key, wanted, "an elbow arm has no shapes to derive it from"); });
    if (given == 0 || given == wanted) return;
    problem_list.add([&] {
        return Problem{.code = "scenario.type",
                       .path = key.path,
                       .message = "arm.model " + model + " takes " +
                                  (wanted == 1 ? "one number" : "a list of " + std::to_string(wanted) + " numbers") +
                                  " here",
                       .got = given == 1 ? "one number" : "a list of " + std::to_string(given),
                       .allowed = std::to_string(wanted) + (key.unit.empty() ? "" : ", " + key.unit),
                       .hint = is_elbow ? "give [x, y, z], or [xx, yy, zz, xy, xz, yz] of a tensor"
                                        : "arm.model: elbow takes points and tensors"};
    });
}

template <Name link>
void check_sizes(std::span<const double> params, ProblemList& problem_list) {
    const bool is_first = std::string_view(link) == "arm.link1";
    check_size(known_key(link + ".com"), params, 1, 3, !is_first, problem_list);
    if (is_first) return;
    check_size(known_key(link + ".inertia"), params, 3, 6, true, problem_list);
    if (is<"arm.model", "elbow">(params))
        need_number<link + ".mass">(params, "an elbow arm has no shapes to derive it from", problem_list);
}

void check_shapes(std::span<const double> params, ProblemList& problem_list) {
    if (is<"arm.model", "elbow">(params)) return;
    check_slender<"arm.link1">(params, problem_list);
    check_slender<"arm.link2">(params, problem_list);
    check_slender<"arm.link3">(params, problem_list);
    if (!is<"arm.link1.shape", "explicit">(params)) return;
    const char* hint = "shape explicit takes nothing from a shape";
    need_number<"arm.link1.mass">(params, hint, problem_list);
    need_number<"arm.link1.com">(params, hint, problem_list);
    need_number<"arm.link1.inertia_axial">(params, hint, problem_list);
}

// A tensor that no body has: with a negative principal inertia. One above the sum of the other two warns.
void check_tensor(const Key& key, std::span<const double> params, ProblemList& problem_list) {
    const auto I = [&](std::size_t i) { return params[key.offset + i]; };
    const double minors[] = {
        I(0) * I(1) - I(3) * I(3), I(0) * I(2) - I(4) * I(4), I(1) * I(2) - I(5) * I(5),
        I(0) * (I(1) * I(2) - I(5) * I(5)) - I(3) * (I(3) * I(2) - I(5) * I(4)) + I(4) * (I(3) * I(5) - I(1) * I(4))};
    const double size = std::max({I(0), I(1), I(2)}), rounding = 1e-9;
    const bool is_body = minors[0] >= -rounding * size * size && minors[1] >= -rounding * size * size &&
                         minors[2] >= -rounding * size * size && minors[3] >= -rounding * size * size * size;
    if (is_body || std::isnan(size)) return;
    problem_list.add([&] {
        return Problem{.code = "scenario.inertia",
                       .path = key.path,
                       .message = "no body has this tensor: a principal inertia is negative",
                       .allowed = "a positive semidefinite tensor, [xx, yy, zz, xy, xz, yz]",
                       .hint = "is the order that of xx, yy, zz, xy, xz, yz, and are products entries of the tensor?"};
    });
}

template <Name path>
void check_inertia(std::span<const double> params, ProblemList& problem_list) {
    const Vec3<double> inertia = vector_at<path>(params);
    for (std::size_t i = 0; i < 3; ++i)
        if (inertia[i] < 0)
            problem_list.add([&] {
                return Problem{.code = "scenario.range",
                               .path = item_path(known_key(path), i, 3),
                               .message = "out of range",
                               .got = shortest(inertia[i]),
                               .allowed = "[0, " + yaml_number(known_key(path).bounds.high) + "] kg m^2"};
            });
    if (is<"arm.model", "elbow">(params)) return check_tensor(known_key(path), params, problem_list);
    for (int i = 0; i < 3; ++i) {
        const double own = inertia[i], others = inertia[(i + 1) % 3] + inertia[(i + 2) % 3];
        if (own > others * (1 + 1e-12))
            problem_list.add([&] {
                return Problem{.code = "scenario.inertia",
                               .path = std::string(path),
                               .message = "no body has one principal inertia above the sum of the other two",
                               .got = shortest(own) + " > " + shortest(others),
                               .allowed = "Ix <= Iy + Iz, and so on in turn"};
            });
    }
}

void check_convention(std::span<const double> params, ProblemList& problem_list) {
    if (!is<"arm.convention", "urdf">(params)) return;
    if (is<"arm.model", "planar">(params))
        problem_list.add([] {
            return Problem{.code = "scenario.conflict",
                           .path = "arm.convention",
                           .message = "urdf is the convention of an elbow arm",
                           .got = "arm.model planar",
                           .allowed = "simscape or slide with arm.model: planar",
                           .hint = "write arm.model: elbow, or another convention"};
        });
    for (std::size_t i = 0; i < 3; ++i)
        if (const double sign = at<"arm.joint_sign">(params, i); std::abs(sign) != 1)
            problem_list.add([&] {
                return Problem{.code = "scenario.range",
                               .path = "arm.joint_sign[" + std::to_string(i) + "]",
                               .message = "a sign is 1 or -1",
                               .got = shortest(sign),
                               .allowed = "1 or -1"};
            });
}

// On the axis of joint 3 the tip would not move with it.
void check_tip(std::span<const double> params, ProblemList& problem_list) {
    const Vec3<double> tip = vector_at<"arm.link3.tip">(params);
    if (!(std::sqrt(tip[0] * tip[0] + tip[1] * tip[1]) < 1e-6)) return;
    problem_list.add([&] {
        return Problem{.code = "scenario.singular",
                       .path = "arm.link3.tip",
                       .message = "the tip is on the axis of joint 3, which cannot move it",
                       .got = "[" + shortest(tip[0]) + ", " + shortest(tip[1]) + ", " + shortest(tip[2]) + "]",
                       .allowed = "x and y at least 1e-6 m from that axis"};
    });
}

void check_axis(const Key& key, std::span<const double> params, ProblemList& problem_list) {
    const double x = params[key.offset], y = params[key.offset + 1], z = params[key.offset + 2];
    if (!(std::sqrt(x * x + y * y + z * z) < 1e-9)) return;  // NaN: not given
    problem_list.add([&] {
        return Problem{.code = "scenario.range",
                       .path = key.path,
                       .message = "a direction needs a length",
                       .got = "[0, 0, 0]",
                       .allowed = "any vector that is not zero"};
    });
}

// The rules of `arm`, its keys and what holds between them.
void check_arm(std::span<const double> params, const std::vector<const Key*>& keys, ProblemList& problem_list) {
    for (const Key* key : keys) check_numbers(*key, params, problem_list);
    check_convention(params, problem_list);
    check_sizes<"arm.link1">(params, problem_list);
    check_sizes<"arm.link2">(params, problem_list);
    check_sizes<"arm.link3">(params, problem_list);
    check_shapes(params, problem_list);
    if (is<"arm.model", "elbow">(params)) {
        check_inertia<"arm.link1.inertia">(params, problem_list);
        check_tip(params, problem_list);
        for (const char* rotor : {"arm.rotor1", "arm.rotor2", "arm.rotor3"})
            check_axis(known_key(std::string(rotor) + ".axis"), params, problem_list);
    }
    check_inertia<"arm.link2.inertia">(params, problem_list);
    check_inertia<"arm.link3.inertia">(params, problem_list);
}

// The controller's model must be a valid arm too; numbers that are not given there are those of the plant.
void check_model(std::span<const double> params, const std::vector<const Key*>& keys, ProblemList& problem_list) {
    check_arm(with_model(params), keys, problem_list);
    for (Problem& problem : problem_list.problems)
        problem.path.replace(0, std::string_view("arm").size(), "controller.model");
}

void check_all(std::span<const double> params, const NumberKeys& keys, std::optional<Setup>& setup,
               ProblemList& problem_list) {
    check_arm(params, keys.arm, problem_list);
    for (const Key* key : keys.others) check_numbers(*key, params, problem_list);
    if (problem_list.empty() && has_model(controller_type_of(params)) && model_differs(params))
        check_model(params, keys.model, problem_list);
    if (problem_list.empty()) check_setup(params, setup, problem_list);
}

bool is_choice(const Key& key) {
    return key.kind == Kind::choice || key.kind == Kind::flag || key.kind == Kind::section;
}

void check_choices(std::span<const double> params, ProblemList& problem_list) {
    if (!is_param_count(params.size()) || !has_whole_lists(params))
        return problem_list.add([&] {
            return Problem{
                .code = "argument.size",
                .message = "wrong number of parameters",
                .got = std::to_string(params.size()),
                .allowed = std::to_string(param_count()) + ", and lists that are longer than their keys behind"};
        });
    for (const Key& key : schema())
        if (is_choice(key)) check_choice(key, params, problem_list);
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

// The numbers `varied`, with those of controller.model replaced by the ones that they override.
std::vector<std::size_t> in_plant(std::span<const std::size_t> varied) {
    std::vector<std::size_t> numbers(varied.begin(), varied.end());
    for (const auto [from, to] : model_numbers()) std::ranges::replace(numbers, from, to);
    return numbers;
}

// Keeps the keys that contain one of the numbers `varied`, and those that are wrong in `params`.
void drop_decided(std::vector<const Key*>& keys, std::span<const double> params, std::span<const std::size_t> varied) {
    std::erase_if(keys, [&](const Key* key) {
        const auto has = [&](std::size_t number) { return number - key->offset < key->size; };
        ProblemList problem_list(ProblemList::count_only);
        check_numbers(*key, params, problem_list);
        return problem_list.empty() && std::ranges::none_of(varied, has);
    });
}

bool is_of_start_or_contact(std::size_t number) {
    const std::string& path = key_at(number).path;
    return path.starts_with("initial.") || path.starts_with("wall.contact.");
}

}  // namespace

void refuse_unknown_choices(std::span<const double> params) {
    ProblemList problem_list(ProblemList::messages);
    check_choices(params, problem_list);
    if (!problem_list.empty()) throw Error(ARM3R_E_SCENARIO, std::move(problem_list.problems));
}

Validation validate(std::span<const double> params) {
    ProblemList problem_list(ProblemList::messages);
    check_choices(params, problem_list);
    std::optional<Setup> setup;
    if (problem_list.empty()) check_all(params, number_keys(params), setup, problem_list);
    return {std::move(problem_list.problems), std::move(setup)};
}

Setup valid_setup(std::span<const double> params) {
    Validation validation = validate(params);
    if (!validation.setup) throw Error(ARM3R_E_SCENARIO, std::move(validation.problems));
    return *std::move(validation.setup);
}

Checker::Checker(std::span<const double> params, std::span<const std::size_t> varied) {
    ProblemList problem_list(ProblemList::count_only);
    check_choices(params, problem_list);
    readable_ = problem_list.empty();
    if (!readable_) return;
    keys_ = number_keys(params);
    drop_decided(keys_.arm, params, varied);
    drop_decided(keys_.others, params, varied);
    drop_decided(keys_.model, with_model(params), in_plant(varied));
    only_start_and_contact_vary_ =
        !has_law(controller_type_of(params)) && std::ranges::all_of(varied, is_of_start_or_contact);
}

std::optional<Setup> Checker::operator()(std::span<const double> params) const {
    std::optional<Setup> setup;
    (*this)(params, setup);
    return setup;
}

void Checker::operator()(std::span<const double> params, std::optional<Setup>& setup) const {
    if (!readable_) return setup.reset();
    ProblemList problem_list(ProblemList::count_only);
    if (setup && only_start_and_contact_vary_) {
        for (const Key* key : keys_.others) check_numbers(*key, params, problem_list);
        if (problem_list.empty()) check_start_and_contact(params, setup, problem_list);
        else setup.reset();
    } else {
        setup.reset();
        check_all(params, keys_, setup, problem_list);
    }
}

}  // namespace arm3r
