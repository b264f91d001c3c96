#include "scenario/table_file.hpp"

#include <algorithm>
#include <optional>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/input_file.hpp"
#include "files/paths.hpp"
#include "platform/files.hpp"
#include "schema/schema.hpp"

namespace arm3r {
namespace {

constexpr std::size_t max_bytes = 16 << 20;

struct Cell {
    std::string_view text;
    int column;  // of its first character, from 1
};

// The character that parts the cells of a file, to be seen in its first line; ' ' for any number of blanks.
char delimiter_of(std::string_view line) {
    for (const char delimiter : {';', '\t', ','})
        if (line.find(delimiter) != line.npos) return delimiter;
    return ' ';
}

std::vector<Cell> cells_of(std::string_view line, char delimiter) {
    std::vector<Cell> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
        if (delimiter == ' ') begin = std::min(line.find_first_not_of(" \t", begin), line.size());
        const std::size_t end = std::min(line.find(delimiter, begin), line.size());
        const std::string_view cell = line.substr(begin, end - begin);
        const std::size_t blanks = std::min(cell.find_first_not_of(" \t"), cell.size());
        if (delimiter != ' ' || !cell.empty())
            cells.push_back({trimmed(cell), static_cast<int>(count_characters(line.substr(0, begin + blanks))) + 1});
        begin = end + 1;
    }
    return cells;
}

bool is_number(std::string_view text) {
    NumberFault fault;
    return read_number(text, {}, fault).has_value();
}

std::string_view unquoted(std::string_view text) {
    const bool is_quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return is_quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

std::vector<std::string> names_in(const std::vector<Cell>& cells) {
    std::vector<std::string> names;
    for (const Cell& cell : cells) names.emplace_back(unquoted(cell.text));
    return names;
}

// Reads one file into lists.
class TableReader {
public:
    TableReader(const Key& key, const std::string& name, std::string path, std::vector<Problem>& problems)
        : key_(key),
          path_(std::move(path)),
          file_(std::make_shared<const Edit>(Edit{name, path_})),
          problems_(problems) {}

    // The lists that the file has; none where something is wrong with it.
    std::vector<Node> read(const std::string& text) {
        const std::size_t before = problems_.size();
        int number = 0;
        for (std::size_t begin = 0; begin < text.size() && problems_.size() == before;) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            std::string_view line(text.data() + begin, end - begin);
            if (line.ends_with('\r')) line.remove_suffix(1);
            ++number, begin = end + 1;
            if (!trimmed(line).empty() && !trimmed(line).starts_with('#')) read_line(line, number);
        }
        if (problems_.size() == before && lists_.empty()) problem({0, 0}, "the file is empty", "", columns_wanted());
        return problems_.size() == before ? std::move(lists_) : std::vector<Node>{};
    }

private:
    void problem(SourceLocation at, std::string message, std::string got, std::string allowed, std::string hint = {}) {
        at.edit = file_;
        problems_.push_back(located({.code = "table.file",
                                     .path = key_.path,
                                     .message = std::move(message),
                                     .got = visible(got),
                                     .allowed = std::move(allowed),
                                     .hint = std::move(hint)},
                                    at, path_));
    }

    std::string columns_wanted() const {
        std::string text = "columns";
        for (const Key* column : columns_of(key_)) text += " " + last_name(column->path);
        return text;
    }

    void read_line(std::string_view line, int number) {
        if (lists_.empty()) {
            delimiter_ = delimiter_of(line);
            const std::vector<Cell> cells = cells_of(line, delimiter_);
            const bool has_names = !is_number(cells[0].text);
            find_columns(cells, has_names, number);
            if (has_names || lists_.empty()) return;
        }
        const std::vector<Cell> cells = cells_of(line, delimiter_);
        if (cells.size() != width_)
            return problem({number, 1}, "this line has another number of columns than the first",
                           std::to_string(cells.size()), std::to_string(width_));
        const std::size_t most = max_table_numbers / lists_.size();
        if (lists_[0].children.size() == most)
            return problem({number, 1}, "too many points", "more than " + std::to_string(most),
                           "at most " + std::to_string(max_table_numbers) + " numbers in the columns of a table",
                           "take every second point, or fewer");
        for (std::size_t i = 0; i < lists_.size(); ++i) append(lists_[i], cells[places_[i]], number);
    }

    // With the names of the first line, or, where it has numbers, in the order of the keys.
    void find_columns(const std::vector<Cell>& cells, bool has_names, int number) {
        width_ = cells.size();
        const std::vector<std::string> names = names_in(cells);
        if (!has_names && width_ > columns_of(key_).size())
            return problem({number, 1}, "cannot tell which columns are meant", counted(width_, "column"),
                           columns_wanted(), "name them in the first line");
        std::size_t place = 0;
        for (const Key* column : columns_of(key_)) {
            const std::string wanted = last_name(column->path);
            const std::size_t found = has_names ? find_name(names, wanted, number) : place++;
            if (found < cells.size()) append_list(*column, cells[found], number), places_.push_back(found);
            else if (column->unset == of_the_file)
                return lists_.clear(),
                       problem({number, 1}, "the file has no column " + wanted,
                               has_names ? listed(names) : counted(cells.size(), "column"), columns_wanted(),
                               has_names ? "name its columns so in the first line" : "");
        }
    }

    std::size_t find_name(const std::vector<std::string>& names, const std::string& wanted, int number) {
        if (std::ranges::count(names, wanted) > 1) problem({number, 1}, "two columns have one name", wanted, "");
        return static_cast<std::size_t>(std::ranges::find(names, wanted) - names.begin());
    }

    void append_list(const Key& column, const Cell& cell, int number) {
        Node list;
        list.type = Node::list;
        list.key = last_name(column.path);
        list.mark = list.key_mark = {number, cell.column, file_};
        lists_.push_back(std::move(list));
    }

    void append(Node& list, const Cell& cell, int number) {
        Node item;
        item.type = Node::scalar;
        item.text = cell.text;
        item.mark = {number, cell.column, file_};
        list.children.push_back(std::move(item));
    }

    const Key& key_;
    std::string path_;
    std::shared_ptr<const Edit> file_;
    std::vector<Problem>& problems_;
    char delimiter_ = ',';
    std::size_t width_ = 0;
    std::vector<std::size_t> places_;  // of the columns in a line
    std::vector<Node> lists_;
};

// The section above a path, in the tree; null where there is none.
Node* section_of(Node& root, const std::string& path) {
    Node* node = &root;
    const std::vector<Step> steps = parse_path(path);
    for (std::size_t i = 0; node && i + 1 < steps.size(); ++i) node = node->find(steps[i].key);
    return node;
}

// The text of a file; empty, with a problem, where it cannot be read.
std::string text_of(const std::string& path, const Key& key, const Node& name, const std::string& scenario_file,
                    std::vector<Problem>& problems) {
    const auto refuse = [&](const std::string& reason) {
        problems.push_back(
            located({.code = "table.file",
                     .path = key.path,
                     .message = "cannot be read: " + reason,
                     .got = visible(name.text),
                     .hint = is_absolute(name.text) ? "" : "a relative name counts from the folder of the scenario"},
                    name.mark, scenario_file));
        return std::string();
    };
    try {
        std::string text = read_input(path, max_bytes + 1);
        if (text.size() > max_bytes) return refuse("larger than 16 MiB");
        if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
        return text;
    } catch (const Error& error) {
        return refuse(error.problems()[0].message);
    }
}

void refuse_lists_beside(const Key& key, Node& section, const std::string& scenario_file,
                         std::vector<Problem>& problems) {
    for (const Key* column : columns_of(key))
        if (Node* given = section.find(last_name(column->path)); given && given->type != Node::unset) {
            problems.push_back(located({.code = "table.twice",
                                        .path = column->path,
                                        .message = "a list beside the file that has it",
                                        .hint = "take out `" + last_name(key.path) + "` or this list"},
                                       given->start(), scenario_file));
            given->type = Node::unset;
        }
}

}  // namespace

std::vector<const Key*> columns_of(const Key& file) {
    const std::string section = file.path.substr(0, file.path.size() - last_name(file.path).size());
    std::vector<const Key*> columns;
    for (const Key& key : schema())
        if (key.any_length && key.path == section + last_name(key.path)) columns.push_back(&key);
    return columns;
}

Node with_table_files(Node root, const std::string& scenario_file, std::vector<Problem>& problems) {
    for (const Key& key : schema()) {
        if (key.kind != Kind::file) continue;
        Node* section = section_of(root, key.path);
        const Node* name = section ? section->find(last_name(key.path)) : nullptr;
        if (!name || name->type != Node::scalar) continue;
        refuse_lists_beside(key, *section, scenario_file, problems);
        const Node given = *name;
        const std::string path = path_beside(scenario_file, given.text);
        const std::size_t before = problems.size();
        const std::string text = text_of(path, key, given, scenario_file, problems);
        if (problems.size() > before) continue;
        for (Node& list : TableReader(key, given.text, path, problems).read(text))
            section->children.push_back(std::move(list));
    }
    return root;
}

}  // namespace arm3r
