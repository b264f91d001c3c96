// Edits by path: what `--set` and arm3r_scenario_set do.

#include <algorithm>

#include "base/text.hpp"
#include "files/paths.hpp"
#include "scenario/scenario.hpp"
#include "scenario/table_file.hpp"
#include "schema/schema.hpp"

namespace arm3r {

namespace {

[[noreturn]] void refuse(std::string_view path, std::string code, std::string message, std::string hint) {
    throw Error(
        ARM3R_E_SCENARIO,
        {{.code = std::move(code), .path = std::string(path), .message = std::move(message), .hint = std::move(hint)}});
}

// ---- the value, and where it stands

void mark_as_edit(const std::shared_ptr<const Edit>& edit, Node& node) {
    node.mark = {0, node.mark.column, edit};
    node.key_mark = {0, node.key_mark.column, edit};
    for (Node& child : node.children) mark_as_edit(edit, child);
}

std::vector<Problem> with_edit_location(const Edit& edit, std::string_view path, std::vector<Problem> problems) {
    for (Problem& problem : problems) {
        const bool inside_value = !problem.file.empty();
        if (inside_value) problem.path = below(path, problem.path);
        problem.file = edit.location;
        problem.line = 0;
        if (problem.column == 1) problem.column = 0;
    }
    return problems;
}

Document read_value(const std::string& value, const std::shared_ptr<const Edit>& edit) {
    Document document = parse_yaml(checked_text(value, edit->location), edit->location);
    mark_as_edit(edit, document.root);
    return document;
}

// `null` and nothing else: an empty value is more likely an empty variable.
bool is_removal(const Document& document, const std::string& value, std::string_view path) {
    if (document.root.type != Node::nothing) return false;
    if (value == "null") return true;
    refuse(path, "path.value", "there is no value", "write one, or `null` to take out what stands there");
}

// ---- finding a path

// A list of which only single items are set: the others keep their defaults.
std::vector<Node> open_items(const std::string& path, std::size_t index) {
    const Key* key = find_key(path);
    if (key && key->form == Form::list)
        refuse(item(path, index), "path.list", "no list stands at `" + path + "`",
               "give the whole list: " + path + " = [...]");
    if (key && (key->form == Form::number_or_vector || key->form == Form::by_choice))
        refuse(item(path, index), "path.list", "`" + path + "` can be a single number, and no list stands there",
               "give the whole list: " + path + " = [x, y, z]");
    Node unset;
    unset.type = Node::unset;
    return std::vector<Node>(key ? key->size : 0, unset);
}

Node& child(Node& node, const std::string& path, const std::string& name, const SourceLocation& place) {
    if (node.type == Node::nothing || node.type == Node::unset) node.type = Node::map;
    if (node.type != Node::map)
        refuse(join(path, name), "path.section", "`" + path + "` is " + node_text(node) + ", not a section", "");
    if (Node* found = node.find(name)) return *found;
    Node fresh;
    fresh.type = Node::unset;
    fresh.key = name;
    fresh.key_mark = fresh.mark = place;
    node.children.push_back(fresh);
    return node.children.back();
}

// Whether a scenario may have something at this path: numbers, or a part such as `checks`.
bool is_there(const std::string& path) {
    const std::vector<std::string> parts = names_below("");
    return is_known(path) || std::ranges::find(parts, path) != parts.end();
}

Node& child(Node& node, const std::string& path, std::size_t index) {
    if (path.ends_with(']') && is_known(path))
        refuse(item(path, index), "path.list", "`" + path + "` is a number, not a list", "");
    if (node.type == Node::nothing || node.type == Node::unset) {
        node.children = open_items(path, index);
        node.type = Node::list;
    }
    if (node.type != Node::list)
        refuse(item(path, index), "path.list", "`" + path + "` is " + node_text(node) + ", not a list",
               "give the whole list: " + path + " = [...]");
    const Key* key = find_key(path);
    if (index == node.children.size() && (!key || index < key->size)) node.children.emplace_back();
    if (index < node.children.size()) return node.children[index];
    if (node.children.empty() && !is_there(path))
        refuse(item(path, index), "path.unknown", "there is no such list", did_you_mean(path, all_paths()));
    refuse(item(path, index), "path.index", "`" + path + "` has " + counted(node.children.size(), "item"), "");
}

Node& reach(Node& root, const std::vector<Step>& steps, const SourceLocation& place) {
    Node* node = &root;
    std::string walked;
    for (const Step& step : steps) {
        node = step.key.empty() ? &child(*node, walked, step.index) : &child(*node, walked, step.key, place);
        walked = step.key.empty() ? item(walked, step.index) : join(walked, step.key);
    }
    return *node;
}

// ---- removing

void remove(Node& root, const std::vector<Step>& steps) {
    const std::vector<Step> parent(steps.begin(), steps.end() - 1);
    Node* from = const_cast<Node*>(find(root, parent));
    if (!from) return;
    if (steps.back().key.empty() && steps.back().index < from->children.size())
        from->children.erase(from->children.begin() + static_cast<std::ptrdiff_t>(steps.back().index));
    else
        std::erase_if(from->children,
                      [&](const Node& node) { return !node.key.empty() && node.key == steps.back().key; });
}

void remove_known(Node& root, std::string_view path, const std::vector<Step>& steps) {
    std::vector<std::string> paths = names_below("");
    const std::vector<std::string> all = all_paths();
    paths.insert(paths.end(), all.begin(), all.end());
    if (!find(root, steps) && !is_there(std::string(path)))
        refuse(path, "path.unknown", "there is no such key to take out", did_you_mean(path, paths));
    remove(root, steps);
}

bool fits(const Key& key, const std::string& word, const Node& root) {
    if (std::find(key.when.begin(), key.when.end(), word) == key.when.end()) return false;
    const Node* node = find(root, parse_path(key.path));
    return key.form != Form::by_choice || !node || (node->type != Node::list) == (word != key.word);
}

// Takes away what does not exist under a choice's new word; "" is none of its words.
void drop_others(Node& root, const std::string& choice, const std::string& word) {
    for (const Key& key : schema()) {
        if (key.when_key != choice || fits(key, word, root)) continue;
        remove(root, parse_path(key.path));
        if (key.kind == Kind::choice) drop_others(root, key.path, "");
    }
}

// Takes away the lists that the file of a table stands for.
void drop_lists(Node& root, const Key& file) {
    for (const Key* column : columns_of(file)) remove(root, parse_path(column->path));
}

void apply(Document& scenario, std::string_view path, const std::string& value,
           const std::shared_ptr<const Edit>& edit) {
    const std::vector<Step> steps = parse_path(path);
    Document document = read_value(value, edit);
    if (is_removal(document, value, path)) return remove_known(scenario.root, path, steps);

    const SourceLocation place{0, 1, edit};
    Node& node = reach(scenario.root, steps, place);
    document.root.key = node.key;
    document.root.key_mark = place;
    node = std::move(document.root);
    const std::vector<Problem> problems = with_edit_location(*edit, path, std::move(document.problems));
    scenario.problems.insert(scenario.problems.end(), problems.begin(), problems.end());

    const Key* key = find_key(path);
    if (key && key->kind == Kind::choice) drop_others(scenario.root, key->path, node.text);
    if (key && key->kind == Kind::file) drop_lists(scenario.root, *key);
}

}  // namespace

void set(Scenario& scenario, std::string_view path, const std::string& value, const std::string& origin) {
    const std::string place = origin + " " + visible(std::string(path) + "=" + value);
    const auto edit = std::make_shared<const Edit>(Edit{origin, place});
    try {
        apply(scenario.document, path, value, edit);
    } catch (const Error& error) {
        throw Error(error.status(), with_edit_location(*edit, path, error.problems()));
    }
}

}  // namespace arm3r
