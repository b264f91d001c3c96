#include "scenario/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/paths.hpp"
#include "platform/files.hpp"
#include "scenario/arm_file.hpp"
#include "scenario/meant_key.hpp"
#include "scenario/meant_word.hpp"
#include "scenario/table_file.hpp"
#include "schema/columns.hpp"
#include "schema/schema.hpp"
#include "validate/size_limits.hpp"
#include "validate/validate.hpp"
#include "validate/warnings.hpp"

namespace arm3r {

namespace {

using Words = std::vector<std::string>;

constexpr int format = 1;
constexpr double unset = std::numeric_limits<double>::quiet_NaN();

std::string with_unit(std::string value, const Key& key) { return key.unit.empty() ? value : value + " " + key.unit; }

// How a key is written, for messages: "a number (m)", "a list of 3 numbers (N m)".
std::string expected(const Key& key, std::span<const double> params) {
    const std::string unit = key.unit.empty() ? "" : " (" + key.unit + ")";
    const std::string list = "a list of " + list_sizes(key) + " numbers" + unit;
    switch (key.kind) {
        case Kind::flag: return "true or false";
        case Kind::choice: return "one of " + listed(key.choices);
        case Kind::section: return "a map";
        case Kind::integer: return "a whole number" + unit;
        case Kind::file: return "the name of a file";
        case Kind::arm_file: return "what is said of a URDF";
        case Kind::column: return "a list of 1 to " + std::to_string(key.size) + " names of columns";
        default: break;
    }
    switch (key.form) {
        case Form::number_or_vector: return "a number" + unit + " or " + list;
        case Form::vector_or_word: return list + " or " + key.word;
        case Form::by_choice: return takes_list(key, params) ? list : "a number" + unit;
        default: return key.size == 1 ? "a number" + unit : list;
    }
}

// Text as a file name: forbidden characters become _.
std::string as_name(std::string_view file) {
    std::string_view stem = file.substr(platform::last_separator(file) + 1);
    if (const std::size_t dot = stem.rfind('.'); dot != stem.npos && dot > 0) stem = stem.substr(0, dot);
    std::string name;
    for (std::size_t at = 0; at < stem.size();) {
        const std::size_t begin = at;
        const std::int32_t c = next_code_point(stem, at);
        if (c < 0) ++at;
        name += c < 0 || is_control(c) || is_bidi_control(c) ? "_" : std::string(stem.substr(begin, at - begin));
    }
    const bool usable =
        !name.empty() && name.size() <= 200 && std::string_view(".-<").find(name[0]) == std::string_view::npos;
    return usable ? name : "scenario";
}

class Resolver {
public:
    explicit Resolver(const Scenario& scenario)
        : scenario_(scenario),
          problems_(scenario.document.problems),
          root_(with_table_files(with_arm_file(scenario.document.root, scenario.file, problems_), scenario.file,
                                 problems_)),
          origin_(schema().size()) {}

    Resolved resolve() {
        if (root_.type == Node::nothing)
            refuse(ARM3R_E_SCENARIO, {"scenario.empty", "", "the scenario is empty", "", "",
                                      "`arm3r template` prints one to start from"});
        if (root_.type == Node::map) {
            read_format();
            read_name();
            read_choices();
            read_section(root_, "");
            add_broken_rules();
            if (const Node* checks = root_.find("checks"))
                result_.checks = read_checks(*checks, result_.params, columns(), scenario_.file, problems_);
        } else if (root_.type != Node::unset) {
            problem(root_.mark, {"scenario.type", "", "a scenario is a map of keys", node_text(root_), "",
                                 "start with `format: 1`"});
        }
        finish();
        add_warnings();
        build_tree();
        return std::move(result_);
    }

private:
    void problem(const SourceLocation& at, Problem problem) {
        problems_.push_back(arm3r::located(std::move(problem), at, scenario_.file));
    }

    [[noreturn]] void refuse(arm3r_status status, Problem problem) const {
        throw Error(status, std::vector{arm3r::located(std::move(problem), root_.mark, scenario_.file)});
    }

    void finish() {
        if (problems_.empty()) return;
        const auto place = [](const Problem& p) { return std::tuple(p.line == 0, p.line, p.column); };
        std::stable_sort(problems_.begin(), problems_.end(),
                         [&](const Problem& a, const Problem& b) { return place(a) < place(b); });
        throw Error(ARM3R_E_SCENARIO, problems_);
    }

    // ---- the reader's own keys

