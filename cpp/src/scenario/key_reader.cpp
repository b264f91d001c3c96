#include "scenario/key_reader.hpp"

#include <algorithm>
#include <tuple>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/paths.hpp"
#include "scenario/meant_key.hpp"
#include "scenario/meant_word.hpp"
#include "schema/key_builders.hpp"

namespace arm3r {
namespace {

std::string words_text(const Key& key) { return key.word.empty() ? listed(key.choices) : key.word; }

std::string with_unit(std::string value, const Key& key) { return key.unit.empty() ? value : value + " " + key.unit; }

bool is_infinity(const Node& node) {
    return node.text.ends_with("inf") || node.text.ends_with("Inf") || node.text.ends_with("INF");
}

std::string flag_hint(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    const Words yes = {"yes", "y", "on", "1", "true"}, no = {"no", "n", "off", "0", "false"};
    if (std::find(yes.begin(), yes.end(), text) != yes.end()) return "write true";
    return std::find(no.begin(), no.end(), text) != no.end() ? "write false" : "";
}

// "q" is most likely meant as q1, q2, q3.
std::string meant_column(const Key& key, const std::string& text) {
    for (const char* ends : {"123", "xyz"})
        for (const char* joint : {"", "_"}) {
            Words three;
            for (const char* end = ends; *end; ++end) three.push_back(text + joint + *end);
            if (std::all_of(three.begin(), three.end(), [&](const auto& name) { return is_in(key.choices, name); }))
                return "write " + listed(three);
        }
    return did_you_mean(text, key.choices);
}

}  // namespace

void KeyReader::problem(const SourceLocation& at, Problem problem) {
    problems_.push_back(located(std::move(problem), at, file_));
}

void KeyReader::check_format(const Node& root, const std::string& kind) {
    const std::string code = kind + ".format";
    const Node* node = root.find("format");
    if (!node)
        return problem(root.mark, {code, "format", "the version of the format is missing", "", "",
                                   "write `format: 1` as the first line"});
    NumberFault fault;
    const auto value = node->type == Node::scalar
                           ? read_number(node->text, {.whole = true, .quoted = node->quoted}, fault)
                           : std::nullopt;
    if (!value) problem(node->mark, {code, "format", "expects a whole number", node_text(*node), "1", ""});
    else if (*value != file_format)
        throw Error(ARM3R_E_FORMAT,
                    {located({code, "format",
                              "written for format " + shortest(*value) + ", this is " + std::to_string(file_format), "",
                              "", ""},
                             node->mark, file_)});
}

void KeyReader::finish() {
    if (problems_.empty()) return;
    const auto place = [](const Problem& p) { return std::tuple(p.line == 0, p.line, p.column); };
    std::stable_sort(problems_.begin(), problems_.end(),
                     [&](const Problem& a, const Problem& b) { return place(a) < place(b); });
    throw Error(ARM3R_E_SCENARIO, std::move(problems_));
}

std::string KeyReader::expected(const Key& key) const {
    const std::string unit = key.unit.empty() ? "" : " (" + key.unit + ")";
    const std::string list = "a list of " + list_sizes(key) + " numbers" + unit;
    switch (key.kind) {
        case Kind::flag: return "true or false";
        case Kind::choice: return "one of " + words_text(key);
        case Kind::section: return "a map";
        case Kind::integer: return "a whole number" + unit;
        case Kind::file: return "the name of a file";
        case Kind::arm_file: return "what is said of a URDF";
        case Kind::column: return "a list of 1 to " + std::to_string(key.size) + " names of columns";
        case Kind::special: return key.word;
        default: break;
    }
    switch (key.form) {
        case Form::number_or_vector: return "a number" + unit + " or " + list;
        case Form::vector_or_word: return list + " or " + key.word;
        case Form::by_choice: return takes_list(key, params_) ? list : "a number" + unit;
        default: return key.size == 1 ? "a number" + unit : list;
    }
}

// ---- one word, flag or number

std::optional<double> KeyReader::word(const Key& key, const Node& node) {
    const auto word = std::find(key.choices.begin(), key.choices.end(), node.text);
    if (node.type == Node::scalar && word != key.choices.end()) return static_cast<double>(word - key.choices.begin());
    unknown_choices_.insert(key.path);
    problem(node.mark, {"scenario.unknown_word", key.path, "must be one of the words", node_text(node), words_text(key),
                        suggested_word(key, node.text)});
    return {};
}

std::optional<double> KeyReader::flag(const Key& key, const Node& node) {
    const bool is_true = node.text == "true";
    if (node.type == Node::scalar && !node.quoted && (is_true || node.text == "false")) return is_true;
    problem(node.mark, {"scenario.type", key.path, "expects true or false", node_text(node), "", flag_hint(node.text)});
    return {};
}

std::optional<double> KeyReader::number(const Key& key, const Node& node, const std::string& path) {
    NumberFault fault{"scenario.type", "expects " + with_unit("a number", key), ""};
    if (node.type == Node::scalar) {
        const NumberRules rules{.degrees = key.kind == Kind::angle,
                                .infinity = key.allow_infinity,
                                .whole = key.kind == Kind::integer,
                                .quoted = node.quoted,
                                .unit = key.unit};
        if (const auto number = read_number(node.text, rules, fault)) return number;
    }
    if (key.form == Form::vector_or_word && is_infinity(node)) fault.hint = "write " + key.word + ", not a list";
    problem(node.mark, {fault.code, path, fault.message, node_text(node), "", fault.hint});
    return {};
}

// ---- all that a key takes

bool KeyReader::is_number_here(const Key& key, const Node& node) const {
    if (node.type != Node::scalar) return false;
    if (key.form == Form::by_choice) return !takes_list(key, params_);
    return key.form == Form::number_or_vector || (key.size == 1 && key.form != Form::list);
}

bool KeyReader::is_list_here(const Key& key) const {
    if (key.form == Form::by_choice) return takes_list(key, params_);
    return key.size > 1 || key.form == Form::list;
}

bool KeyReader::store(const Key& key, const Node& node) {
    if (key.kind == Kind::flag || is_number_here(key, node)) {
        const auto value = key.kind == Kind::flag ? flag(key, node) : number(key, node, key.path);
        if (value) std::fill_n(at(key), key.size, unset), *at(key) = *value;
        return value.has_value();
    }
    if (key.form == Form::vector_or_word && node.type == Node::scalar && node.text == key.word) {
        std::fill_n(at(key), key.size, infinite);
        return true;
    }
    const std::size_t min_size = key.form == Form::list ? key.min_size : key.size;
    const bool fits = is_list_here(key) && node.type == Node::list && node.children.size() >= min_size &&
                      node.children.size() <= (key.any_length ? max_list_length : key.size);
    if (fits) read_list(key, node);
    else wrong_shape(key, node);
    return fits;
}

void KeyReader::read_list(const Key& key, const Node& node) {
    if (key.form == Form::list) std::fill_n(at(key), key.size, unset);
    const std::size_t n = node.children.size();
    const std::span<double> numbers = n > key.size ? append_list(params_, key, n) : std::span(at(key), n);
    for (std::size_t i = 0; i < n; ++i)
        if (key.kind == Kind::column) read_column(key, node, i);
        else if (node.children[i].type != Node::unset)
            numbers[i] = number(key, node.children[i], item(key.path, i)).value_or(numbers[i]);
}

void KeyReader::read_column(const Key& key, const Node& list, std::size_t i) {
    const Node& node = list.children[i];
    const std::string path = item(key.path, i);
    const auto word = std::find(key.choices.begin(), key.choices.end(), node.text);
    if (node.type != Node::scalar || word == key.choices.end())
        return problem(node.mark, {"scenario.unknown_word", path, "there is no such column", node_text(node),
                                   words_text(key), meant_column(key, node.text)});
    const auto is_same = [&](const Node& other) { return other.type == Node::scalar && other.text == node.text; };
    if (std::any_of(list.children.begin(), list.children.begin() + static_cast<std::ptrdiff_t>(i), is_same))
        return problem(node.mark, {"scenario.column", path, "this column stands in the list twice", node.text, "",
                                   "take one of the two out"});
    at(key)[i] = static_cast<double>(word - key.choices.begin());
}

// ---- what does not fit

void KeyReader::wrong_shape(const Key& key, const Node& node) {
    std::string hint;
    if (node.type == Node::nothing && !key.required) hint = "leave the key out for its default";
    if (key.form == Form::by_choice) hint = last_name(key.when_key) + " is " + choice_of(params_, *key.decided_by);
    if (key.form == Form::vector_or_word && node.type == Node::scalar)
        hint = is_infinity(node) ? "write " + key.word : did_you_mean(node.text, {key.word});
    if (is_list_here(key) && node.type == Node::list && node.children.size() > key.size)
        hint = "a comma parts the items; in a number use a point";
    problem(node.mark, {"scenario.type", key.path, "expects " + expected(key), node_text(node), "", hint});
}

void KeyReader::refuse_other_choice(const Key& key, const Node& node) {
    const Key& refused = key_refused(key, params_);
    if (unknown_choices_.contains(refused.when_key)) return;
    const std::string choice = last_name(refused.when_key), name = "`" + last_name(key.path) + "`";
    const std::string& here = choice_of(params_, *refused.decided_by);
    const std::string words = listed(refused.when, " or ");
    if (refused.when_key == "controller.type" && here == "none" && key.path.starts_with("reference."))
        return problem(node.key_mark, {"scenario.other_choice", key.path,
                                       "`" + key.path.substr(0, key.path.find('.')) +
                                           "` is followed by a control law, and controller.type is none",
                                       "", "", "add controller: {type: ...}, one of " + words});
    const bool is_of_most = words_without(refused).size() < refused.when.size();
    const std::string instead = meant_instead(key, params_);
    problem(node.key_mark,
            {"scenario.other_choice", key.path,
             is_of_most ? name + " does not go with " + choice + " " + here
                        : name + " belongs to " + choice + " " + words + "; here the " + choice + " is " + here,
             "", "",
             !instead.empty() ? instead
             : is_of_most     ? "take it out, or choose another " + refused.when_key
                              : "take it out, or set " + refused.when_key + " to " + words});
}

}  // namespace arm3r
