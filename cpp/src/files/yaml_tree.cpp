#include "files/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "base/text.hpp"

namespace arm3r {

namespace {

constexpr std::size_t max_nodes = 50'000, longest_scalar = 64 << 10, deepest = 64, max_open_brackets = 10'000,
                      max_keys = 1000;

[[noreturn]] void refuse(Problem problem) { throw Error(ARM3R_E_SCENARIO, std::vector{std::move(problem)}); }

// yaml-cpp counts columns in bytes, people in characters.
class Lines {
public:
    explicit Lines(std::string_view text) {
        for (std::size_t at = 0; at <= text.size(); at = text.find('\n', at) + 1) {
            lines_.push_back(text.substr(at, text.find('\n', at) - at));
            if (text.find('\n', at) == text.npos) break;
        }
    }

    SourceLocation mark(const YAML::Mark& mark) const {
        const std::size_t line = std::min<std::size_t>(mark.line < 0 ? 0 : mark.line, lines_.size() - 1);
        const std::size_t bytes = std::min<std::size_t>(mark.column < 0 ? 0 : mark.column, lines_[line].size());
        if (line != line_ || bytes < bytes_) line_ = line, bytes_ = characters_ = 0;
        characters_ += count_characters(lines_[line].substr(bytes_, bytes - bytes_));
        bytes_ = bytes;
        return {static_cast<int>(line) + 1, static_cast<int>(characters_) + 1};
    }

    std::string_view line(int number) const { return lines_[static_cast<std::size_t>(number) - 1]; }

    // The byte at this place, or 0.
    char at(const YAML::Mark& mark) const {
        const std::string_view line = lines_[std::min<std::size_t>(std::max(mark.line, 0), lines_.size() - 1)];
        return mark.column >= 0 && std::size_t(mark.column) < line.size() ? line[std::size_t(mark.column)] : '\0';
    }

    // Whether the quote at this place is closed. The parser accepts the end of the text as its end.
    bool is_closed(const YAML::Mark& mark) const {
        const char quote = at(mark);
        const char* const first = lines_[std::size_t(mark.line)].data() + mark.column + 1;
        const char* const last = lines_.back().data() + lines_.back().size();
        for (const char* c = first; c < last; ++c) {
            if (quote == '"' && *c == '\\') ++c;
            else if (*c == quote && (quote == '"' || c + 1 == last || c[1] != quote)) return true;
            else if (*c == quote) ++c;
        }
        return false;
    }

private:
    std::vector<std::string_view> lines_;
    mutable std::size_t line_ = 0, bytes_ = 0, characters_ = 0;  // the last place: the next one mostly lies behind it
};

class Builder : public YAML::EventHandler {
public:
    Builder(const Lines& lines, const std::string& file) : lines_(lines), file_(file) {}

    Document document;

    // The innermost bracket that is open, as "[ of line 2, column 5"; "" where none is.
    std::string open_bracket() const {
        for (auto frame = stack_.rbegin(); frame != stack_.rend(); ++frame)
            if (frame->bracket)
                return std::string(1, frame->bracket) + " of line " + std::to_string(frame->node.mark.line) +
                       ", column " + std::to_string(frame->node.mark.column);
        return {};
    }

    void OnDocumentStart(const YAML::Mark&) override {}
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { leaf(node(Node::nothing, mark, "", anchor)); }

    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
        const Node alias = node(Node::unset, mark, "", 0);
        problem(alias.mark, "yaml.alias", "anchors and aliases are not supported", "write the value out");
        leaf(alias);
    }

    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        const bool is_tagged = lines_.at(mark) == '!';  // the parser gives quoted text the tag ! too
        Node scalar = node(Node::scalar, mark, tag == "!" && !is_tagged ? "" : tag, anchor);
        if (value.size() > longest_scalar)
            fatal(scalar.mark, "yaml.scalar_length", "a value is longer than 64 KiB",
                  std::to_string(value.size()) + " bytes");
        scalar.quoted = tag == "!" && !is_tagged;
        const char first = lines_.at(mark);
        if ((first == '\'' || first == '"') && !lines_.is_closed(mark))
            fatal(scalar.mark, "yaml.syntax", "a quote is not closed", "");
        scalar.text = value;
        leaf(std::move(scalar));
    }

    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value) override {
        open(node(Node::list, mark, tag, anchor), mark);
    }
    void OnSequenceEnd() override { close(); }

    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value) override {
        open(node(Node::map, mark, tag, anchor), mark);
    }
    void OnMapEnd() override { close(); }