    void read_format() {
        const Node* node = root_.find("format");
        if (!node)
            return problem(root_.mark, {"scenario.format", "format", "the version of the format is missing", "", "",
                                        "write `format: 1` as the first line"});
        NumberFault fault;
        const auto value = node->type == Node::scalar
                               ? read_number(node->text, {.whole = true, .quoted = node->quoted}, fault)
                               : std::nullopt;
        if (!value)
            problem(node->mark, {"scenario.format", "format", "expects a whole number", node_text(*node), "1", ""});
        else if (*value != format)
            throw Error(
                ARM3R_E_FORMAT,
                {arm3r::located(
                    {"scenario.format", "format",
                     "written for format " + shortest(*value) + ", this is " + std::to_string(format), "", "", ""},
                    node->mark, scenario_.file)});
    }

    void read_name() {
        const Node* node = root_.find("name");
        result_.name = as_name(scenario_.file);
        if (!node || node->type == Node::unset) return;
        const std::string& text = node->text;
        const bool usable = node->type == Node::scalar && !text.empty() && text.size() <= 200 &&
                            text.find('/') == text.npos && text[0] != '.' && text[0] != '-' &&
                            visible(text, 200) == text;
        if (usable) result_.name = text;
        else
            problem(node->mark, {"scenario.name", "name", "a name must serve as a file name", node_text(*node),
                                 "1 to 200 characters without / and control characters, not starting with . or -", ""});
    }

    // ---- choices first: they say which keys there are, and which defaults

    void read_choices() {
        result_.params.assign(param_count(), 0.0);
        for (const Key& key : schema()) {
            const std::vector<double> fallback = default_of(key, result_.params);
            std::copy(fallback.begin(), fallback.end(), at(key));
            if (key.kind != Kind::choice && key.kind != Kind::section) continue;
            const Node* node = find(root_, parse_path(key.path));
            if (node && key.kind == Kind::choice) read_word(key, *node);
            if (node && key.kind == Kind::section && (node->type == Node::map || node->type == Node::unset)) {
                *at(key) = 1;
                set_origin(key, *node);
            }
        }
    }

    void read_word(const Key& key, const Node& node) {
        if (node.type == Node::unset) return;
        const auto word = std::find(key.choices.begin(), key.choices.end(), node.text);
        if (node.type == Node::scalar && word != key.choices.end()) {
            *at(key) = static_cast<double>(word - key.choices.begin());
            return set_origin(key, node);
        }
        unknown_choices_.insert(key.path);
        problem(node.mark, {"scenario.unknown_word", key.path, "must be one of the words", node_text(node),
                            listed(key.choices), suggested_word(key, node.text)});
    }

    // ---- the file, key by key

    void read_section(const Node& map, const std::string& section) {
        for (const Node& node : map.children) {
            const std::string path = join(section, node.key);
            const Key* key = find_key(path);
            if (key && key->kind != Kind::section) read_value(*key, node);
            else if (key && !key_exists(*key, result_.params)) refuse_other_choice(*key, node);
            else if (node.key.find_first_of(".[") == std::string::npos && is_section(path)) read_subsection(node, path);
            else if (path != "format" && path != "name" && path != "checks") unknown_key(map, node, section);
        }
    }

    void read_subsection(const Node& node, const std::string& path) {
        if (node.type == Node::map) return read_section(node, path);
        if (node.type == Node::unset) return;
        std::string hint = node.type == Node::nothing ? "write `" + node.key + ": {}`, or leave it out" : "";
        if (const Key* choice = node.type == Node::scalar ? choice_with(path, node.text) : nullptr)
            hint =
                "write `" + node.key + ": {" + last_name(choice->path) + ": " + word_meant(*choice, node.text) + "}`";
        problem(node.type == Node::nothing ? node.key_mark : node.mark,
                {"scenario.type", path, "expects a map", node_text(node), "keys " + listed(names_here(path)), hint});
    }

    void unknown_key(const Node& map, const Node& node, const std::string& section) {
        Problem found{"scenario.unknown_key", join(section, node.key), "no such key"};
        if (const std::string* choice = unknown_choice_of(section)) {
            found.message += " in " + section;
            found.hint = "which keys there are depends on " + *choice + ", and its word is not known";
        } else {
            found.message += where_text(section);
            const Words here = names_here(section);
            found.allowed = listed(here);
            found.hint = suggested_key(map, node, section, result_.params);
            const bool lacks_choice = here.size() == 1 && !map.find(here[0]);
            if (lacks_choice && !found.hint.starts_with("did you mean"))
                found.hint = "choose a " + here[0] + " first: the other keys depend on it";
        }
        problem(node.key_mark, found);
    }

