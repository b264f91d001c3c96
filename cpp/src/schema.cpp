#include "schema.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace arm3r {
namespace {

constexpr double unset = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
using std::numbers::pi;

constexpr Bounds any_position{-1e6, 1e6};
constexpr Bounds not_negative{0, 1e12};
constexpr Bounds a_length{1e-6, 1e6};
constexpr Bounds a_mass{1e-9, 1e9};
constexpr Bounds a_density{1e-3, 1e6};
constexpr Bounds no_bounds{-1e300, 1e300};

Key number(std::string path, std::vector<double> fallback, Source source, Bounds bounds, std::string unit,
           std::string doc) {
    const std::size_t size = fallback.size();
    return {.path = std::move(path),
            .kind = Kind::number,
            .size = size,
            .form = Form::fixed,
            .fallback = std::move(fallback),
            .source = source,
            .bounds = bounds,
            .unit = std::move(unit),
            .doc = std::move(doc)};
}

Key choice(std::string path, std::vector<std::string> words, Source source, std::string doc) {
    return {.path = std::move(path),
            .kind = Kind::choice,
            .size = 1,
            .form = Form::fixed,
            .fallback = {0},
            .source = source,
            .bounds = no_bounds,
            .unit = "",
            .doc = std::move(doc),
            .choices = std::move(words)};
}

Key of_kind(Kind kind, Key key) {
    key.kind = kind;
    return key;
}

Key with_form(Form form, Key key, std::string word = {}) {
    key.form = form;
    key.word = std::move(word);
    return key;
}

Key where(std::string when_key, std::vector<std::string> when, Key key) {
    key.when_key = std::move(when_key);
    key.when = std::move(when);
    return key;
}

Key needed(Key key) {
    key.required = true;
    return key;
}

Key derived(std::string unset_means, Key key) {
    key.unset = std::move(unset_means);
    return key;
}

Key or_infinite(Key key) {
    key.allow_infinity = true;
    return key;
}

// The keys that a shape takes, for any link. The shape itself stands before them.
void append_shape(std::vector<Key>& keys, const std::string& link) {
    const std::string shape = link + ".shape";
    keys.push_back(where(shape, {"brick"},
                         number(link + ".section", {0.01, 0.01}, Source::inferred, a_length, "m",
                                "Brick: height along y, width along z of the link's axes.")));
    keys.push_back(where(shape, {"cylinder"},
                         needed(number(link + ".radius", {unset}, Source::ours, a_length, "m", "Cylinder: radius."))));
    keys.push_back(where(shape, {"brick", "cylinder"},
                         number(link + ".density", {7850}, Source::inferred, a_density, "kg/m^3",
                                "Density; not used when the mass is given.")));
}

void append_link1(std::vector<Key>& keys, const std::string& link) {
    keys.push_back(choice(
        link + ".shape", {"explicit", "brick", "cylinder", "slender"}, Source::ours,
        "Shape of the column on joint 1, its length along z; explicit: mass, com and inertia_axial as they stand."));
    keys.push_back(
        where(link + ".shape", {"brick", "cylinder", "slender"},
              number(link + ".length", {1}, Source::inferred, a_length, "m", "Length along the joint-1 axis.")));
    append_shape(keys, link);
    keys.push_back(derived("from the shape", number(link + ".mass", {0.785}, Source::lecture, a_mass, "kg", "Mass.")));
    keys.push_back(derived("length/2", number(link + ".com", {0}, Source::inferred, any_position, "m",
                                              "Height of the centre of mass on the joint-1 axis.")));
    keys.push_back(derived("from the shape", number(link + ".inertia_axial", {1.3083333333333334e-5}, Source::inferred,
                                                    not_negative, "kg m^2", "Inertia about the joint-1 axis.")));
}

void append_link(std::vector<Key>& keys, const std::string& link) {
    keys.push_back(choice(link + ".shape", {"brick", "cylinder", "slender"}, Source::inferred,
                          "Gives mass, centre of mass and inertia; each of these given beside it replaces that one."));
    keys.push_back(
        number(link + ".length", {1}, Source::lecture, a_length, "m", "Length, from joint to joint (or tip)."));
    append_shape(keys, link);
    keys.push_back(derived("from the shape", number(link + ".mass", {unset}, Source::lecture, a_mass, "kg",
                                                    "Mass; the inertia of the shape scales with it.")));
    keys.push_back(derived("length/2", number(link + ".com", {unset}, Source::lecture, any_position, "m",
                                              "Centre of mass, along the link from its joint.")));
    keys.push_back(derived(
        "from the shape",
        number(
            link + ".inertia", {unset, unset, unset}, Source::inferred, not_negative, "kg m^2",
            "Principal inertias [Ix, Iy, Iz] about the centre of mass; x along the link, y in the arm's vertical plane, z along the joint.")));
}

void append_arm(std::vector<Key>& keys, const std::string& arm) {
    keys.push_back(number(arm + ".base_height", {0}, Source::inferred, any_position, "m",
                          "Height of joint 2 above the base frame."));
    append_link1(keys, arm + ".link1");
    append_link(keys, arm + ".link2");
    append_link(keys, arm + ".link3");
    keys.push_back(number(arm + ".armature", {0, 0, 0}, Source::lecture, not_negative, "kg m^2",
                          "Rotor inertia seen at each joint."));
    keys.push_back(number(arm + ".damping", {0, 0, 0}, Source::lecture, not_negative, "N m s/rad",
                          "Viscous friction of each joint."));
    keys.push_back(number(arm + ".friction", {0, 0, 0}, Source::lecture, not_negative, "N m",
                          "Dry friction of each joint: friction*tanh(qd/friction_velocity)."));
    keys.push_back(number(arm + ".friction_velocity", {1e-3}, Source::ours, {1e-12, 1e6}, "rad/s",
                          "Rate at which dry friction sets in."));
    keys.push_back(or_infinite(number(arm + ".torque_limit", {infinite, infinite, infinite}, Source::lecture,
                                      not_negative, "N m", "Largest torque of each actuator, either way.")));
    keys.push_back(number(arm + ".payload.mass", {0}, Source::lecture, {0, 1e9}, "kg", "Point mass at the tip."));
}

// The controller's copy of the arm: the same keys, each "as the plant" unless given.
void append_model(std::vector<Key>& keys) {
    const std::string prefix = "controller.model";
    std::vector<Key> copy;
    append_arm(copy, prefix);
    for (Key& key : copy) {
        std::fill(key.fallback.begin(), key.fallback.end(), unset);
        key.source = Source::ours;
        key.required = false;
        key.unset = "as the plant";
        if (key.when_key.empty()) key = where("controller.type", {"gravity_compensation"}, key);
        keys.push_back(std::move(key));
    }
}

void append_wall(std::vector<Key>& keys) {
    keys.push_back(of_kind(Kind::section, number("wall", {0}, Source::lecture, no_bounds, "",
                                                 "The moving plate. Absent: no wall; `wall: {}` is the lecture's.")));
    keys.push_back(number("wall.point", {2, 0, 0}, Source::lecture, any_position, "m",
                          "Origin of the plate's frame, its centre, at t = 0."));
    keys.push_back(number("wall.normal", {-1, 0, 0}, Source::lecture, any_position, "",
                          "From the wall towards the arm; normalised on reading."));
    keys.push_back(
        with_form(Form::vector_or_word,
                  number("wall.size", {1, 1}, Source::lecture, a_length, "m", "Extent along e1 and e2, or infinite."),
                  "infinite"));
    keys.push_back(number("wall.face_offset", {0}, Source::lecture, any_position, "m",
                          "How far the contact face lies in front of the frame."));
    keys.push_back(
        choice("wall.motion.type", {"constant", "fixed", "sinusoid"}, Source::lecture, "How the wall moves."));
    keys.push_back(
        where("wall.motion.type", {"constant"},
              with_form(Form::number_or_vector,
                        number("wall.motion.velocity", {0.05, unset, unset}, Source::lecture, {-1e4, 1e4}, "m/s",
                               "Along the normal, positive towards the arm; or a vector in base axes."))));
    keys.push_back(where("wall.motion.type", {"sinusoid"},
                         needed(number("wall.motion.amplitude", {unset}, Source::ours, {-1e3, 1e3}, "m",
                                       "Amplitude A of s = A sin(2 pi f t + phase) - A sin(phase)."))));
    keys.push_back(
        where("wall.motion.type", {"sinusoid"},
              needed(number("wall.motion.frequency", {unset}, Source::ours, {0, 1e4, true}, "Hz", "Frequency f."))));
    keys.push_back(where(
        "wall.motion.type", {"sinusoid"},
        of_kind(Kind::angle, number("wall.motion.phase", {0}, Source::ours, {-1e4, 1e4}, "rad", "Phase at t = 0."))));
    keys.push_back(choice(
        "wall.contact.law", {"spring", "diagonal"}, Source::lecture,
        "spring: along the normal; diagonal: K_E in the wall's axes, which ties the tip sideways too and can only be measured."));
    keys.push_back(
        where("wall.contact.law", {"spring", "diagonal"},
              needed(with_form(Form::by_choice,
                               number("wall.contact.stiffness", {1000, unset, unset}, Source::ours, {0, 1e15}, "N/m",
                                      "K_E: one number for a spring, [kn, k1, k2] for diagonal.")))));
    keys.push_back(of_kind(
        Kind::flag, number("wall.acts_on_arm", {0}, Source::lecture, no_bounds, "",
                           "false: the force is only measured, as in the lecture; true: the arm feels f_on_tip.")));
}

void append_controller(std::vector<Key>& keys) {
    keys.push_back(
        choice("controller.type", {"none", "constant", "gravity_compensation"}, Source::ours, "The control law."));
    keys.push_back(where("controller.type", {"constant"},
                         needed(number("controller.torque", {unset, unset, unset}, Source::ours, {-1e12, 1e12}, "N m",
                                       "The torque, in the arm's convention."))));
    keys.push_back(where(
        "controller.type", {"gravity_compensation"},
        with_form(
            Form::number_or_vector,
            number(
                "controller.gravity", {9.80665, unset, unset}, Source::lecture, {-1e4, 1e4}, "m/s^2",
                "The gravity that is compensated, whatever the plant feels: a number along -z, or a vector in base axes."))));
    keys.push_back(
        where("controller.type", {"gravity_compensation"},
              choice("controller.algorithm", {"closed_form", "recursion"}, Source::lecture,
                     "How the torque is computed: by the lecture's formula or by the Newton-Euler recursion.")));
    append_model(keys);
}

void append_solver(std::vector<Key>& keys) {
    keys.push_back(choice(
        "solver.method", {"dopri5", "rk4", "taylor"}, Source::ours,
        "dopri5: Dormand-Prince 5(4), adaptive; rk4: classical Runge-Kutta, fixed step; taylor: power series, adaptive."));
    keys.push_back(where("solver.method", {"dopri5"},
                         number("solver.rtol", {1e-9}, Source::ours, {2.220446049250313e-14, 0.1}, "",
                                "Relative tolerance of a step; not below 100 times the rounding unit.")));
    keys.push_back(
        where("solver.method", {"dopri5"},
              number("solver.atol", {1e-12}, Source::ours, {1e-20, 1}, "rad, rad/s", "Absolute tolerance of a step.")));
    keys.push_back(where("solver.method", {"taylor"},
                         number("solver.tol", {1e-9}, Source::ours, {1e-15, 1e-2}, "rad, rad/s",
                                "Tolerance of a step: absolute below 1, relative above.")));
    keys.push_back(where(
        "solver.method", {"dopri5", "taylor"},
        derived("no limit", number("solver.max_step", {unset}, Source::ours, {1e-12, 1e9}, "s", "Largest step."))));
    keys.push_back(
        where("solver.method", {"rk4"}, number("solver.step", {1e-3}, Source::ours, {1e-12, 1e9}, "s", "The step.")));
    keys.push_back(of_kind(Kind::integer, number("solver.max_steps", {1e7}, Source::ours, {1, 1e9}, "",
                                                 "Accepted and rejected steps after which the run ends as `budget`.")));
}

const Key* known_among(const std::vector<Key>& keys, const std::string& path) {
    const auto found = std::ranges::find(keys, path, &Key::path);
    if (found == keys.end()) throw Error(ARM3R_E_INTERNAL, "no key '" + path + "' in the schema");
    return &*found;
}

void connect(std::vector<Key>& keys) {
    constexpr std::string_view model = "controller.model.";
    std::size_t offset = 0;
    for (Key& key : keys) {
        key.offset = offset;
        offset += key.size;
        if (!key.when_key.empty()) key.decided_by = known_among(keys, key.when_key);
        if (key.path.starts_with(model)) key.plant = known_among(keys, "arm." + key.path.substr(model.size()));
    }
}

std::vector<Key> make_schema() {
    std::vector<Key> keys;
    keys.push_back(choice(
        "arm.convention", {"simscape", "slide"}, Source::lecture,
        "Sign of joints 2 and 3. simscape: positive angles lower the arm (axes +y); slide: they raise it (axes -y)."));
    keys.push_back(number("arm.gravity", {0, 0, -9.80665}, Source::lecture, {-1e4, 1e4}, "m/s^2",
                          "What the plant feels, in the base frame."));
    append_arm(keys, "arm");
    keys.push_back(of_kind(
        Kind::angle,
        number(
            "initial.q", {0, -30 * pi / 180, 60 * pi / 180}, Source::lecture, {-1e5, 1e5}, "rad",
            "Joint angles at t = 0. The default is the lecture's pose: [0, -30 deg, 60 deg], or [0, 30 deg, -60 deg] in the slide convention.")));
    keys.push_back(of_kind(Kind::angle, number("initial.qd", {0, 0, 0}, Source::lecture, {-1e6, 1e6}, "rad/s",
                                               "Joint rates at t = 0; 10 deg means 10 deg/s.")));
    append_wall(keys);
    append_controller(keys);
    append_solver(keys);
    keys.push_back(number("time.stop", {10}, Source::ours, {0, 1e9}, "s", "End of the run; 0 gives one row."));
    keys.push_back(
        number("time.log_every", {0.01}, Source::ours, {1e-12, 1e9}, "s",
               "Time between rows; t = 0 and the end are always rows, and the log never changes the steps."));
    connect(keys);
    return keys;
}

const std::map<std::string, const Key*, std::less<>>& by_path() {
    static const auto index = [] {
        std::map<std::string, const Key*, std::less<>> paths;
        for (const Key& key : schema()) paths[key.path] = &key;
        return paths;
    }();
    return index;
}

}  // namespace