private:
    struct Frame {
        Node node;
        char bracket;  // that opened it; 0 where indentation did
        std::string key;
        SourceLocation key_mark;
        bool has_key = false;
    };

    Node node(Node::Type type, const YAML::Mark& at, const std::string& tag, YAML::anchor_t anchor) {
        Node node;
        node.type = type;
        node.mark = lines_.mark(at);
        if (++nodes_ > max_nodes) fatal(node.mark, "yaml.nodes", "more than 50000 values in one file", "");
        if (anchor) problem(node.mark, "yaml.anchor", "anchors and aliases are not supported", "write the value out");
        if (!tag.empty() && tag != "?")
            problem(node.mark, "yaml.tag", "tags are not supported", "take '" + tag + "' out");
        return node;
    }

    void open(Node node, const YAML::Mark& at) {
        if (stack_.size() == deepest) fatal(node.mark, "yaml.depth", "nesting deeper than 64", "");
        const char first = lines_.at(at);
        stack_.push_back({std::move(node), first == '[' || first == '{' ? first : '\0', {}, {}});
    }

    void close() {
        Node done = std::move(stack_.back().node);
        stack_.pop_back();
        leaf(std::move(done));
    }

    void leaf(Node node) {
        if (stack_.empty()) document.root = std::move(node);
        else if (stack_.back().node.type == Node::list) stack_.back().node.children.push_back(std::move(node));
        else if (stack_.back().has_key) add_value(std::move(node));
        else take_key(std::move(node));
    }

    void take_key(Node node) {
        Frame& frame = stack_.back();
        if (node.type != Node::scalar && node.type != Node::unset)
            problem(node.mark, "yaml.key", "a key must be a word", "got " + node_text(node));
        if (node.type == Node::scalar && node.text.empty())
            problem(node.mark, "yaml.key", "a key must be a word", "got an empty text");
        if (node.type == Node::scalar && node.text == "<<")
            problem(node.mark, "yaml.merge", "merge keys are not supported", "write the keys out");
        frame.key = std::move(node.text);
        frame.key_mark = node.mark;
        frame.has_key = true;
    }

    void add_value(Node node) {
        Frame& frame = stack_.back();
        node.key = frame.key;
        node.key_mark = frame.key_mark;
        if (const Node* first = frame.node.find(node.key); first && !node.key.empty() && node.key != "<<")
            problem(node.key_mark, "yaml.duplicate_key",
                    "the key '" + node.key + "' stands here and on line " + std::to_string(first->key_mark.line),
                    "keep one of the two");
        else if (frame.node.children.size() == max_keys)
            fatal(node.key_mark, "yaml.keys", "more than 1000 keys in one map", "");
        else if (!node.key.empty() && node.key != "<<") frame.node.children.push_back(std::move(node));
        frame.has_key = false;
    }

    std::string path() const {
        std::string path;
        for (const Frame& frame : stack_) {
            if (frame.node.type == Node::list) path += "[" + std::to_string(frame.node.children.size()) + "]";
            if (frame.has_key) path += (path.empty() ? "" : ".") + frame.key;
        }
        return path;
    }

    void problem(SourceLocation at, std::string code, std::string message, std::string hint) {
        document.problems.push_back(
            located({.code = std::move(code), .path = path(), .message = std::move(message), .hint = std::move(hint)},
                    at, file_));
    }

    [[noreturn]] void fatal(SourceLocation at, std::string code, std::string message, std::string got) const {
        refuse(located({.code = std::move(code), .message = std::move(message), .got = std::move(got)}, at, file_));
    }

    const Lines& lines_;
    const std::string& file_;
    std::vector<Frame> stack_;
    std::size_t nodes_ = 0;
};

// A tab among the blanks that start a line, at or above `last`: the usual reason of an error there.
std::string tab_hint(const Lines& lines, int last) {
    for (int number = last; number >= std::max(1, last - 1); --number) {
        const std::string_view line = lines.line(number);
        const std::size_t tab = line.find('\t');
        if (tab != line.npos && line.find_first_not_of(" \t-") >= tab)
            return "tab at column " + std::to_string(tab + 1) + " of line " + std::to_string(number) + "; use spaces";
    }
    return {};
}

