// A resolved scenario as YAML and as JSON.

#include <algorithm>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/paths.hpp"
#include "scenario/meant_key.hpp"
#include "scenario/scenario.hpp"

namespace arm3r {

namespace {

constexpr std::size_t widest = 44;  // comments start here, or behind a longer line

bool is_plain_word(const std::string& text) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto inner = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; };
    std::string lower = text;
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
    const bool reserved = lower == "null" || lower == "true" || lower == "false" || lower == "yes" || lower == "no" ||
                          lower == "on" || lower == "off" || lower == "y" || lower == "n" || lower == "inf" ||
                          lower == "nan";
    return !text.empty() && letter(text[0]) && std::all_of(text.begin(), text.end(), inner) && !reserved;
}

bool is_number(const Node& node) {
    NumberFault fault;
    return !node.quoted && read_number(node.text, {}, fault).has_value();
}

std::string scalar_yaml(const Node& node) {
    if (is_number(node)) return yaml_number(node.text);
    const bool literal =
        !node.quoted && (node.text == "true" || node.text == "false" || node.text == "inf" || node.text == "-inf");
    return literal || is_plain_word(node.text) ? node.text : json_string(node.text);
}

std::string flow_yaml(const Node& node) {
    if (node.type == Node::scalar) return scalar_yaml(node);
    if (node.type != Node::list && node.type != Node::map) return "null";
    std::string out;
    for (const Node& child : node.children)
        out +=
            (out.empty() ? "" : ", ") + (node.type == Node::map ? child.key + ": " : std::string()) + flow_yaml(child);
    return node.type == Node::map ? "{" + out + "}" : "[" + out + "]";
}

bool says_something(const Node& node) {
    if (node.type != Node::map) return node.type != Node::nothing;
    return std::any_of(node.children.begin(), node.children.end(), says_something);
}

class YamlWriter {
public:
    explicit YamlWriter(bool notes) : notes_(notes) {}

    void section(const Node& map, const std::string& indent) {
        const bool has_value = std::any_of(map.children.begin(), map.children.end(), [](const Node& n) {
            return n.type != Node::map && n.type != Node::nothing;
        });
        for (const Node& node : map.children) {
            if (node.type == Node::map && says_something(node)) {
                text += indent + node.key + ":\n";
                section(node, indent + "  ");
            } else if (node.key == "checks") {
                checks(node);
            } else if (node.type == Node::nothing) {
                if (notes_ && has_value && !node.note.empty())
                    text += indent + "# " + node.key + ": " + node.note + "\n";
            } else if (node.type != Node::map) {
                line(indent + node.key + ": " + flow_yaml(node), node.note);
            }
        }
    }

    std::string text;

private:
    void checks(const Node& list) {
        text += list.children.empty() ? "checks: []\n" : "checks:\n";
        for (const Node& check : list.children) text += "  - " + flow_yaml(check) + "\n";
    }

    void line(std::string line, const std::string& note) {
        if (notes_ && !note.empty()) {
            line += std::string(line.size() < widest ? widest - line.size() : 1, ' ');
            line += "# " + note;
        }
        text += line + "\n";
    }

    bool notes_;
};

}  // namespace

std::string to_yaml(const Node& tree, bool notes) {
    YamlWriter writer(notes);
    writer.section(tree, "");
    return writer.text;
}

std::string to_json(const Node& node) {
    std::string out;
    switch (node.type) {
        case Node::scalar:
            if (is_number(node)) {
                NumberFault fault;
                return json_number(*read_number(node.text, {}, fault));
            }
            return !node.quoted && (node.text == "true" || node.text == "false") ? node.text : json_string(node.text);
        case Node::list:
            for (const Node& child : node.children) out += (out.empty() ? "" : ", ") + to_json(child);
            return "[" + out + "]";
        case Node::map:
            for (const Node& child : node.children)
                out += (out.empty() ? "" : ", ") + json_string(child.key) + ": " + to_json(child);
            return "{" + out + "}";
        default: return "null";
    }
}

std::string json_at(const Resolved& resolved, std::string_view path) {
    const std::vector<Step> steps = parse_path(path);
    if (const Node* node = find(resolved.tree, steps)) return to_json(*node);
    if (path == "checks") return "[]";
    if (is_known(path)) return "null";
    const std::size_t dot = path.rfind('.');
    const std::string other = not_of_this_arm(last_name(path), dot == path.npos ? "" : path.substr(0, dot));
    throw Error(ARM3R_E_INDEX, {{.code = "path.unknown",
                                 .path = std::string(path),
                                 .message = "there is no such value",
                                 .hint = other.empty() ? did_you_mean(path, all_paths()) : other}});
}

}  // namespace arm3r
