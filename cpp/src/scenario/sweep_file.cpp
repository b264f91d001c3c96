#include <algorithm>
#include <cmath>
#include <set>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/input_file.hpp"
#include "files/paths.hpp"
#include "scenario/key_reader.hpp"
#include "scenario/sweep.hpp"
#include "schema/key_builders.hpp"
#include "validate/validate.hpp"

namespace arm3r {
namespace {

const Key& sweep_key(std::string_view path) { return *std::ranges::find(sweep_keys(), path, &Key::path); }

// Whether a rule can take these as its first two numbers.
bool is_good(std::string_view rule, double a, double b) {
    if (rule == "normal") return b > 0 && std::isfinite(std::abs(a) + 10 * b);
    const bool is_geometric = rule == "geomspace" || rule == "log_uniform";
    if (is_geometric && !(a > 0 && b / a > 0 && std::isfinite(b / a))) return false;
    return std::isfinite(b - a) && (a < b || rule.ends_with("space"));
}

std::string place(const SourceLocation& at) { return std::to_string(at.line) + ":" + std::to_string(at.column); }

// YAML in flow style.
std::string flow(const Node& node) {
    const bool is_plain = !node.quoted && node.text.find_first_of(",[]{}:#\"'") == std::string::npos;
    if (node.type == Node::scalar) return is_plain ? node.text : json_string(node.text);
    Words parts;
    for (const Node& child : node.children)
        parts.push_back((node.type == Node::map ? json_string(child.key) + ": " : "") + flow(child));
    return node.type == Node::map    ? "{" + listed(parts) + "}"
           : node.type == Node::list ? "[" + listed(parts) + "]"
                                     : "null";
}

// Of the keys whose one value is a list or a map, each value becomes a word.
void write_values_of_joints(const std::string& key, Node& list) {
    if (key != "arm.joints" && key != "arm.lock") return;
    const Node::Type type = key == "arm.joints" ? Node::list : Node::map;
    for (Node& value : list.children)
        if (value.type == type) {
            value.text = flow(value);
            value.type = Node::scalar;
            value.children.clear();
        }
}

// Checks the tree, and turns it into one of words and numbers.
class SweepReader : KeyReader {
public:
    SweepReader(Document document, const std::string& file, Scenario& scenario)
        : KeyReader(file, std::move(document.problems)), root_(std::move(document.root)), scenario_(scenario) {
        params_.resize(sweep_keys().back().offset + 1);
    }

    std::string read() {
        if (root_.type == Node::map) {
            read_map(root_, "", "");
            check_lengths();
        } else if (root_.type != Node::unset) {
            problem(root_.mark,
                    {"sweep.type", "", "a sweep is a map of keys", node_text(root_), "", "start with `format: 1`"});
        }
        for (Problem& found : problems_)
            if (found.file == file_ && found.code.starts_with("scenario.")) found.code.replace(0, 8, "sweep");
        finish();
        return to_json(root_);
    }

private:
    // ---- keys of the table

    // The keys in a map; they stand in the table below `section`.
    void read_map(Node& map, const std::string& section, const std::string& path) {
        Words names;
        for (const Key& known : sweep_keys()) {
            const std::string name = last_name(known.path);
            if (known.path != join(section, name)) continue;
            Key key = known;
            key.path = join(path, names.emplace_back(name));
            params_[key.offset] = key.fallback[0];
            Node* node = map.find(name);
            if (name == "format") check_format(map, "sweep");
            else if (!node) add_default(key, map);
            else if (node->type != Node::unset) read_key(key, *node);
        }
        for (const Node& node : map.children)
            if (!is_in(names, node.key))
                problem(node.key_mark, {"sweep.unknown_key", join(path, node.key), "no such key", "", listed(names),
                                        did_you_mean(node.key, names)});
    }

    void add_default(const Key& key, Node& map) {
        const double value = key.fallback[0];
        if (!std::isnan(value))
            map.children.push_back(leaf(key.path, key.kind == Kind::choice ? key.choices[0] : shortest(value)));
        if (!key.required || !key_exists(key, params_)) return;
        const Node* choice = key.decided_by ? map.find(key.when_key) : nullptr;
        problem((choice ? *choice : map).start(), {"sweep.missing_key", key.path, "this must be given", "",
                                                   expected(key), choice ? key.when_key + " is " + choice->text : ""});
    }