    // " in controller where type is joint_pd"
    std::string where_text(const std::string& section) const {
        if (section.empty()) return "";
        const std::string prefix = join(section, "");
        for (const Key& key : schema()) {
            const Key* choice = key.decided_by;
            if (!choice || !key.path.starts_with(prefix) || unknown_choices_.contains(choice->path)) continue;
            if (choice->path == prefix + last_name(choice->path))
                return " in " + section + " where " + last_name(choice->path) + " is " +
                       choice_of(result_.params, *choice);
        }
        return " in " + section;
    }

    // The word on which the keys of a section depend, where it is not known.
    const std::string* unknown_choice_of(const std::string& section) const {
        if (section.empty() || unknown_choices_.empty()) return nullptr;
        for (const Key& key : schema())
            for (const Key* choice = key.decided_by; choice; choice = choice->decided_by)
                if (key.path.starts_with(section + ".") && unknown_choices_.contains(choice->path))
                    return &choice->path;
        return nullptr;
    }

    Words names_here(const std::string& section) const {
        const bool is_unknown = section.empty() ? !unknown_choices_.empty() : unknown_choice_of(section) != nullptr;
        return is_unknown ? names_below(section) : names_there(section, result_.params);
    }

    // The choice of this section whose word was written alone: `controller: joint_pd`.
    static const Key* choice_with(const std::string& section, const std::string& word) {
        const auto found = std::find_if(schema().begin(), schema().end(), [&](const Key& key) {
            return key.path == join(section, last_name(key.path)) && key.kind == Kind::choice &&
                   !word_meant(key, word).empty();
        });
        return found == schema().end() ? nullptr : &*found;
    }

    void read_value(const Key& key, const Node& node) {
        if (node.type == Node::unset || unknown_choices_.contains(key.path)) return;
        if (!key_exists(key, result_.params)) return refuse_other_choice(key, node);
        if (key.kind == Kind::choice) return;
        if (key.kind == Kind::flag) return read_flag(key, node);
        if (key.kind == Kind::file) return node.type == Node::scalar ? void() : wrong_shape(key, node);
        if (key.kind == Kind::arm_file) return refuse_without_urdf(key, node);
        if (is_number_here(key, node)) return read_single(key, node);
        if (key.form == Form::vector_or_word && node.type == Node::scalar && node.text == key.word) {
            std::fill_n(at(key), key.size, infinite);
            return set_origin(key, node);
        }
        const std::size_t min_size = key.form == Form::list ? key.min_size : key.size;
        if (is_list_here(key) && node.type == Node::list && node.children.size() >= min_size &&
            node.children.size() <= (key.any_length ? max_list_length : key.size))
            return read_list(key, node);
        wrong_shape(key, node);
    }

    // What is said of a URDF was read before, where there is one.
    void refuse_without_urdf(const Key& key, const Node& node) {
        if (key.path == "arm.urdf") return wrong_shape(key, node);
        problem(node.key_mark, {"scenario.other_choice", key.path,
                                "`" + last_name(key.path) + "` belongs to a URDF, and there is no arm.urdf", "", "",
                                "take it out, or give arm.urdf"});
    }

    // A key of another choice: "`section` belongs to shape brick; here the shape is cylinder".
    void refuse_other_choice(const Key& key, const Node& node) {
        const Key& refused = key_refused(key, result_.params);
        if (unknown_choices_.contains(refused.when_key)) return;
        const std::string choice = last_name(refused.when_key), name = "`" + last_name(key.path) + "`";
        const std::string& here = choice_of(result_.params, refused.when_key);
        const std::string words = listed(refused.when, " or ");
        if (refused.when_key == "controller.type" && here == "none" && key.path.starts_with("reference."))
            return problem(node.key_mark, {"scenario.other_choice", key.path,
                                           "`" + key.path.substr(0, key.path.find('.')) +
                                               "` is followed by a control law, and controller.type is none",
                                           "", "", "add controller: {type: ...}, one of " + words});
        const bool is_of_most = words_without(refused).size() < refused.when.size();
        const std::string instead = meant_instead(key, result_.params);
        problem(node.key_mark,
                {"scenario.other_choice", key.path,
                 is_of_most ? name + " does not go with " + choice + " " + here
                            : name + " belongs to " + choice + " " + words + "; here the " + choice + " is " + here,
                 "", "",
                 !instead.empty() ? instead
                 : is_of_most     ? "take it out, or choose another " + refused.when_key
                                  : "take it out, or set " + refused.when_key + " to " + words});
    }

