#include "schema/schema.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "arm3r/model/contact.hpp"
#include "schema/key_builders.hpp"
#include "schema/keys.hpp"
#include "schema/stiffness_presets.hpp"
#include "schema/suggest.hpp"

namespace arm3r {
namespace {

// Laws with three stiffnesses, or with another unit, have no default.
double default_stiffness(std::span<const double> params, double otherwise) {
    const ContactLawTraits& law = contact_law_table[static_cast<std::size_t>(param(params, "wall.contact.law"))];
    if (law.acts_along_plate || !law.is_linear) return unset;
    const auto preset = static_cast<std::size_t>(param(params, "wall.contact.preset"));
    return preset == 0 ? otherwise : stiffness_presets[preset - 1].stiffness;
}

// Whether the choice that decides on a key is one of its words.
bool is_chosen(const Key& key, std::span<const double> params) {
    return std::ranges::find(key.when, choice_of(params, *key.decided_by)) != key.when.end();
}

const Key* known_among(const std::vector<Key>& keys, const std::string& path) {
    const auto found = std::ranges::find(keys, path, &Key::path);
    if (found == keys.end()) throw Error(ARM3R_E_INTERNAL, "no key '" + path + "' in the schema");
    return &*found;
}

}  // namespace

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

namespace {

std::vector<Key> make_schema() {
    std::vector<Key> keys;
    append_plant(keys);
    append_start(keys);
    append_wall(keys);
    append_controller(keys);
    append_reference(keys);
    append_sampling(keys);
    append_observer(keys);
    append_push(keys);
    append_solver(keys);
    append_time(keys);
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
    constexpr const char* names[] = {"number",  "angle",  "integer", "flag",     "choice",
                                     "section", "column", "file",    "arm_file", "special"};
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
                                 .hint = near.empty() ? "" : "did you mean " + near + "?"}});
}

std::string list_sizes(const Key& key) {
    if (key.any_length) return std::to_string(key.min_size) + " or more";
    return (key.form == Form::list ? std::to_string(key.min_size) + " to " : "") + std::to_string(key.size);
}

bool takes_list(const Key& key, std::span<const double> params) { return choice_of(params, key.when_key) == key.word; }

std::vector<double> default_of(const Key& key, std::span<const double> params) {
    std::vector<double> value = key.fallback;
    if (!key.fallback_for.empty())
        if (const auto other = key.fallback_for.find(choice_of(params, *key.decided_by));
            other != key.fallback_for.end())
            return other->second;
    const bool is_elbow = choice_of(params, "arm.model") == "elbow";
    if (is_elbow && key.path == "arm.link1.mass") value = {0};
    if (is_elbow && key.path == "arm.link1.com") value = {0, 0, 0};
    if (is_elbow && key.path == "arm.link2.length") value = {unset};
    const bool link1_by_shape =
        key.path.starts_with("arm.link1.") && !key.unset.empty() && choice_of(params, "arm.link1.shape") != "explicit";
    if (link1_by_shape) std::fill(value.begin(), value.end(), unset);
    if (key.path == "wall.contact.stiffness") value[0] = default_stiffness(params, value[0]);
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

namespace {

constexpr std::size_t list_head = 2;  // offset of the key, number of numbers

// Calls visit(offset, numbers) for each list behind the flat array until it returns true. False: what stands there are
// not such lists.
template <class Visit>
bool each_list_behind(std::span<const double> params, Visit visit) {
    std::span<const double> rest = params.subspan(param_count());
    while (!rest.empty()) {
        if (rest.size() < list_head || !(rest[1] >= 0) || rest[1] > double(rest.size() - list_head)) return false;
        const auto n = static_cast<std::size_t>(rest[1]);
        if (visit(rest[0], rest.subspan(list_head, n))) return true;
        rest = rest.subspan(list_head + n);
    }
    return true;
}

}  // namespace

std::span<const double> list_at(std::span<const double> params, const Key& key) {
    std::span<const double> found;
    each_list_behind(params, [&](double offset, std::span<const double> numbers) {
        if (offset != double(key.offset)) return false;
        found = numbers;
        return true;
    });
    if (!found.empty()) return found;
    const std::span<const double> places = params.subspan(key.offset, key.size);
    const auto end = std::ranges::find_if(places, [](double x) { return std::isnan(x); });
    return places.first(static_cast<std::size_t>(end - places.begin()));
}

std::span<double> append_list(std::vector<double>& params, const Key& key, std::size_t n) {
    params.push_back(static_cast<double>(key.offset));
    params.push_back(static_cast<double>(n));
    params.resize(params.size() + n, unset);
    return std::span(params).last(n);
}

bool is_param_count(std::size_t count) {
    std::size_t fewest = max_table_numbers, most = 0;
    for (const Key& key : schema())
        if (key.any_length) {
            fewest = std::min(fewest, list_head + key.size + 1);
            most += list_head + max_list_length;
        }
    return count == param_count() || (count >= param_count() + fewest && count <= param_count() + most);
}

bool has_whole_lists(std::span<const double> params) {
    std::vector<double> seen;
    bool fits = true;
    const bool whole = each_list_behind(params, [&](double offset, std::span<const double> numbers) {
        const auto key = std::ranges::find_if(
            schema(), [&](const Key& one) { return one.any_length && double(one.offset) == offset; });
        const bool is_new = std::ranges::find(seen, offset) == seen.end();
        seen.push_back(offset);
        fits = key != schema().end() && is_new && numbers.size() > key->size && numbers.size() <= max_list_length &&
               std::isnan(params[key->offset]);
        return !fits;
    });
    return whole && fits;
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

namespace {

// A key of controller.model that exists wherever there is such a section.
const Key& key_of_any_model() { return known_key("controller.model.payload.mass"); }

}  // namespace

bool key_exists(const Key& key, std::span<const double> params) {
    if (key.plant && &key != &key_of_any_model() && !key_exists(key_of_any_model(), params)) return false;
    if (!key.decided_by) return true;
    return is_chosen(key, params) && key_exists(*key.decided_by, params);
}

const Key& key_refused(const Key& key, std::span<const double> params) {
    const Key* refused = &key;
    while (refused && (!refused->decided_by || is_chosen(*refused, params))) refused = refused->decided_by;
    return refused ? *refused : key_of_any_model();
}

std::vector<std::string> words_without(const Key& key) {
    std::vector<std::string> words = key.decided_by->choices;
    std::erase_if(words, [&](const std::string& word) { return std::ranges::find(key.when, word) != key.when.end(); });
    return words;
}

}  // namespace arm3r
