#pragma once
// YAML text as a tree of plain structs with source locations, built from the parser's events. What a scenario must not
// use (anchors, aliases, tags, merge keys, duplicate keys) is listed beside the tree.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace arm3r {

// A value that was set by path.
struct Edit {
    std::string origin, location;  // "--set", "--set time.stop=5"
};

struct SourceLocation {
    int line = 0, column = 0;               // from 1; in an edit only the column, of its value
    std::shared_ptr<const Edit> edit = {};  // null: in the file
};

struct Node {
    enum Type {
        nothing,  // a null
        scalar,
        list,
        map,
        unset,  // not set: an item left open by an edit, or something already refused
    };
    Type type = nothing;
    std::string key;   // in a map: its key
    std::string text;  // of a scalar
    bool quoted = false;
    SourceLocation key_mark, mark;
    std::vector<Node> children;
    std::string note;  // printed as a comment

    const Node* find(std::string_view name) const;
    Node* find(std::string_view name);
    const SourceLocation& start() const { return key_mark.column ? key_mark : mark; }
};

Node leaf(std::string key, std::string text, std::string note = {});  // a scalar

struct Document {
    Node root;
    std::vector<Problem> problems;
};

// The problem with its location: in `file`, or in an edit.
Problem located(Problem problem, const SourceLocation& at, const std::string& file);

// As messages show it: "a list of 3", "a map", "0.5" (as written), "nothing"
std::string node_text(const Node& node);

// Throws Error ARM3R_E_SCENARIO where the text cannot be read any further. The document may be empty (nothing).
Document parse_yaml(const std::string& text, const std::string& file);

inline constexpr std::size_t most_yaml_bytes = 1 << 20;

// At most so many bytes (1 MiB) of UTF-8 without control characters; CR only before LF. A leading byte order mark is
// taken off.
std::string checked_text(std::string text, const std::string& file);

}  // namespace arm3r
