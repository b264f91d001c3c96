#include "scenario/json_schema.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/paths.hpp"
#include "results/checks.hpp"
#include "scenario/reference_docs.hpp"
#include "scenario/sweep.hpp"
#include "schema/columns.hpp"
#include "schema/schema.hpp"
#include "schema/usual_range.hpp"

namespace arm3r {

namespace {

using Words = std::vector<std::string>;
using Params = std::vector<double>;

// ---- pieces of JSON

std::string object(const Words& members) { return "{" + listed(members) + "}"; }

std::string array(const Words& items) { return "[" + listed(items) + "]"; }

std::string member(std::string_view name, const std::string& value) { return json_string(name) + ": " + value; }

std::string json_words(Words words) {
    for (std::string& word : words) word = json_string(word);
    return array(words);
}

// Members on lines of their own.
std::string lines(const Words& members, const std::string& indent) {
    return "{\n" + indent + "  " + listed(members, ",\n" + indent + "  ") + "\n" + indent + "}";
}

// ---- a value

void append_bound(Words& members, std::string name, double value, bool open) {
    if (std::isinf(value)) return;
    if (open) name = name == "minimum" ? "exclusiveMinimum" : "exclusiveMaximum";
    members.push_back(member(name, shortest(value)));
}

std::string or_degrees(const std::string& number) {
    return R"({"anyOf": [)" + number + R"(, {"type": "string", "pattern": "^[-+.0-9e]+ +deg$"}]})";
}

std::string number_schema(const Key& key) {
    Words members = {member("type", json_string(key.kind == Kind::integer ? "integer" : "number"))};
    append_bound(members, "minimum", key.bounds.low, key.bounds.open_low);
    append_bound(members, "maximum", key.bounds.high, key.bounds.open_high);
    const std::string number = object(members);
    if (key.kind == Kind::angle) return or_degrees(number);
    return key.allow_infinity ? R"({"anyOf": [)" + number + R"(, {"const": "inf"}]})" : number;
}

std::string list_schema(const Key& key, const std::string& number) {
    const std::size_t fewest = key.form == Form::list ? key.min_size : key.size;
    const std::size_t most = key.any_length ? max_list_length : key.size;
    return object({member("type", json_string("array")), member("items", number),
                   member("minItems", std::to_string(fewest)), member("maxItems", std::to_string(most))});
}

std::string arm_file_schema(const std::string& name) {
    const std::string angle = R"({"type": ["number", "string"]})", text = R"({"type": "string", "minLength": 1})";
    if (name == "joints") return R"({"type": "array", "items": )" + text + R"(, "minItems": 3, "maxItems": 3})";
    if (name == "lock") return R"({"type": "object", "additionalProperties": )" + angle + "}";
    return name == "axis_tolerance" ? angle : text;
}

std::string special_schema(const Key& key);

// For the choices made in `params`.
std::string value_schema(const Key& key, const Params& params) {
    if (key.kind == Kind::flag) return R"({"type": "boolean"})";
    if (key.kind == Kind::file) return R"({"type": "string", "minLength": 1})";
    if (key.kind == Kind::arm_file) return arm_file_schema(last_name(key.path));
    if (key.kind == Kind::choice) return object({member("enum", json_words(key.choices))});
    if (key.kind == Kind::special) return special_schema(key);
    if (key.kind == Kind::column)
        return R"({"type": "array", "items": {"enum": )" + json_words(key.choices) +
               R"(}, "minItems": 1, "uniqueItems": true})";
    const std::string number = number_schema(key), list = list_schema(key, number);
    switch (key.form) {
        case Form::vector_or_word: return R"({"anyOf": [)" + list + R"(, {"const": )" + json_string(key.word) + "}]}";
        case Form::number_or_vector: return R"({"anyOf": [)" + number + ", " + list + "]}";
        case Form::by_choice: return takes_list(key, params) ? list : number;
        case Form::list: return list;
        default: return key.size == 1 ? number : list;
    }
}

// The default for the choices made in `params`; "" where it is derived, or where a choice of another section decides.
std::string default_json(const Key& key, const Key* primary, const Params& params) {
    const std::vector<double> value = default_of(key, params);
    const bool depends = !key.fallback_for.empty() && key.decided_by != primary;
    if (depends || !key.unset.empty() || std::isnan(value.front())) return "";
    if (key.kind == Kind::choice) return json_string(key.choices[static_cast<std::size_t>(value[0])]);
    if (key.kind == Kind::flag) return value[0] != 0 ? "true" : "false";
    Words numbers;
    for (const double number : value)
        if (!std::isnan(number)) numbers.push_back(json_number(number));
    return numbers.size() == 1 ? numbers[0] : array(numbers);
}

// The members of a usual range that differ from those of another one: for sliders.
std::string range_json(const UsualRange& range, const UsualRange& other) {
    Words members;
    if (range.around_zero != other.around_zero) members.push_back(member("zero", json_number(range.around_zero)));
    if (range.factor != other.factor) members.push_back(member("factor", json_number(range.factor)));
    if (range.is_signed) members.push_back(member("signed", "true"));
    if (range.is_turn) members.push_back(member("turn", "true"));
    return members.empty() ? "" : object(members);
}

// Of a number, where it is not that of most numbers, which the document has.
std::string range_json(const Key& key) {
    const bool is_number = key.kind == Kind::number || key.kind == Kind::angle || key.kind == Kind::integer;
    return is_number ? range_json(usual_range(key), {}) : "";
}

std::string described_value(const Key& key, const Key* primary, const Params& params) {
    const std::string unit = key.unit.empty() ? "" : " [" + unit_text(key) + "]";
    Words members = {member("description", json_string(key.doc + unit))};
    if (!key.unit.empty()) members.push_back(member("x-unit", json_string(key.unit)));
    if (const std::string range = range_json(key); !range.empty()) members.push_back(member("x-range", range));
    if (const std::string value = default_json(key, primary, params); !value.empty())
        members.push_back(member("default", value));
    return "{" + listed(members) + ", " + value_schema(key, params).substr(1);
}

// ---- choices

// The choice on which the keys of a section depend, such as its `type`; nullptr: none.
const Key* primary_choice(const std::string& section) {
    for (const Key& key : schema())
        if (key.decided_by && key.path.starts_with(section + ".") &&
            key.decided_by->path == join(section, last_name(key.decided_by->path)))
            return key.decided_by;
    return nullptr;
}

// Whether a key exists for a word of the primary choice of its section, whatever else is chosen.
bool exists_for(const Key& key, const Key* primary, std::string_view word) {
    for (const Key* at = &key; at->decided_by; at = at->decided_by)
        if (at->decided_by == primary) return is_in(at->when, word);
    return true;
}

Params params_with(const Key& choice, std::string_view word) {
    Params params = param_defaults();
    params[choice.offset] = choice_index(choice, word);
    return params;
}

const std::string& default_word(const Key& choice) {
    return choice.choices[static_cast<std::size_t>(choice.fallback.front())];
}

// The condition that a choice in this map is one of these words; one that is not written is its default.
std::string chosen(const Key& choice, const Words& words) {
    const std::string name = last_name(choice.path);
    const std::string is_word = R"({"enum": )" + json_words(words) + "}";
    Words members = {member("properties", object({member(name, is_word)}))};
    const bool may_be_missing = !std::isnan(choice.fallback.front()) && is_in(words, default_word(choice));
    if (!may_be_missing) members.push_back(member("required", json_words({name})));
    return object(members);
}

std::string rule(const std::string& condition, const std::string& then) {
    return object({member("if", condition), member("then", then)});
}

std::string required(const Words& names) { return member("required", json_words(names)); }

std::string without(Words names) {
    for (std::string& name : names) name = member(name, "false");
    return object({member("properties", object(names))});
}

// ---- sweeps

// A map with the keys that stand in the table of sweeps below `section`.
Words sweep_map(const std::string& section) {
    Words properties, needed, rules;
    for (const Key& key : sweep_keys()) {
        const std::string name = last_name(key.path);
        if (key.path != join(section, name)) continue;
        properties.push_back(member(name, described_value(key, nullptr, param_defaults())));
        if (!key.decided_by && key.required) needed.push_back(name);
        if (section == "axes" && !key.required) rules.push_back(object({required({name})}));
        if (section.empty() && key.decided_by) {
            rules.push_back(rule(chosen(*key.decided_by, key.when), object({required({name})})));
            rules.push_back(rule(chosen(*key.decided_by, words_without(key)), without({name})));
        }
    }
    Words members = {member("type", json_string("object")), required(needed), member("additionalProperties", "false"),
                     member("properties", lines(properties, section.empty() ? "  " : "      "))};
    if (!rules.empty()) members.push_back(member(section.empty() ? "allOf" : "oneOf", array(rules)));
    return members;
}

// What `set` can name: keys, their single numbers, and sections.
Words settable() {
    std::set<std::string> paths;
    for (const std::string& path : all_paths())
        for (std::size_t end = path.size(); end != path.npos; end = path.rfind('.', end - 1))
            paths.insert(path.substr(0, end));
    for (std::size_t i = 0; i < param_count(); ++i) paths.insert(param_name(i));
    paths.erase("format");
    return Words(paths.begin(), paths.end());
}

std::string special_schema(const Key& key) {
    if (key.path == "format") return R"({"const": 1})";
    if (key.path == "scenario") return R"({"type": ["string", "object"]})";
    if (key.path == "set") return R"({"type": "object", "propertyNames": {"enum": )" + json_words(settable()) + "}}";
    if (!key.path.starts_with("axes."))
        return R"({"type": "array", "minItems": 1, "items": )" + lines(sweep_map(key.path), "    ") + "}";
    if (key.size == 1) return R"({"type": "array", "minItems": 1})";
    Words items(2, or_degrees(R"({"type": "number"})"));
    if (key.size == 3) items.push_back(R"({"type": "integer", "minimum": 1})");
    return object({member("type", json_string("array")), member("items", array(items)),
                   member("minItems", std::to_string(key.size)), member("maxItems", std::to_string(key.size))});
}

// ---- the document

class SchemaWriter {
public:
    std::string document() {
        Words members = {member("$schema", json_string("http://json-schema.org/draft-07/schema#")),
                         member("title", json_string("arm3r scenario")),
                         member("x-range", range_json(UsualRange{}, {.around_zero = 0, .factor = 0})),
                         member("type", json_string("object")),
                         member("required", json_words({"format"})),
                         member("additionalProperties", "false"),
                         member("properties", lines(properties("", nullptr, "", param_defaults()), "  ")),
                         member("allOf", "[\n    " + listed(rules_of_control(), ",\n    ") + "\n  ]")};
        Words definitions;
        for (const auto& [path, text] : definitions_) definitions.push_back(member(path, text));
        members.push_back(member("definitions", lines(definitions, "  ")));
        return lines(members, "") + "\n";
    }

private:
    // The members of `properties` of a section for a word of its primary choice, on which `params` agree.
    Words properties(const std::string& section, const Key* primary, std::string_view word, const Params& params) {
        Words found;
        for (const std::string& name : names_below(section)) {
            const std::string path = join(section, name);
            if (any_exists(path, primary, word))
                found.push_back(member(name, value_at(path, find_key(path), primary, params)));
        }
        return found;
    }

