#include "scenario/reference_docs.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/paths.hpp"
#include "scenario/scenario.hpp"
#include "schema/columns.hpp"
#include "schema/schema.hpp"

namespace arm3r {

namespace {

std::string when_text(const Key& key) {
    if (key.when_key.empty()) return "";
    const std::vector<std::string> without = words_without(key);
    if (without.empty()) return "";
    return without.size() < key.when.size() ? "not where " + key.when_key + " is " + listed(without, " or ")
                                            : "only where " + key.when_key + " is " + listed(key.when, " or ");
}

// ---- Markdown

std::string cell(const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out;
}

std::string row(const std::vector<std::string>& cells) {
    std::string out = "|";
    for (const std::string& text : cells) out += " " + cell(text) + " |";
    return out + "\n";
}

std::string table_head(const std::vector<std::string>& names) {
    std::string out = row(names) + "|";
    for (std::size_t i = 0; i < names.size(); ++i) out += "---|";
    return out + "\n";
}

// How what is said of a URDF is written.
std::string arm_file_text(const std::string& name) {
    if (name == "joints") return "three names";
    if (name == "lock") return "a map of names and angles";
    return name == "axis_tolerance" ? "an angle" : "a name";
}

std::string range_text(const Key& key) {
    if (key.kind == Kind::choice) return listed(key.choices, ", ");
    if (key.kind == Kind::flag) return "true, false";
    if (key.kind == Kind::section) return "a map";
    if (key.kind == Kind::column) return "[columns](columns.md)";
    if (key.kind == Kind::file) return "a name";
    if (key.kind == Kind::arm_file) return arm_file_text(last_name(key.path));
    std::string out = (key.bounds.open_low ? "> " : "") + yaml_number(key.bounds.low) + " to " +
                      (key.bounds.open_high ? "< " : "") + yaml_number(key.bounds.high);
    if (key.allow_infinity) out += ", inf";
    if (key.form == Form::vector_or_word) out += ", " + key.word;
    return out;
}

std::string numbers_as_text(const std::vector<double>& values) {
    std::vector<std::string> given;
    for (const double value : values)
        if (!std::isnan(value)) given.push_back(yaml_number(value));
    return given.size() == 1 ? given[0] : "[" + listed(given, ", ") + "]";
}

// The words of its choice for which a key has a default.
std::vector<std::string> words_with_default(const Key& key) {
    std::vector<std::string> words;
    std::vector<double> params = param_defaults();
    for (const std::string& word : key.when) {
        params[key.decided_by->offset] = choice_index(*key.decided_by, word);
        if (!std::isnan(default_of(key, params).front())) words.push_back(word);
    }
    return words;
}

std::string default_text(const Key& key) {
    if (key.kind == Kind::section) return "absent";
    const double first = key.fallback.front();
    if (std::isnan(first)) return key.required ? "required" : key.unset;
    const auto text = [&](const std::vector<double>& values) {
        if (key.kind == Kind::choice) return key.choices[static_cast<std::size_t>(values[0])];
        if (key.kind == Kind::flag) return std::string(values[0] != 0 ? "true" : "false");
        return numbers_as_text(values);
    };
    std::string out = text(key.fallback);
    if (key.form == Form::by_choice && key.required)
        return out + " for " + listed(words_with_default(key), " and ") + ", else required";
    for (const auto& [word, values] : key.fallback_for) out += "; " + text(values) + " for " + word;
    return key.unset.empty() ? out : out + " for explicit, else " + key.unset;
}

bool has_numbers(Kind kind) {
    return kind == Kind::number || kind == Kind::angle || kind == Kind::integer || kind == Kind::column;
}

std::string numbers_text(const Key& key) {
    switch (key.form) {
        case Form::number_or_vector: return "1 or " + std::to_string(key.size);
        case Form::by_choice: return "1, or " + std::to_string(key.size) + " for " + key.word;
        default: return has_numbers(key.kind) ? list_sizes(key) : "";
    }
}

std::string key_row(const Key& key) {
    const std::string when = when_text(key), where = when.empty() ? "" : " *" + when + "*";
    return row({"`" + key.path + "`", numbers_text(key), unit_text(key), default_text(key), range_text(key),
                source_name(static_cast<int>(key.source)), key.doc + where});
}

bool is_copy(const Key& key) { return key.unset == "as the plant"; }

const char* const markdown_head = R"(# Scenario keys

A scenario is one YAML document of at most 1 MiB. `format: 1` is required; every other key has a
default, except those marked *required*, which are needed where they exist at all. `name` (default:
the file's stem) names the run and its files.

Numbers are decimal: `[+-]digits[.digits][e[+-]digits]`, also `.5`; no quotes, no leading zeros.
They are SI and radians; where the unit says so, `VALUE deg` is VALUE*pi/180. Anchors, aliases,
tags, merge keys, duplicate keys and second documents are errors.

Other programs may read YAML 1.1, as PyYAML does: to them a number with an exponent is text unless
it has a point and a signed exponent. All files of arm3r, and all that `arm3r check`,
`arm3r template` and `to_yaml` print, have numbers such as `1.0e-9` and `1.0e+6` therefore, which
every reader takes for numbers. `30 deg` and `inf` are text to other readers.

The line `# yaml-language-server: $schema=PATH` at the head of a file tells an editor where the JSON
Schema lies: `arm3r schema` prints it, and `arm3r template` writes the line for the schema that is
installed. The editor then offers the keys that the chosen `type`, `law`, `shape` or `method` has,
shows their meaning and their defaults, and marks mistakes.

The source of a default: *lecture* says it, *inferred* follows from what the lecture says, *our
choice* is neither.

)";

const char* const markdown_tail = R"(
## What goes with what

A shape gives a link its mass, centre of mass and inertia. A slender link has no density, so `mass`
must be given. The defaults of `arm.link1`'s `mass`, `com` and `inertia_axial` hold for shape
explicit only; any other shape gives its own.

`wall.contact.stiffness` has a default for laws spring and kelvin_voigt only: that of
`wall.contact.preset` where one is named. Law diagonal needs `stiffness: [kn, k1, k2]`, and
hunt_crossley a number in N/m^p. Law kelvin_voigt takes either `damping` or `restitution`,
hunt_crossley either `dissipation` or `restitution` with `impact_speed`.

The lists of a table are equally long, and have 40 000 numbers together at most. They may stand in a
CSV file that `file` names: columns named t, s and so on in its first line, in any order and among
others, or numbers alone in that order; parted by commas, semicolons, tabs or blanks; lines with #
are remarks. Where the scenario is written out (`arm3r check`), it has the lists themselves. A batch
can vary single numbers of lists of up to 16.

At the start the tip may stand in the wall, which counts as the event `make` at that instant, but
not deeper than 0.1 m.

## Rows

The rows of a run stand at t_k = start + k*log_every while t_k < stop - 1e-9*log_every, then exactly
at stop; so start and stop always are rows. Events add none. A row at an instant at which something
jumps shows what holds after it.

`time.log_columns` chooses the columns of the log; `t` is always the first, and the others keep the
order of [columns](columns.md), however they are listed. Each has the bits that it has in the full
log, and what no chosen column needs is not computed. Summary, events, checks and warnings stay as
they are: what checks, messages and `trust` read is kept beside the log. Only `hash` and `columns`
of the summary tell of the columns that are logged. A row is judged by what is logged: a number in
it that is not finite ends the run.

## A start other than 0

`time.start` moves the beginning of a run and nothing else: rows, samples and the steps of rk4 count
from it, `initial` holds there, and the estimator begins at the later of it and `estimator.start`.
Every other instant is meant as it is written: `wall.point` is the place at t = 0, a phase is that
at t = 0, and `start` keys and tables say t, which may be negative. Where the wall's ramp or table
has begun before t = 0, `wall.point` is the place at which its s is 0. `log_every`, `solver.step` of
rk4 and the period of sampling must be at least 1e-14 of |time.start|, so that t can count them.

## --set PATH=VALUE

VALUE is YAML and takes the place of what stands at PATH; sections that are missing are made, and
`null` takes a key out. `[i]` sets one item of a list and leaves the others as they are; where a
single number may stand as well, the whole list must be given unless one stands there. A new word
for a `type`, `method`, `law` or `shape` drops the keys that belong to the old one only. All are
applied in their order, then the scenario is validated once.

## The controller's copy of the arm

`controller.model` takes the keys of `arm` except `convention` and `gravity`. A key given there is
what the controller believes; the others are as the plant.

## checks

A list of conditions on the run; one that fails makes the executable exit with 10.

| Subject | Value |
|---|---|
| `column: NAME` with `at: TIME` | the column in the row at that time, which must be a row |
| `column: NAME` with `of: min`, `max`, `max_abs`, `range` or `final` | of all rows |
| `column: NAME`, `minus: NAME` | the same of the difference, row by row |
| `event: make` or `break`, with or without `index: N` | the time of the event of this type with this index; 0, the first, without it |
| `count: make` or `break` | the number of such events |
| `summary: FIELD` | a number of the summary, e.g. `peak_force`, `steps.accepted` |

The limit is `equals: X` with `abs: A` and `rel: R` (either tolerance suffices; none: exactly), or
`below: X`, `above: X` or both. `name` is what the report calls the check. Of a run that ended
before stop, only the rows (`at`) and events that there are can be judged; every other check fails.
)";

// ---- template

void add_docs(Node& node, const std::string& path) {
    for (Node& child : node.children) add_docs(child, join(path, child.key));
    const Key* key = find_key(path);
    if (!key) return;
    const std::string unit = key->unit.empty() ? "" : unit_text(*key) + ": ";
    const std::string words = key->kind == Kind::choice ? listed(key->choices, " | ") + ". " : "";
    node.note = unit + words + key->doc;
}

}  // namespace