// The parser's words for what people do, in plain ones, and the likely fix. The first that the message holds counts.
struct Fault {
    std::string_view parsers, ours, hint;
};
constexpr Fault faults[] = {
    {"end of map flow not found", "a { is not closed", "close it with }"},
    {"end of sequence flow not found", "a [ is not closed", "close it with ]"},
    {"illegal flow end", "a bracket closes that is not open", "take it out, or open it before"},
    {"end of map not found", "this line belongs to no map",
     "give the keys of one map the same indentation, and each a colon and a blank"},
    {"end of sequence not found", "this line belongs to no list", "give the items of one list the same indentation"},
    {"illegal map value", "a colon stands where no value can begin",
     "write one `key: value` a line, with quotes around a text that holds a colon"},
    {"illegal map key", "a key stands where none can begin", "begin it on a line of its own"},
    {"illegal block entry", "a list begins where none can", "begin it on a line of its own"},
    {"illegal EOF in scalar", "a quote is not closed", "close it"},
    {"illegal document indicator", "a quote is not closed", "close it"},
    {"unknown escape character", "a backslash in double quotes begins no such character", "use single quotes"},
    {"illegal character in scalar", "a text begins with a character that needs quotes", "put it in quotes"},
    {"unknown token", "no value begins with this character", "put the text in quotes"},
    {"illegal tab", "a tab stands in an indentation", "use spaces"},
};

const Fault* fault_of(const std::string& message) {
    const auto found = std::find_if(std::begin(faults), std::end(faults), [&](const Fault& fault) {
        return message.find(fault.parsers) != std::string::npos;
    });
    return found == std::end(faults) ? nullptr : found;
}

Problem syntax_problem(const YAML::Exception& error, const Lines& lines, const std::string& open_bracket,
                       const std::string& file) {
    const SourceLocation at = lines.mark(error.mark);
    const auto has = [&](const char* word) { return error.msg.find(word) != std::string::npos; };
    Problem problem{.code = "yaml.syntax", .message = ""};
    if (has("anchor") || has("alias")) {
        problem.code = "yaml.alias";
        problem.message = "anchors and aliases are not supported";
    } else if (has("depth") || has("nesting")) {
        problem.code = "yaml.depth";
        problem.message = "nesting deeper than 64";
    } else {
        const Fault* fault = fault_of(error.msg);
        problem.message = "not valid YAML at or before this place: " + (fault ? std::string(fault->ours) : error.msg);
        problem.hint = fault ? fault->hint : "";
        if (!open_bracket.empty()) problem.hint = "close the bracket that is open, " + open_bracket;
    }
    if (const std::string hint = tab_hint(lines, at.line); !hint.empty()) problem.hint = hint;
    return located(std::move(problem), at, file);
}

// Accepts nothing: a second document is one too many.
class NoDocument : public YAML::EventHandler {
public:
    NoDocument(const Lines& lines, const std::string& file) : lines_(lines), file_(file) {}
    void OnDocumentStart(const YAML::Mark& mark) override {
        refuse(located({.code = "yaml.documents",
                        .message = "a second document starts here; one document per file",
                        .hint = "split the file at '---'"},
                       lines_.mark(mark), file_));
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
    void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
    void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
    void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
    void OnMapEnd() override {}

private:
    const Lines& lines_;
    const std::string& file_;
};

[[noreturn]] void refuse_bytes(std::string_view text, std::size_t at, const std::string& file, std::string what,
                               std::string hint) {
    const std::string_view before = text.substr(0, at);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const auto column = 1 + count_characters(before.substr(before.rfind('\n') + 1));
    refuse(located({.code = "yaml.encoding",
                    .message = std::move(what) + " at byte " + std::to_string(at),
                    .hint = std::move(hint)},
                   {static_cast<int>(line), static_cast<int>(column)}, file));
}

void check_characters(std::string_view text, const std::string& file) {
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t begin = at;
        const std::int32_t c = next_code_point(text, at);
        if (c >= 0x20 && c < 0x7F) continue;
        if (c < 0) refuse_bytes(text, begin, file, "not UTF-8", "save the file as UTF-8");
        if (c == 0) refuse_bytes(text, begin, file, "a NUL byte", "save the file as UTF-8");
        if (c == '\r' && !text.substr(at).starts_with('\n'))
            refuse_bytes(text, begin, file, "a carriage return without line feed", "end lines with LF or CR LF");
        if (c == '\t' || c == '\n' || c == '\r') continue;
        if (is_bidi_control(c))
            refuse_bytes(text, begin, file, "a character that changes the direction of text", "take it out");
        if (is_control(c)) refuse_bytes(text, begin, file, "a control character", "take it out");
    }
}