    // The members that are the same for all words of the primary choice.
    Words common_properties(const std::string& section, const Key& primary) {
        Words common = properties(section, &primary, primary.choices[0], params_with(primary, primary.choices[0]));
        for (const std::string& word : primary.choices) {
            const Words here = properties(section, &primary, word, params_with(primary, word));
            std::erase_if(common, [&](const std::string& member) { return !is_in(here, member); });
        }
        return common;
    }

    static bool any_exists(const std::string& path, const Key* primary, std::string_view word) {
        if (!is_section(path) && !find_key(path)) return true;  // the reader's own
        return std::any_of(schema().begin(), schema().end(), [&](const Key& key) {
            return (key.path == path || key.path.starts_with(path + ".")) && exists_for(key, primary, word);
        });
    }

    std::string value_at(const std::string& path, const Key* key, const Key* primary, const Params& params) {
        if (path == "format") return R"({"description": "Version of this format.", "const": 1})";
        if (path == "name") return R"({"description": "Default: the file's stem.", "type": ["string", "number"]})";
        if (path == "checks") return checks();
        if (!is_section(path)) return described_value(*key, primary, params);
        if (!definitions_.contains(path)) {
            definitions_[path] = "";  // its place, before those of the sections in it
            definitions_[path] = section(path, key);
        }
        return R"({"$ref": "#/definitions/)" + path + "\"}";
    }