std::string unit_text(const Key& key) {
    return key.unit.empty() ? "" : key.kind == Kind::angle ? key.unit + ", or VALUE deg" : key.unit;
}

std::string schema_markdown() {
    std::string out = markdown_head, section;
    for (const Key& key : schema()) {
        if (is_copy(key)) continue;
        const std::string top = key.path.substr(0, key.path.find('.'));
        if (top != section)
            out += (section.empty() ? "## " : "\n## ") + top + "\n\n" +
                   table_head({"Key", "Numbers", "Unit", "Default", "Range", "Source", "Meaning"});
        section = top;
        out += key_row(key);
    }
    return out + markdown_tail;
}

std::string columns_text() {
    std::string out;
    for (const Column& column : column_table) {
        std::string line(column.name);
        line.resize(std::max<std::size_t>(line.size() + 1, 18), ' ');
        line += column.unit.empty() ? "-" : column.unit;
        line.resize(std::max<std::size_t>(line.size() + 1, 28), ' ');
        const std::string need(need_text(column.need));
        out += line + std::string(column.doc) + (need.empty() ? "" : " (" + need + ")") + "\n";
    }
    return out;
}

std::string columns_markdown() {
    std::string out =
        "# Columns of a run\n\nCSV: one header line of bare names, comma, LF. SI units, radians; no NaN.\n\n" +
        table_head({"Column", "Unit", "Meaning"});
    for (const Column& column : column_table)
        out += row({"`" + std::string(column.name) + "`", std::string(column.unit),
                    std::string(column.doc) +
                        (column.need == Need::nothing ? "" : "; *" + std::string(need_text(column.need)) + "*")});
    return out;
}

std::string scenario_template() {
    Node tree = resolve(read_scenario("format: 1\nwall: {}\nchecks: []\n", "scenario")).tree;
    std::erase_if(tree.children, [](const Node& node) { return node.key == "name"; });
    for (Node& section : tree.children) add_docs(section, section.key);
    tree.children.front().note = "version of this format; the only key that must be given";
    return "# A scenario with every default written out. Delete what you do not change.\n" + to_yaml(tree, true);
}

}  // namespace arm3r