const std::vector<Key>& schema() {
    static const std::vector<Key> keys = make_schema();
    return keys;
}

const Key* find_key(std::string_view path) {
    const auto found = by_path().find(path);
    return found == by_path().end() ? nullptr : found->second;
}

const Key& known_key(std::string_view path) {
    const Key* key = find_key(path);
    if (!key) throw Error(ARM3R_E_INTERNAL, "no key '" + std::string(path) + "' in the schema");
    return *key;
}

const char* kind_name(Kind kind) {
    constexpr const char* names[] = {"number", "angle", "integer", "flag", "choice", "section"};
    return names[static_cast<std::size_t>(kind)];
}

const Key& key_at(std::size_t index) {
    for (const Key& key : schema())
        if (index < key.offset + key.size) return key;
    throw Error(ARM3R_E_INDEX,
                "there is no parameter " + std::to_string(index) + "; there are " + std::to_string(param_count()));
}

std::size_t param_count() {
    const Key& last = schema().back();
    return last.offset + last.size;
}

std::string param_name(std::size_t index) {
    const Key& key = key_at(index);
    return key.size == 1 ? key.path : key.path + "[" + std::to_string(index - key.offset) + "]";
}

std::size_t param_index(std::string_view name) {
    const std::size_t bracket = name.find('[');
    const Key* key = find_key(name.substr(0, bracket));
    if (key && bracket == name.npos && (key->size == 1 || key->form != Form::fixed)) return key->offset;
    if (key && bracket != name.npos) {
        std::size_t item = key->size;
        const char* end = name.data() + name.size();
        const auto [stop, error] = std::from_chars(name.data() + bracket + 1, end, item);
        if (error == std::errc() && stop + 1 == end && *stop == ']' && item < key->size) return key->offset + item;
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < param_count(); ++i) names.push_back(param_name(i));
    const std::string near = key ? param_name(key->offset) : nearest(name, names);
    throw Error(ARM3R_E_INDEX, {{.code = "argument.parameter",
                                 .path = std::string(name),
                                 .message = "no parameter has this name",
                                 .got = "",
                                 .allowed = "",
                                 .hint = near.empty() ? "" : "did you mean " + near + "?"}});
}