    void read_key(const Key& key, Node& node) {
        if (!key_exists(key, params_)) refuse_other_choice(key, node);
        else if (key.path == "scenario") read_base(key, node);
        else if (key.path == "set") put(key, node);
        else if (key.path.starts_with("axes[") && key.kind == Kind::special) read_rule(key, node);
        else if (key.kind == Kind::special) read_maps(key, node);
        else if (key.kind == Kind::column) store(key, node);
        else if (const auto value = key.kind == Kind::choice ? word(key, node) : whole(key, node))
            params_[key.offset] = *value;
    }

    // With an exponent a number is whole too: 1.0e+4.
    std::optional<double> whole(const Key& key, const Node& node) {
        const std::optional<double> value = number(of_kind(Kind::number, key), node, key.path);
        ProblemList broken(ProblemList::messages);
        if (value) check_number(key, *value, 0, 1, broken);
        for (const Problem& rule : broken.problems) problem(node.mark, rule);
        return broken.empty() ? value : std::nullopt;
    }

    void read_maps(const Key& key, Node& list) {
        if (list.type != Node::list || list.children.empty()) return wrong_shape(key, list);
        std::set<std::string> all;
        for (std::size_t i = 0; i < list.children.size(); ++i) {
            Node& node = list.children[i];
            const std::string path = item(key.path, i), text = to_json(node);
            if (node.type != Node::map && node.type != Node::unset)
                problem(node.mark, {"sweep.type", path, "expects a map", node_text(node), "",
                                    "`" + key.path + "` is " + key.word});
            else if (!all.insert(text).second)
                problem(node.mark, {"sweep.duplicate", path, "stands here twice", text, "", "take one of the two out"});
            if (node.type != Node::map) continue;
            read_map(node, key.path, path);
            if (key.path == "axes") check_rule(node, path);
            node.children.push_back(leaf("at", place(node.mark)));
        }
    }

    // ---- the scenario

    void read_base(const Key& key, Node& node) {
        scenario_ = {{node, {}}, node.type == Node::scalar ? path_beside(file_, node.text) : file_};
        if (node.type == Node::map && !node.find("format"))
            scenario_.document.root.children.push_back(leaf("format", "1"));
        if (node.type == Node::nothing || node.type == Node::list) wrong_shape(key, node);
        try {
            if (node.type == Node::scalar)
                scenario_ = read_scenario(read_input(scenario_.file, most_yaml_bytes + 1), scenario_.file);
        } catch (const Error& error) {
            if (error.status() != ARM3R_E_FILE) append(error);
            else
                problem(node.mark, {"sweep.file", key.path, "cannot be read: " + error.problems()[0].message,
                                    node_text(node), "", "a relative name counts from the folder of the sweep"});
        }
        node = leaf(key.path, scenario_.file);
        node.quoted = true;
    }

    void put(const Key& key, const Node& values) {
        if (values.type != Node::map) return wrong_shape(key, values);
        for (const Node& value : values.children) {
            try {
                set(scenario_, value.key, flow(value), file_ + ":" + place(value.key_mark) + ": set");
            } catch (const Error& error) {
                append(error);
            }
        }
    }

    void append(const Error& error) {
        problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
    }

    // ---- axes

    void check_rule(const Node& axis, const std::string& path) {
        Words all, given;
        for (const Key& key : sweep_keys())
            if (key.path.starts_with("axes.") && !key.required) all.push_back(last_name(key.path));
        std::ranges::copy_if(all, std::back_inserter(given), [&](const auto& name) { return axis.find(name); });
        if (given.size() != 1)
            problem(axis.mark, {"sweep.axis", path, "one rule is needed", given.empty() ? "none" : listed(given),
                                "one of " + listed(all), "`axes` is " + sweep_key("axes").word});
    }

