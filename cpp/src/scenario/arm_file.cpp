#include "scenario/arm_file.hpp"

#include <mutex>

#include "base/callback.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/paths.hpp"
#include "platform/files.hpp"
#include "schema/schema.hpp"

namespace arm3r {
namespace {

struct Reader {
    arm3r_arm_reader function = nullptr;
    void* user = nullptr;
};

struct SharedReader {
    std::mutex mutex;
    Reader reader;
};

SharedReader& shared_reader() {
    static SharedReader shared;
    return shared;
}

Reader current_reader() {
    const std::lock_guard lock(shared_reader().mutex);
    return shared_reader().reader;
}

// A scalar as text, lists and maps of them as arrays and objects.
std::string json_of(const Node& node) {
    if (node.type == Node::scalar) return json_string(node.text);
    if (node.type != Node::list && node.type != Node::map) return "null";
    std::vector<std::string> parts;
    for (const Node& child : node.children)
        parts.push_back(node.type == Node::map ? json_string(child.key) + ": " + json_of(child) : json_of(child));
    return node.type == Node::map ? "{" + listed(parts) + "}" : "[" + listed(parts) + "]";
}

bool is_about_file(const Node& node) {
    const Key* key = find_key("arm." + node.key);
    return key && key->kind == Kind::arm_file;
}

void list_given(const Node& section, const std::string& prefix, std::vector<std::string>& paths) {
    for (const Node& node : section.children) {
        if (prefix.empty() && is_about_file(node)) continue;
        paths.push_back(json_string(prefix + node.key));
        if (node.type == Node::map) list_given(node, prefix + node.key + ".", paths);
    }
}

std::string request_of(const Node& arm, const std::string& scenario_file) {
    const std::size_t folder = platform::last_separator(scenario_file);
    std::vector<std::string> members;
    for (const Node& node : arm.children)
        if (is_about_file(node) && node.type != Node::unset)
            members.push_back(json_string(node.key) + ": " + json_of(node));
    if (folder != scenario_file.npos)
        members.push_back("\"folder\": " + json_string(scenario_file.substr(0, folder + 1)));
    std::vector<std::string> given;
    list_given(arm, "", given);
    members.push_back("\"given\": [" + listed(given) + "]");
    return "{" + listed(members) + "}";
}

void place_at(Node& node, const SourceLocation& place) {
    node.mark = node.key_mark = place;
    for (Node& child : node.children) place_at(child, place);
}

// Adds what the file says, as far as nothing stands there.
void add(Node& section, const Node& from_file, const SourceLocation& place) {
    Node* given = section.find(from_file.key);
    if (given && given->type == Node::map && from_file.type == Node::map)
        for (const Node& child : from_file.children) add(*given, child, place);
    if (given) return;
    section.children.push_back(from_file);
    place_at(section.children.back(), place);
}

// The comment above each key at the left says which joint or links it comes from.
std::vector<std::pair<std::string, std::string>> sources_in(const std::string& text) {
    std::vector<std::pair<std::string, std::string>> sources;
    std::string comment;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        begin = end + 1;
        if (line.starts_with("# ")) comment += (comment.empty() ? "" : " ") + line.substr(2);
        else if (!line.empty() && line[0] != ' ') {
            sources.emplace_back(line.substr(0, line.find(':')), comment);
            comment.clear();
        }
    }
    return sources;
}

void merge(Node& arm, const std::string& text, const std::string& file) {
    const Node keys = parse_yaml(text, file).root;
    const auto sources = sources_in(text);
    for (const Node& node : keys.children) {
        std::string origin = file;
        for (const auto& [key, source] : sources)
            if (key == node.key && !source.empty()) origin += ": " + source;
        add(arm, node, {0, 0, std::make_shared<const Edit>(Edit{visible(origin, 200), file})});
    }
}

Problem refused(const Node& urdf, const std::string& file, const std::string& message, const std::string& hint = {}) {
    return located({.code = "scenario.arm_file", .path = "arm.urdf", .message = visible(message, 2000), .hint = hint},
                   urdf.mark, file);
}

}  // namespace

void set_arm_reader(arm3r_arm_reader reader, void* user) {
    const std::lock_guard lock(shared_reader().mutex);
    shared_reader().reader = {reader, user};
}

Node with_arm_file(Node root, const std::string& scenario_file, std::vector<Problem>& problems) {
    Node* arm = root.type == Node::map ? root.find("arm") : nullptr;
    if (!arm || arm->type != Node::map) return root;
    const Node* found = arm->find("urdf");
    if (!found || found->type != Node::scalar) return root;
    const Node urdf = *found;
    const std::string request = request_of(*arm, scenario_file);
    for (Node& node : arm->children)
        if (is_about_file(node)) node.type = Node::unset;
    const Reader reader = current_reader();
    if (!reader.function)
        throw Error(ARM3R_E_FILE,
                    {refused(urdf, scenario_file, "a URDF is read by the Python package, which is not here",
                             "where it is: arm3r import " + visible(urdf.text) +
                                 " > my_arm.yaml prints a scenario with the keys of its arm")});
    const char* text = nullptr;
    const std::int32_t status = call_back(reader.function, reader.user, request.c_str(), &text);
    const std::string answer =
        text && *text ? text : "the reader ended with " + std::to_string(status) + ", without a text";
    if (status != 0 || !text || !*text) problems.push_back(refused(urdf, scenario_file, answer));
    else merge(*arm, answer, urdf.text);
    return root;
}

}  // namespace arm3r