// Whether a # at this place makes the brackets in the rest of the line irrelevant: either a comment begins there, or,
// since no quote follows in the line, it is inside a longer text.
bool begins_harmless_rest(std::string_view text, std::size_t at) {
    if (text[at] != '#' || (at > 0 && text[at - 1] != ' ' && text[at - 1] != '\t' && text[at - 1] != '\n'))
        return false;
    const std::string_view rest = text.substr(at, text.find('\n', at) - at);
    return rest.find_first_of("'\"") == rest.npos;
}

// The parser reads nested brackets to their end before it reports the first one. If far more brackets are open than is
// allowed, in quotes or not, the parser is not called.
void check_brackets(std::string_view text, const std::string& file) {
    std::size_t open = 0, line_begin = 0;
    int line = 1;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (begins_harmless_rest(text, at)) at = std::min(text.find('\n', at), text.size() - 1);
        const char c = text[at];
        if (c == '\n') ++line, line_begin = at + 1;
        if (c == '[' || c == '{') ++open;
        if ((c == ']' || c == '}') && open > 0) --open;
        if (open <= max_open_brackets) continue;
        const std::size_t before = count_characters(text.substr(line_begin, at - line_begin));
        refuse(located({.code = "yaml.depth",
                        .message = "nesting deeper than 64: here " + std::to_string(open) + " brackets are open"},
                       {line, static_cast<int>(before) + 1}, file));
    }
}

}  // namespace

Problem located(Problem problem, const SourceLocation& at, const std::string& file) {
    problem.file = at.edit ? at.edit->location : file;
    problem.line = at.line;
    problem.column = at.edit && at.column == 1 ? 0 : at.column;
    return problem;
}

const Node* Node::find(std::string_view name) const {
    for (const Node& child : children)
        if (child.key == name) return &child;
    return nullptr;
}

Node* Node::find(std::string_view name) { return const_cast<Node*>(std::as_const(*this).find(name)); }

Node leaf(std::string key, std::string text, std::string note) {
    Node node;
    node.type = Node::scalar;
    node.key = std::move(key);
    node.text = std::move(text);
    node.note = std::move(note);
    return node;
}

std::string node_text(const Node& node) {
    switch (node.type) {
        case Node::scalar: return node.quoted ? json_string(node.text) : node.text;
        case Node::list: return "a list of " + std::to_string(node.children.size());
        case Node::map: return "a map";
        default: return "nothing";
    }
}

std::string checked_text(std::string text, const std::string& file) {
    if (text.size() > most_yaml_bytes)
        refuse({.code = "file.size",
                .message = "larger than a scenario may be",
                .got = "more than " + std::to_string(most_yaml_bytes) + " bytes",
                .allowed = "at most 1048576 bytes (1 MiB)",
                .file = file});
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        refuse_bytes(text, 0, file, "UTF-16 or UTF-32, not UTF-8", "save the file as UTF-8");
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    if (text.starts_with("\xEF\xBB\xBF")) refuse_bytes(text, 0, file, "a second byte order mark", "take it out");
    check_characters(text, file);
    return text;
}

Document parse_yaml(const std::string& text, const std::string& file) {
    const Lines lines(text);
    check_brackets(text, file);
    Builder builder(lines, file);
    try {
        std::istringstream stream(text);
        YAML::Parser parser(stream);
        parser.HandleNextDocument(builder);
        NoDocument none(lines, file);
        parser.HandleNextDocument(none);
    } catch (const YAML::Exception& error) {
        std::vector<Problem> problems = std::move(builder.document.problems);
        problems.push_back(syntax_problem(error, lines, builder.open_bracket(), file));
        throw Error(ARM3R_E_SCENARIO, std::move(problems));
    }
    return std::move(builder.document);
}

}  // namespace arm3r