    void wrong_shape(const Key& key, const Node& node) {
        std::string hint;
        if (node.type == Node::nothing) hint = "leave the key out for its default";
        if (key.form == Form::by_choice)
            hint = last_name(key.when_key) + " is " + choice_of(result_.params, key.when_key);
        if (key.form == Form::vector_or_word && node.type == Node::scalar)
            hint = is_infinity(node) ? "write " + key.word : did_you_mean(node.text, {key.word});
        if (is_list_here(key) && node.type == Node::list && node.children.size() > key.size)
            hint = "a comma parts the items; in a number use a point";
        problem(node.mark,
                {"scenario.type", key.path, "expects " + expected(key, result_.params), node_text(node), "", hint});
    }

    bool is_number_here(const Key& key, const Node& node) const {
        if (node.type != Node::scalar) return false;
        if (key.form == Form::by_choice) return !takes_list(key, result_.params);
        return key.form == Form::number_or_vector || (key.size == 1 && key.form != Form::list);
    }

    bool is_list_here(const Key& key) const {
        if (key.form == Form::by_choice) return takes_list(key, result_.params);
        return key.size > 1 || key.form == Form::list;
    }

    static bool is_infinity(const Node& node) {
        return node.text.ends_with("inf") || node.text.ends_with("Inf") || node.text.ends_with("INF");
    }

    void read_flag(const Key& key, const Node& node) {
        const bool is_true = node.text == "true";
        if (node.type != Node::scalar || node.quoted || (!is_true && node.text != "false"))
            return problem(node.mark, {"scenario.type", key.path, "expects true or false", node_text(node), "",
                                       flag_hint(node.text)});
        *at(key) = is_true;
        set_origin(key, node);
    }