    std::string section(const std::string& path, const Key* key) {
        Words members = {member("type", json_string("object"))};
        if (key) members.insert(members.begin(), member("description", json_string(key->doc)));
        const Key* primary = primary_choice(path);
        if (!primary) {
            members.push_back(member("additionalProperties", "false"));
            members.push_back(member("properties", lines(properties(path, nullptr, "", param_defaults()), "      ")));
            return lines(members, "    ");
        }
        const bool may_be_the_plants = std::isnan(primary->fallback.front());  // then no word decides on the keys
        if (may_be_the_plants)
            members.push_back(member("propertyNames", object({member("enum", json_words(names_below(path)))})));
        const Words common = common_properties(path, *primary);
        members.push_back(member("properties", lines(common, "      ")));
        Words variants;
        for (const std::string& word : primary->choices)
            variants.push_back(rule(chosen(*primary, {word}), variant(path, *primary, word, common)));
        members.push_back(member("allOf", "[\n        " + listed(variants, ",\n        ") + "\n      ]"));
        return lines(members, "    ");
    }

    // A section for one word of its primary choice.
    std::string variant(const std::string& path, const Key& primary, const std::string& word, const Words& common) {
        const Params params = params_with(primary, word);
        Words mine = properties(path, &primary, word, params);
        for (std::string& text : mine)
            if (is_in(common, text)) text = text.substr(0, text.find(':')) + ": true";
        Words required,
            members = {member("additionalProperties", "false"), member("properties", lines(mine, "          "))};
        std::map<const Key*, std::map<Words, Words>> refused;  // by a second choice and its words: names
        for (const Key& key : schema()) {
            const bool is_here = key.path == join(path, last_name(key.path)) && exists_for(key, &primary, word);
            if (!is_here || !key.decided_by) continue;
            if (key.decided_by != &primary && key.decided_by->path == join(path, last_name(key.decided_by->path)))
                refused[key.decided_by][words_without(key)].push_back(last_name(key.path));
            else if (key.decided_by == &primary && key.required && std::isnan(default_of(key, params).front()))
                required.push_back(last_name(key.path));
        }
        if (!required.empty()) members.push_back(member("required", json_words(required)));
        Words rules;
        for (const auto& [choice, names_of] : refused)
            for (const auto& [words, names] : names_of) rules.push_back(rule(chosen(*choice, words), without(names)));
        if (!rules.empty()) members.push_back(member("allOf", array(rules)));
        return object(members);
    }