std::vector<double> default_of(const Key& key, std::span<const double> params) {
    std::vector<double> value = key.fallback;
    const bool link1_by_shape =
        key.path.starts_with("arm.link1.") && !key.unset.empty() && choice_of(params, "arm.link1.shape") != "explicit";
    const bool three_numbers = key.form == Form::by_choice && choice_of(params, key.when_key) != key.when.front();
    if (link1_by_shape || three_numbers) std::fill(value.begin(), value.end(), unset);
    if (key.path == "initial.q" && choice_of(params, "arm.convention") == "slide")
        value = {value[0], -value[1], -value[2]};
    return value;
}

std::vector<double> param_defaults() {
    std::vector<double> params(param_count(), 0.0);
    for (const Key& key : schema()) {
        const std::vector<double> value = default_of(key, params);
        std::copy(value.begin(), value.end(), params.begin() + static_cast<std::ptrdiff_t>(key.offset));
    }
    return params;
}

double param(std::span<const double> params, std::string_view path, std::size_t item) {
    return params[known_key(path).offset + item];
}

const std::string& choice_of(std::span<const double> params, const Key& key) {
    const double stored = params[key.offset];
    if (std::isnan(stored) && key.plant) return choice_of(params, *key.plant);
    return key.choices.at(static_cast<std::size_t>(stored));
}

const std::string& choice_of(std::span<const double> params, std::string_view path) {
    return choice_of(params, known_key(path));
}

double choice_index(const Key& key, std::string_view word) {
    const auto found = std::ranges::find(key.choices, word);
    if (found == key.choices.end())
        throw Error(ARM3R_E_INTERNAL, "no choice '" + std::string(word) + "' at '" + key.path + "' in the schema");
    return static_cast<double>(found - key.choices.begin());
}

bool key_exists(const Key& key, std::span<const double> params) {
    if (!key.decided_by) return true;
    const std::string& chosen = choice_of(params, *key.decided_by);
    return std::ranges::find(key.when, chosen) != key.when.end() && key_exists(*key.decided_by, params);
}

}  // namespace arm3r