    static std::string flag_hint(std::string text) {
        std::transform(text.begin(), text.end(), text.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
        const Words yes = {"yes", "y", "on", "1", "true"}, no = {"no", "n", "off", "0", "false"};
        if (std::find(yes.begin(), yes.end(), text) != yes.end()) return "write true";
        return std::find(no.begin(), no.end(), text) != no.end() ? "write false" : "";
    }

    void read_single(const Key& key, const Node& node) {
        if (!read_number_into(key, node, key.path, *at(key))) return;
        std::fill_n(at(key) + 1, key.size - 1, unset);
        set_origin(key, node);
    }

    void read_list(const Key& key, const Node& node) {
        if (key.form == Form::list) std::fill_n(at(key), key.size, unset);
        if (node.children.size() > key.size) return read_long_list(key, node);
        for (std::size_t i = 0; i < node.children.size(); ++i)
            if (key.kind == Kind::column) read_column(key, node, i);
            else if (node.children[i].type != Node::unset)
                read_number_into(key, node.children[i], item(key.path, i), at(key)[static_cast<long>(i)]);
        set_origin(key, node);
    }

    void read_long_list(const Key& key, const Node& node) {
        const std::span<double> numbers = append_list(result_.params, key, node.children.size());
        for (std::size_t i = 0; i < numbers.size(); ++i)
            read_number_into(key, node.children[i], item(key.path, i), numbers[i]);
        set_origin(key, node);
    }

    void read_column(const Key& key, const Node& list, std::size_t i) {
        const Node& node = list.children[i];
        const std::string path = item(key.path, i);
        const auto word = std::find(key.choices.begin(), key.choices.end(), node.text);
        if (node.type != Node::scalar || word == key.choices.end())
            return problem(node.mark, {"scenario.unknown_word", path, "there is no such column", node_text(node),
                                       "names that `arm3r columns` lists", meant_column(key, node.text)});
        const auto is_same = [&](const Node& other) { return other.type == Node::scalar && other.text == node.text; };
        if (std::find_if(list.children.begin(), list.children.begin() + static_cast<std::ptrdiff_t>(i), is_same) !=
            list.children.begin() + static_cast<std::ptrdiff_t>(i))
            return problem(node.mark, {"scenario.column", path, "this column stands in the list twice", node.text, "",
                                       "take one of the two out"});
        at(key)[static_cast<long>(i)] = static_cast<double>(word - key.choices.begin());
    }

    // "q" is most likely meant as q1, q2, q3.
    static std::string meant_column(const Key& key, const std::string& text) {
        const auto has = [&](const std::string& name) {
            return std::find(key.choices.begin(), key.choices.end(), name) != key.choices.end();
        };
        for (const char* ends : {"123", "xyz"})
            for (const char* joint : {"", "_"}) {
                Words three;
                for (const char* end = ends; *end; ++end) three.push_back(text + joint + *end);
                if (std::all_of(three.begin(), three.end(), has)) return "write " + listed(three);
            }
        return did_you_mean(text, key.choices);
    }

    bool read_number_into(const Key& key, const Node& node, const std::string& path, double& value) {
        NumberFault fault{"scenario.type", "expects " + with_unit("a number", key), ""};
        if (node.type == Node::scalar) {
            const NumberRules rules{.degrees = key.kind == Kind::angle,
                                    .infinity = key.allow_infinity,
                                    .whole = key.kind == Kind::integer,
                                    .quoted = node.quoted,
                                    .unit = key.unit};
            if (const auto number = read_number(node.text, rules, fault)) return value = *number, true;
        }
        if (key.form == Form::vector_or_word && is_infinity(node)) fault.hint = "write " + key.word + ", not a list";
        problem(node.mark, {fault.code, path, fault.message, node_text(node), "", fault.hint});
        return false;
    }

    // ---- rules of the schema

    void add_broken_rules() {
        const Validation validation = validate(result_.params);
        keeps_rules_ = validation.setup.has_value();
        if (keeps_rules_) result_.setup = *validation.setup;
        for (const Problem& rule : validation.problems)
            if (!already_refused(rule.path)) problem(place(rule.path), rule);
        if (keeps_rules_ && unknown_choices_.empty()) add_missing_columns();
    }

    void add_missing_columns() {
        for (Problem& missing : missing_columns(result_.setup)) {
            const Node& list = *find(root_, parse_path(missing.path));
            const auto is_it = [&](const Node& node) { return node.text == missing.got; };
            const auto found = std::find_if(list.children.begin(), list.children.end(), is_it);
            missing.path = item(missing.path, static_cast<std::size_t>(found - list.children.begin()));
            problem(found->mark, missing);
        }
    }

    void add_warnings() {
        const bool by_default = !find(root_, parse_path("controller.gravity"));
        if (const auto warning = compensation_warning(result_.setup, by_default)) result_.warnings.push_back(*warning);
    }

    // The columns that checks can name; all columns if they cannot be known because something else is wrong.
    std::vector<std::size_t> columns() const {
        const bool is_known = keeps_rules_ && unknown_choices_.empty();
        return in_order(is_known ? possible_columns(result_.setup) : ColumnSet().set());
    }

    // Whether `path` is that of a section or list, or stands in it.
    static bool is_within(std::string_view path, std::string_view section) {
        return !section.empty() && path.starts_with(section) &&
               (path.size() == section.size() || path[section.size()] == '.' || path[section.size()] == '[');
    }

    bool already_refused(std::string_view path) const {
        return std::any_of(problems_.begin(), problems_.end(), [&](const Problem& problem) {
            const Key* key = find_key(problem.path);
            const bool is_file = key && key->kind == Kind::file;  // its lists stand in the same section
            const std::string known = is_file ? problem.path.substr(0, problem.path.rfind('.')) : problem.path;
            const bool is_item = is_within(known, path) && known.size() > path.size() && known[path.size()] == '[';
            return is_within(path, known) || is_item;
        });
    }

    SourceLocation place(const std::string& path) const {
        return path.empty() ? root_.mark : locate(root_, parse_path(path));
    }

    // ---- origins, and the tree of everything

    std::vector<double>::iterator at(const Key& key) {
        return result_.params.begin() + static_cast<std::ptrdiff_t>(key.offset);
    }

    std::string& origin(const Key& key) { return origin_[static_cast<std::size_t>(&key - schema().data())]; }

    void set_origin(const Key& key, const Node& node) {
        if (node.mark.edit) return void(origin(key) = visible(node.mark.edit->origin));
        origin(key) = visible(scenario_.file, 200) + ":" + std::to_string(node.start().line);
        const auto edited = std::find_if(node.children.begin(), node.children.end(),
                                         [](const Node& child) { return child.mark.edit != nullptr; });
        if (edited != node.children.end() && key.kind != Kind::section)
            origin(key) += ", " + visible(edited->mark.edit->origin);
    }

    // Whether the key has a place in the resolved scenario.
    bool is_there(const Key& key) {
        for (const Key& section : schema())
            if (section.kind == Kind::section && key.path.starts_with(section.path + ".") && *at(section) == 0)
                return false;
        if (key.kind == Kind::section) return *at(key) != 0;
        if (key.kind == Kind::file || key.kind == Kind::arm_file) return false;  // what it has is there
        return key_exists(key, result_.params) && !(std::isnan(*at(key)) && is_copy_of_nothing(key));
    }

    // A key of the controller's copy of the arm that, for the plant's own shapes, the plant does not have.
    bool is_copy_of_nothing(const Key& key) const {
        constexpr std::string_view model = "controller.model.";
        return key.path.starts_with(model) &&
               !key_exists(*find_key("arm." + key.path.substr(model.size())), result_.params);
    }

    void build_tree() {
        Node& tree = result_.tree;
        tree.type = Node::map;
        tree.children.push_back(leaf("format", std::to_string(format), "file"));
        tree.children.push_back(leaf("name", result_.name, root_.find("name") ? "file" : "the file's name"));
        tree.children.back().quoted = true;
        for (const Key& key : schema())
            if (is_there(key)) insert(tree, key);
        if (const Node* checks = root_.find("checks"); checks && checks->type == Node::list)
            tree.children.push_back(*checks);
    }

    static Node leaf(std::string key, std::string text, std::string note) {
        Node node;
        node.type = Node::scalar;
        node.key = std::move(key);
        node.text = std::move(text);
        node.note = std::move(note);
        return node;
    }

    void insert(Node& tree, const Key& key) {
        const std::vector<Step> steps = parse_path(key.path);
        Node* section = &tree;
        for (std::size_t i = 0; i + (key.kind != Kind::section) < steps.size(); ++i) {
            if (!section->find(steps[i].key)) {
                section->children.push_back(leaf(steps[i].key, "", ""));
                section->children.back().type = Node::map;
            }
            section = section->find(steps[i].key);
        }
        if (key.kind != Kind::section) section->children.push_back(value_of(key));
    }

    Node value_of(const Key& key) {
        const auto number = [&](double value) { return leaf("", text_of(key, value), ""); };
        const std::span<const double> numbers =
            key.form == Form::list ? list_at(result_.params, key) : std::span<const double>(&*at(key), key.size);
        Node node = number(*at(key));
        node.key = last_name(key.path);
        node.note = origin(key).empty() ? source_name(static_cast<int>(key.source)) : origin(key);
        if (numbers.empty() || std::isnan(numbers[0])) {
            node.type = Node::nothing;
            node.note = key.unset;
        } else if (key.form == Form::vector_or_word && std::isinf(*at(key))) {
            node.text = key.word;
        } else if (key.form == Form::list || (key.size > 1 && !std::isnan(numbers[1]))) {
            node.type = Node::list;
            for (std::size_t i = 0; i < numbers.size() && !std::isnan(numbers[i]); ++i)
                node.children.push_back(number(numbers[i]));
        }
        return node;
    }

    static std::string text_of(const Key& key, double value) {
        if (std::isnan(value)) return {};
        if (key.kind == Kind::choice || key.kind == Kind::column) return key.choices[static_cast<std::size_t>(value)];
        if (key.kind == Kind::flag) return value != 0 ? "true" : "false";
        return key.kind == Kind::integer ? std::to_string(static_cast<long long>(value)) : shortest(value);
    }

    const Scenario& scenario_;
    std::vector<Problem> problems_;
    const Node root_;
    std::vector<std::string> origin_;
    std::set<std::string> unknown_choices_;
    bool keeps_rules_ = false;
    Resolved result_;
};

}  // namespace

Scenario read_scenario(std::string text, std::string file) {
    const std::string checked = checked_text(std::move(text), file);
    return {parse_yaml(checked, file), std::move(file)};
}

Resolved resolve(const Scenario& scenario) { return Resolver(scenario).resolve(); }

std::vector<Problem> located(std::vector<Problem> problems, const Scenario& scenario) {
    for (Problem& problem : problems)
        if (!problem.path.empty())
            problem = located(problem, locate(scenario.document.root, parse_path(problem.path)), scenario.file);
    return problems;
}

std::string source_name(int source) {
    switch (static_cast<Source>(source)) {
        case Source::lecture: return "lecture";
        case Source::inferred: return "inferred";
        default: return "our choice";
    }
}

}  // namespace arm3r