    // Sections, and sections in them, that only some control laws have.
    static Words rules_of_control() {
        const Key& type = known_key("controller.type");
        std::map<std::string, Words> words_by_refusal;
        for (const std::string& word : type.choices) {
            Words refused;
            for (const std::string& top : names_below("")) {
                if (!any_exists(top, &type, word)) refused.push_back(member(top, "false"));
                else if (top != "controller" && is_section(top)) append_refused_within(refused, top, type, word);
            }
            if (!refused.empty()) words_by_refusal[object({member("properties", object(refused))})].push_back(word);
        }
        Words rules;
        for (const auto& [refusal, words] : words_by_refusal) {
            const bool may_be_missing = is_in(words, default_word(type));
            Words members = {member("properties", object({member("controller", chosen(type, words))}))};
            if (!may_be_missing) members.push_back(member("required", json_words({"controller"})));
            rules.push_back(rule(object(members), refusal));
        }
        return rules;
    }

    static void append_refused_within(Words& refused, const std::string& top, const Key& type,
                                      const std::string& word) {
        Words names;
        for (const std::string& name : names_below(top))
            if (!any_exists(join(top, name), &type, word)) names.push_back(name);
        if (!names.empty()) refused.push_back(member(top, without(names)));
    }

    // Each check has one subject, which says what other keys it has.
    std::string checks() {
        Words columns, variants;
        for (const Column& column : column_table) columns.emplace_back(column.name);
        definitions_["column of a run"] = object({member("enum", json_words(columns))});
        for (const CheckForm& form : check_forms()) {
            Words properties;
            for (const std::string& key : form.keys) properties.push_back(member(key, check_value(key)));
            variants.push_back(
                object({member("required", json_words({form.subject})), member("additionalProperties", "false"),
                        member("properties", object(properties))}));
        }
        return R"({"description": "Conditions on the run.", "type": "array", "items": )"
               R"({"type": "object", "oneOf": [)" +
               listed(variants, ",\n      ") + "]}}";
    }

    static std::string check_value(const std::string& key) {
        if (key == "column" || key == "minus") return R"({"$ref": "#/definitions/column of a run"})";
        if (key == "name") return R"({"type": ["string", "number"]})";
        if (key == "index") return R"({"type": "integer", "minimum": 0})";
        const Words words = words_of_check(key);
        return words.empty() ? R"({"type": "number"})" : object({member("enum", json_words(words))});
    }

    std::map<std::string, std::string> definitions_;
};

}  // namespace

std::string schema_json() { return SchemaWriter().document(); }

std::string sweep_schema_json() {
    Words members = sweep_map("");
    members.insert(members.begin(), {member("$schema", json_string("http://json-schema.org/draft-07/schema#")),
                                     member("title", json_string("arm3r sweep"))});
    return lines(members, "") + "\n";
}

}  // namespace arm3r