    // The values of the key that varies, where it is known. Whether they are in range is judged run by run.
    void read_rule(const Key& rule, Node& list) {
        const Key& axis = sweep_key("axes.key");
        if (std::isnan(params_[axis.offset])) return;
        if (list.type != Node::list || list.children.empty() || (rule.size > 1 && list.children.size() != rule.size))
            return wrong_shape(rule, list);
        const std::string& name = choice_of(params_, axis);
        Key varied = *find_key(name.substr(0, name.find('[')));
        if (varied.kind == Kind::integer) varied.kind = Kind::number;
        write_values_of_joints(name, list);
        varied.allow_infinity = true;
        varied.path = rule.path;
        lengths_.emplace_back(name, rule.size == 1 ? read_values(varied, list) : read_numbers(rule, varied, list));
    }

    double read_values(const Key& varied, Node& list) {
        const Node& first = list.children[0];
        const std::size_t before = problems_.size();
        Key one = varied;
        for (std::size_t i = 0; i < list.children.size(); ++i) {
            one.path = item(varied.path, i);
            Node& node = list.children[i];
            if (node.type == Node::list && !node.children.empty()) read_values(one, node);
            else read_item(one, node);
            const bool alike = node.children.size() == first.children.size() && node.quoted == first.quoted;
            if (!alike && problems_.size() == before)
                problem(node.mark, {"sweep.shape", one.path, "all values of an axis are alike", node_text(node),
                                    "numbers, words, or lists of one length"});
        }
        return double(list.children.size());
    }

    // Words are kept in quotes, and numbers in SI.
    void read_item(const Key& varied, Node& node) {
        if (node.type == Node::unset) return;
        const bool is_name = varied.kind == Kind::file || varied.kind == Kind::arm_file;
        if (is_name && node.type != Node::scalar) wrong_shape(varied, node);
        else if (is_name || (varied.form == Form::vector_or_word && node.text == varied.word)) node.quoted = true;
        else if (varied.kind == Kind::choice) node.quoted = word(varied, node) || true;
        else if (varied.kind == Kind::flag) flag(varied, node);
        else if (const auto value = number(varied, node, varied.path)) node.text = shortest(*value);
    }

    // How many numbers a rule gives; 1 where it draws them.
    double read_numbers(const Key& rule, const Key& varied, Node& list) {
        std::vector<Node>& given = list.children;
        Key runs = sweep_key("runs");
        runs.path = item(rule.path, 2);
        const auto a = number(varied, given[0], item(rule.path, 0)), b = number(varied, given[1], item(rule.path, 1)),
                   count = rule.size > 2 ? whole(runs, given[2]) : 1.0;
        if (!a || !b || !count) return 1;
        if (!is_good(last_name(rule.path), *a, *b))
            problem(list.mark, {"sweep.range", rule.path, "out of range", to_json(list), rule.word});
        given[0].text = shortest(*a);
        given[1].text = shortest(*b);
        return *count;
    }

    void check_lengths() {
        const std::string& mode = choice_of(params_, sweep_key("mode"));
        const double most = sweep_key("runs").bounds.high;
        double product = 1;
        bool alike = true;
        Words lengths;
        for (const auto& [key, length] : lengths_) {
            product *= length;
            alike = alike && length == lengths_[0].second;
            lengths.push_back(key + " " + std::to_string(static_cast<long long>(length)));
        }
        if (mode == "list" && !alike)
            problem(root_.find("axes")->start(),
                    {"sweep.length", "axes", "in mode list all have one length", listed(lengths)});
        if (mode == "grid" && product > most)
            problem(root_.find("axes")->start(),
                    {"sweep.size", "axes", "too many combinations", listed(lengths, " x "),
                     "at most " + yaml_number(most), "use mode random or latin_hypercube"});
    }

    Node root_;
    Scenario& scenario_;
    std::vector<std::pair<std::string, double>> lengths_;  // of the axes
};

}  // namespace

std::string read_sweep(std::string text, const std::string& file, Scenario& scenario) {
    const std::string checked = checked_text(std::move(text), file);
    return SweepReader(parse_yaml(checked, file), file, scenario).read();
}

}  // namespace arm3r
