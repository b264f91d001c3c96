#include "files/paths.hpp"

#include <algorithm>
#include <charconv>

#include "schema/schema.hpp"
#include "schema/suggest.hpp"

namespace arm3r {

namespace {

[[noreturn]] void refuse(std::string_view path, std::string message) {
    throw Error(ARM3R_E_INDEX, {{.code = "path.syntax",
                                 .path = std::string(path),
                                 .message = std::move(message),
                                 .hint = "write it like wall.contact.stiffness or initial.q[1]"}});
}

const Node* child(const Node& node, const Step& step) {
    if (!step.key.empty()) return node.type == Node::map ? node.find(step.key) : nullptr;
    return node.type == Node::list && step.index < node.children.size() ? &node.children[step.index] : nullptr;
}

}  // namespace

std::vector<Step> parse_path(std::string_view path) {
    std::vector<Step> steps;
    for (std::size_t at = 0; at <= path.size();) {
        const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
        if (end == at) refuse(path, "a path is words joined by points");
        steps.push_back({std::string(path.substr(at, end - at))});
        at = end;
        while (at < path.size() && path[at] == '[') {
            Step step;
            const char* last = path.data() + path.size();
            const auto [stop, error] = std::from_chars(path.data() + at + 1, last, step.index);
            if (error != std::errc() || stop == last || *stop != ']')
                refuse(path, "the number of an item must stand in [ ]");
            steps.push_back(step);
            at = static_cast<std::size_t>(stop + 1 - path.data());
        }
        if (at == path.size()) break;
        if (path[at] != '.') refuse(path, "a path is words joined by points");
        ++at;
    }
    return steps;
}

const Node* find(const Node& root, const std::vector<Step>& steps) {
    const Node* node = &root;
    for (const Step& step : steps)
        if (node) node = child(*node, step);
    return node;
}

SourceLocation locate(const Node& root, const std::vector<Step>& steps) {
    const Node* node = &root;
    for (const Step& step : steps) {
        const Node* next = child(*node, step);
        if (!next) return node->start();
        node = next;
    }
    return node->mark;
}

std::string join(std::string_view prefix, std::string_view key) {
    return std::string(prefix) + (prefix.empty() ? "" : ".") + std::string(key);
}

std::string last_name(std::string_view path) { return std::string(path.substr(path.rfind('.') + 1)); }

std::string item(std::string_view path, std::size_t index) {
    return std::string(path) + "[" + std::to_string(index) + "]";
}

std::string below(std::string_view path, std::string_view rest) {
    return rest.empty() || rest.starts_with('[') ? std::string(path) + std::string(rest) : join(path, rest);
}

std::vector<std::string> names_below(std::string_view section) {
    std::vector<std::string> names;
    const std::string prefix = join(section, "");
    if (section.empty()) names = {"format", "name"};
    for (const Key& key : schema()) {
        if (!key.path.starts_with(prefix) || key.path == section) continue;
        const std::string name = key.path.substr(prefix.size(), key.path.find('.', prefix.size()) - prefix.size());
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    if (section.empty()) names.push_back("checks");
    return names;
}

bool is_section(std::string_view path) {
    const std::string prefix = join(path, "");
    return std::any_of(schema().begin(), schema().end(), [&](const Key& key) { return key.path.starts_with(prefix); });
}

bool is_known(std::string_view path) {
    const std::size_t bracket = std::min(path.find('['), path.size());
    const Key* key = find_key(path.substr(0, bracket));
    if (bracket == path.size()) return key || is_section(path);
    const std::vector<Step> steps = parse_path(path);
    const bool is_item = steps.back().key.empty() && item(path.substr(0, bracket), steps.back().index) == path;
    return key && is_item && steps.back().index < key->size && key->size > 1;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& words) {
    const std::string near = nearest(word, words);
    return near.empty() ? "" : "did you mean " + near + "?";
}

std::vector<std::string> all_paths() {
    std::vector<std::string> paths = {"format", "name", "checks"};
    for (const Key& key : schema()) paths.push_back(key.path);
    return paths;
}

}  // namespace arm3r
