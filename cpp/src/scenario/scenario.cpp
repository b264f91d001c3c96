#include "scenario/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/paths.hpp"
#include "platform/files.hpp"
#include "scenario/arm_file.hpp"
#include "scenario/key_reader.hpp"
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

class Resolver : KeyReader {
public:
    explicit Resolver(const Scenario& scenario)
        : KeyReader(scenario.file, scenario.document.problems),
          root_(with_table_files(with_arm_file(scenario.document.root, file_, problems_), file_, problems_)),
          origin_(schema().size()) {}

    Resolved resolve() {
        if (root_.type == Node::map) {
            check_format(root_, "scenario");
            read_name();
            read_choices();
            read_section(root_, "");
            add_broken_rules();
            if (const Node* checks = root_.find("checks"))
                result_.checks = read_checks(*checks, params_, columns(), file_, problems_);
        } else if (root_.type == Node::nothing) {
            problem(root_.mark, {"scenario.empty", "", "the scenario is empty", "", "",
                                 "`arm3r template` prints one to start from"});
        } else if (root_.type != Node::unset) {
            problem(root_.mark, {"scenario.type", "", "a scenario is a map of keys", node_text(root_), "",
                                 "start with `format: 1`"});
        }
        finish();
        add_warnings();
        build_tree();
        result_.params = std::move(params_);
        return std::move(result_);
    }

private:
    // ---- the reader's own keys

    void read_name() {
        const Node* node = root_.find("name");
        result_.name = as_name(file_);
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
        params_.assign(param_count(), 0.0);
        for (const Key& key : schema()) {
            const std::vector<double> fallback = default_of(key, params_);
            std::copy(fallback.begin(), fallback.end(), at(key));
            if (key.kind != Kind::choice && key.kind != Kind::section) continue;
            const Node* node = find(root_, parse_path(key.path));
            if (node && key.kind == Kind::choice && node->type != Node::unset)
                if (const auto index = word(key, *node)) *at(key) = *index, set_origin(key, *node);
            if (node && key.kind == Kind::section && (node->type == Node::map || node->type == Node::unset)) {
                *at(key) = 1;
                set_origin(key, *node);
            }
        }
    }

    // ---- the file, key by key

    void read_section(const Node& map, const std::string& section) {
        for (const Node& node : map.children) {
            const std::string path = join(section, node.key);
            const Key* key = find_key(path);
            if (key && key->kind != Kind::section) read_value(*key, node);
            else if (key && !key_exists(*key, params_)) refuse_other_choice(*key, node);
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
            found.hint = suggested_key(map, node, section, params_);
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
                return " in " + section + " where " + last_name(choice->path) + " is " + choice_of(params_, *choice);
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
        return is_unknown ? names_below(section) : names_there(section, params_);
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
        if (!key_exists(key, params_)) return refuse_other_choice(key, node);
        if (key.kind == Kind::choice || (key.kind == Kind::file && node.type == Node::scalar)) return;
        if (key.kind == Kind::arm_file) return refuse_without_urdf(key, node);
        if (store(key, node)) set_origin(key, node);
    }

    // What is said of a URDF was read before, where there is one.
    void refuse_without_urdf(const Key& key, const Node& node) {
        if (key.path == "arm.urdf") return wrong_shape(key, node);
        problem(node.key_mark, {"scenario.other_choice", key.path,
                                "`" + last_name(key.path) + "` belongs to a URDF, and there is no arm.urdf", "", "",
                                "take it out, or give arm.urdf"});
    }

    // ---- rules of the schema

    void add_broken_rules() {
        const Validation validation = validate(params_);
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

    std::string& origin(const Key& key) { return origin_[static_cast<std::size_t>(&key - schema().data())]; }

    void set_origin(const Key& key, const Node& node) {
        if (node.mark.edit) return void(origin(key) = visible(node.mark.edit->origin));
        origin(key) = visible(file_, 200) + ":" + std::to_string(node.start().line);
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
        return key_exists(key, params_) && !(std::isnan(*at(key)) && is_copy_of_nothing(key));
    }

    // A key of the controller's copy of the arm that, for the plant's own shapes, the plant does not have.
    bool is_copy_of_nothing(const Key& key) const {
        constexpr std::string_view model = "controller.model.";
        return key.path.starts_with(model) && !key_exists(*find_key("arm." + key.path.substr(model.size())), params_);
    }

    void build_tree() {
        Node& tree = result_.tree;
        tree.type = Node::map;
        tree.children.push_back(leaf("format", std::to_string(file_format), "file"));
        tree.children.push_back(leaf("name", result_.name, root_.find("name") ? "file" : "the file's name"));
        tree.children.back().quoted = true;
        for (const Key& key : schema())
            if (is_there(key)) insert(tree, key);
        if (const Node* checks = root_.find("checks"); checks && checks->type == Node::list)
            tree.children.push_back(*checks);
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
            key.form == Form::list ? list_at(params_, key) : std::span<const double>(&*at(key), key.size);
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

    const Node root_;
    std::vector<std::string> origin_;
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
