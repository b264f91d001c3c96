#pragma once
// What stands at a key, read as its table says: the common part of the readers of scenarios and of sweeps.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "files/yaml_tree.hpp"
#include "schema/schema.hpp"

namespace arm3r {

inline constexpr int file_format = 1;  // of both

class KeyReader {
protected:
    KeyReader(const std::string& file, std::vector<Problem> problems) : file_(file), problems_(std::move(problems)) {}

    // The number that stands for a word, a flag or a number; empty, with a problem, where there is none.
    std::optional<double> word(const Key& key, const Node& node);
    std::optional<double> flag(const Key& key, const Node& node);
    std::optional<double> number(const Key& key, const Node& node, const std::string& path);
    // Puts what stands at a key that is no choice into the parameters. False: it is not written as the key wants it.
    bool store(const Key& key, const Node& node);
    // That a map is written for this version of its kind of file. Throws Error ARM3R_E_FORMAT where it is for another.
    void check_format(const Node& root, const std::string& kind);

    void problem(const SourceLocation& at, Problem problem);
    void wrong_shape(const Key& key, const Node& node);
    // Of a key that does not exist: "`section` belongs to shape brick; here the shape is cylinder".
    void refuse_other_choice(const Key& key, const Node& node);
    // How a key is written: "a number (m)", "a list of 3 numbers (N m)".
    std::string expected(const Key& key) const;
    // Throws Error ARM3R_E_SCENARIO with the problems in the order of the file, where there are any.
    void finish();

    double* at(const Key& key) { return params_.data() + key.offset; }

    const std::string& file_;
    std::vector<Problem> problems_;
    std::vector<double> params_;             // by the offsets of the keys; choices are looked up there
    std::set<std::string> unknown_choices_;  // paths of choices at which no word of theirs stands

private:
    bool is_number_here(const Key& key, const Node& node) const;
    bool is_list_here(const Key& key) const;
    void read_list(const Key& key, const Node& node);
    void read_column(const Key& key, const Node& list, std::size_t i);
};

}  // namespace arm3r
