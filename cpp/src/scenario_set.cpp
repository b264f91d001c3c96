// Edits by path: what `--set` and arm3r_scenario_set do.

#include <algorithm>

#include "paths.hpp"
#include "scenario.hpp"
#include "schema.hpp"

namespace arm3r {

namespace {

// A mark in a --set value has a column and no line.
void forget_lines(Node& node) {
    node.mark.line = node.key_mark.line = 0;
    for (Node& child : node.children) forget_lines(child);
}

Document read_value(std::string_view path, const std::string& value) {
    try {
        Document document = parse_yaml(checked_text(value, "--set"), "--set");
        forget_lines(document.root);
        for (Problem& problem : document.problems) {
            problem.line = 0;
            problem.path = join(path, problem.path);
        }
        return document;
    } catch (const Error& error) {
        std::vector<Problem> problems = error.problems();
        for (Problem& problem : problems) {
            problem.line = 0;
            problem.path = path;
        }
        throw Error(error.status(), problems);
    }
}

[[noreturn]] void refuse(std::string_view path, std::string code, std::string message, std::string hint) {
    throw Error(ARM3R_E_SCENARIO, {{.code = std::move(code),
                                    .path = std::string(path),
                                    .message = std::move(message),
                                    .got = "",
                                    .allowed = "",
                                    .hint = std::move(hint),
                                    .file = "--set"}});
}

// A list of which only single items are set: the others keep their defaults.
std::vector<Node> open_items(std::string_view path) {
    const Key* key = find_key(path);
    Node hole;
    hole.type = Node::hole;
    return std::vector<Node>(key ? key->size : 0, hole);
}

Node& child(Node& node, const std::string& path, const std::string& name) {
    if (node.type == Node::nothing || node.type == Node::hole) node.type = Node::map;
    if (node.type != Node::map)
        refuse(join(path, name), "path.section", "`" + path + "` is " + shape_of(node) + ", not a section", "");
    if (Node* found = node.find(name)) return *found;
    Node fresh;
    fresh.type = Node::hole;
    fresh.key = name;
    fresh.key_mark = fresh.mark = {0, 1};
    node.children.push_back(fresh);
    return node.children.back();
}

Node& child(Node& node, const std::string& path, std::size_t index) {
    if (node.type == Node::nothing || node.type == Node::hole) {
        node.type = Node::list;
        node.children = open_items(path);
    }
    if (node.type != Node::list)
        refuse(item(path, index), "path.list", "`" + path + "` is " + shape_of(node) + ", not a list", "");
    if (index == node.children.size()) node.children.emplace_back();
    if (index > node.children.size())
        refuse(item(path, index), "path.index", "`" + path + "` has " + std::to_string(node.children.size()) + " items",
               "");
    return node.children[index];
}

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

bool fits(const Key& key, const std::string& word, const Node& root) {
    if (std::find(key.when.begin(), key.when.end(), word) == key.when.end()) return false;
    const Node* node = find(root, parse_path(key.path));
    return key.form != Form::by_choice || !node || (node->type != Node::list) == (word == key.when.front());
}

// Takes away what does not exist under a choice's new word; "" is none of its words.
void drop_others(Node& root, const std::string& choice, const std::string& word) {
    for (const Key& key : schema()) {
        if (key.when_key != choice || fits(key, word, root)) continue;
        remove(root, parse_path(key.path));
        if (key.kind == Kind::choice) drop_others(root, key.path, "");
    }
}

}  // namespace

void set(Scenario& scenario, std::string_view path, const std::string& value) {
    const std::vector<Step> steps = parse_path(path);
    Document document = read_value(path, value);
    Node& root = scenario.document.root;
    if (document.root.type == Node::nothing) return remove(root, steps);

    Node* node = &root;
    std::string walked;
    for (const Step& step : steps) {
        node = step.key.empty() ? &child(*node, walked, step.index) : &child(*node, walked, step.key);
        walked = step.key.empty() ? item(walked, step.index) : join(walked, step.key);
    }
    document.root.key = node->key;
    document.root.key_mark = {0, 1};
    *node = std::move(document.root);
    scenario.document.problems.insert(scenario.document.problems.end(), document.problems.begin(),
                                      document.problems.end());

    const Key* key = find_key(path);
    if (key && key->kind == Kind::choice) drop_others(root, key->path, node->text);
}

}  // namespace arm3r
