#include "files/yaml_json.hpp"

#include <utility>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/yaml_tree.hpp"

namespace arm3r {

namespace {

std::string field(const char* name, const std::string& value) { return ", \"" + std::string(name) + "\": " + value; }

std::string place(const SourceLocation& mark) {
    return "\"line\": " + std::to_string(mark.line) + field("column", std::to_string(mark.column));
}

std::string scalar_fields(const Node& node) {
    std::string out = field("text", json_string(node.text)) + field("quoted", node.quoted ? "true" : "false");
    NumberFault fault;
    const NumberRules rules{.degrees = true, .infinity = true, .quoted = node.quoted};
    const std::optional<double> number = read_number(node.text, rules, fault);
    if (!number)
        return out + field("fault", json_string(fault.message + (fault.hint.empty() ? "" : "; " + fault.hint)));
    return out + field("number", json_number(*number)) +
           field("degrees", node.text.ends_with(" deg") ? "true" : "false");
}

std::string json(const Node& node);

std::string json_child(const Node& node) {
    if (node.key_mark.column == 0) return json(node);
    return "{\"key\": " + json_string(node.key) + field("key_line", std::to_string(node.key_mark.line)) +
           field("key_column", std::to_string(node.key_mark.column)) + ", " + json(node).substr(1);
}

std::string json_children(const Node& node) {
    std::string out;
    for (const Node& child : node.children) out += (out.empty() ? "" : ", ") + json_child(child);
    return "[" + out + "]";
}

std::string json(const Node& node) {
    const std::string out = "{" + place(node.mark);
    switch (node.type) {
        case Node::map: return out + field("map", json_children(node)) + "}";
        case Node::list: return out + field("list", json_children(node)) + "}";
        case Node::scalar: return out + scalar_fields(node) + "}";
        default: return out + field("nothing", "true") + "}";
    }
}

}  // namespace

std::string yaml_json(std::string text, const std::string& file) {
    Document document = parse_yaml(checked_text(std::move(text), file), file);
    if (!document.problems.empty()) throw Error(ARM3R_E_SCENARIO, std::move(document.problems));
    return json(document.root);
}

}  // namespace arm3r
