#include "results/checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "files/paths.hpp"
#include "results/report.hpp"
#include "schema/columns.hpp"
#include "schema/schema.hpp"

namespace arm3r {

namespace {

using Words = std::vector<std::string>;

const Words subjects = {"column", "event", "count", "summary"};  // in the order of Check::Subject
const Words event_types = {"make", "break"};                     // in the order of Event::Type
const Words reductions = {"min", "max", "max_abs", "range", "final"};
const Words limits = {"equals", "abs", "rel", "below", "above"};

Words keys_of(Check::Subject subject) {
    Words keys = {"name", subjects[subject]};
    if (subject == Check::column) keys.insert(keys.end(), {"minus", "at", "of"});
    if (subject == Check::event) keys.push_back("index");
    keys.insert(keys.end(), limits.begin(), limits.end());
    return keys;
}

Words names_of(std::span<const std::size_t> columns) {
    Words names;
    for (const std::size_t column : columns) names.emplace_back(column_table[column].name);
    return names;
}

// Columns that differ in their last letter only, as one word: "q1..q3", "tip_x..tip_z".
Words in_short(const Words& names) {
    const auto stem = [](const std::string& name) { return std::string_view(name).substr(0, name.size() - 1); };
    Words words;
    for (std::size_t first = 0, end; first < names.size(); first = end) {
        end = first + 1;
        while (end < names.size() && names[end].size() > 1 && stem(names[end]) == stem(names[first])) ++end;
        words.push_back(end > first + 1 ? names[first] + ".." + names[end - 1] : names[first]);
    }
    return words;
}

class CheckReader {
public:
    CheckReader(const Node& node, std::string path, std::span<const double> params,
                std::span<const std::size_t> columns, const std::string& file, std::vector<Problem>& problems)
        : node_(node), path_(std::move(path)), params_(params), columns_(columns), file_(file), problems_(problems) {}

    Check read() {
        Check check;
        if (!read_subject(check)) return check;
        refuse_unknown_keys(check.subject);
        read_what(check);
        read_limits(check);
        read_name(check);
        return check;
    }

private:
    void problem(const SourceLocation& at, std::string_view key, std::string code, std::string message,
                 std::string got = {}, std::string allowed = {}, std::string hint = {}) {
        problems_.push_back(located({.code = "check." + std::move(code),
                                     .path = key.empty() ? path_ : join(path_, key),
                                     .message = std::move(message),
                                     .got = std::move(got),
                                     .allowed = std::move(allowed),
                                     .hint = std::move(hint)},
                                    at, file_));
    }

    bool read_subject(Check& check) {
        if (node_.type != Node::map) {
            problem(node_.mark, "", "type", "a check is a map", node_text(node_), "",
                    "{name: ..., column: tip_x, at: 10, equals: 1, abs: 1e-6}");
            return false;
        }
        Words found;
        for (std::size_t i = 0; i < subjects.size(); ++i) {
            if (!node_.find(subjects[i])) continue;
            check.subject = static_cast<Check::Subject>(i);
            found.push_back(subjects[i]);
        }
        if (found.size() == 1) return true;
        if (found.size() > 1) {
            problem(node_.mark, "", "subject", "only one subject may stand in a check", listed(found, " and "), "",
                    "make a check of each");
            return false;
        }
        std::string hint;
        for (const Node& child : node_.children)
            if (hint.empty() && !is_in(limits, child.key) && child.key != "name")
                hint = did_you_mean(child.key, subjects);
        problem(node_.mark, "", "subject", "a check needs a subject", "", "one of " + listed(subjects), hint);
        return false;
    }

    void refuse_unknown_keys(Check::Subject subject) {
        const Words keys = keys_of(subject);
        for (const Node& child : node_.children)
            if (!is_in(keys, child.key))
                problem(child.key_mark, child.key, "unknown_key",
                        "a check with `" + subjects[subject] + "` has no such key", "", listed(keys),
                        did_you_mean(child.key, keys));
    }

    std::string word(const std::string& key, const Words& words, std::string code) {
        const Node* node = node_.find(key);
        if (!node || node->type == Node::unset) return {};
        if (node->type == Node::scalar && is_in(words, node->text)) return node->text;
        problem(node->mark, key, std::move(code), "must be one of the words", node_text(*node), listed(in_short(words)),
                did_you_mean(node->text, words));
        return {};
    }

    std::optional<double> number(const std::string& key, bool whole = false) {
        const Node* node = node_.find(key);
        if (!node || node->type == Node::unset) return {};
        NumberFault fault{"number.type", "expects a number", ""};
        if (node->type == Node::scalar)
            if (const auto value = read_number(node->text, {.whole = whole, .quoted = node->quoted}, fault))
                return value;
        problems_.push_back(located({.code = fault.code,
                                     .path = join(path_, key),
                                     .message = fault.message,
                                     .got = node_text(*node),
                                     .hint = fault.hint},
                                    node->mark, file_));
        return {};
    }

    void read_what(Check& check) {
        const std::string& subject = subjects[check.subject];
        if (check.subject == Check::column) {
            check.what = column("column");
            if (node_.find("minus")) check.minus = column("minus");
            read_row(check);
        } else if (check.subject == Check::summary) {
            check.what = word(subject, summary_number_names(), "field");
        } else {
            check.what = word(subject, event_types, "event");
            const double index = number("index", true).value_or(0);
            if (index < 0 || index > 4096)
                problem(node_.find("index")->mark, "index", "index", "must be 0 or more", shortest(index));
            else check.index = static_cast<std::size_t>(index);
        }
    }

    std::string column(const std::string& key) {
        const Words here = names_of(columns_);
        const Node* node = node_.find(key);
        const auto elsewhere = std::ranges::find_if(column_table, [&](const Column& c) {
            return node->type == Node::scalar && c.name == node->text && !is_in(here, node->text);
        });
        if (elsewhere == column_table.end()) return word(key, here, "column");
        problem(node->mark, key, "column",
                "this run has no such column; it is there " + std::string(need_text(elsewhere->need)), node->text,
                listed(in_short(here)), std::string(need_hint(elsewhere->need)) + ", or take the check out");
        return {};
    }

    void read_row(Check& check) {
        check.of = word("of", reductions, "of");
        const Node* at = node_.find("at");
        if (bool(at) == bool(node_.find("of")))
            return problem(node_.mark, "", "row", at ? "has both `at` and `of`" : "needs `at` or `of`", "",
                           "at: TIME, or of: " + listed(reductions));
        if (const auto time = number("at")) {
            check.at = *time;
            if (!is_row(*time))
                problem(at->mark, "at", "at", "no row is logged at this time", shortest(*time),
                        "time.start + k*time.log_every, or time.stop = " + shortest(param(params_, "time.stop")));
        }
    }

    bool is_row(double time) const {
        const double every = param(params_, "time.log_every"), stop = param(params_, "time.stop"),
                     start = param(params_, "time.start");
        const double nearest_row = start + std::round((time - start) / every) * every;
        const double slack = 1e-9 * every;
        return time == stop || (time >= start && nearest_row < stop - slack && std::abs(time - nearest_row) <= slack);
    }

    void read_limits(Check& check) {
        check.equals = number("equals");
        check.below = number("below");
        check.above = number("above");
        check.abs = tolerance("abs");
        check.rel = tolerance("rel");
        const bool has_equals = node_.find("equals"), has_range = node_.find("below") || node_.find("above");
        if (has_equals == has_range)
            problem(node_.mark, "", "limit", has_equals ? "has `equals` and `below` or `above`" : "needs a limit", "",
                    "equals (with abs, rel), or below, above");
        if (check.above && check.below && *check.above >= *check.below)
            problem(node_.find("below")->mark, "below", "limit",
                    "no value is above " + shortest(*check.above) + " and below " + shortest(*check.below), "", "",
                    "exchange the two, or make two checks");
        for (const char* key : {"abs", "rel"})
            if (const Node* node = node_.find(key); node && !has_equals)
                problem(node->key_mark, key, "limit", "a tolerance goes with `equals`");
    }

    double tolerance(const std::string& key) {
        const double value = number(key).value_or(0);
        if (value < 0) problem(node_.find(key)->mark, key, "tolerance", "must not be negative", shortest(value));
        return value;
    }

    void read_name(Check& check) {
        const Node* node = node_.find("name");
        if (node && node->type == Node::scalar && !node->text.empty()) check.name = node->text;
        else if (node && node->type != Node::unset)
            problem(node->mark, "name", "name", "must be a text", node_text(*node));
        else check.name = subject_text(check);
    }

    static std::string subject_text(const Check& check) {
        const std::string minus = check.minus.empty() ? "" : " - " + check.minus;
        switch (check.subject) {
            case Check::column:
                return check.what + minus + (check.of.empty() ? " at " + shortest(check.at) : ", " + check.of);
            case Check::event: return "time of " + check.what + " " + std::to_string(check.index);
            case Check::count: return "number of " + check.what + " events";
            default: return check.what;
        }
    }

    const Node& node_;
    std::string path_;
    std::span<const double> params_;
    std::span<const std::size_t> columns_;
    const std::string& file_;
    std::vector<Problem>& problems_;
};

// ---- evaluation

struct Measured {
    std::optional<double> value;
    std::string reason;
};

std::optional<std::size_t> index_of(std::string_view name) {
    const auto found = std::ranges::find(column_table, name, &Column::name);
    if (found == column_table.end()) return {};
    return static_cast<std::size_t>(found - column_table.begin());
}

std::span<const double> column_of(const Run& run, const std::string& name) { return run.find(*index_of(name)); }

double reduce(const std::string& of, const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (of == "min") return *low;
    if (of == "max") return *high;
    if (of == "max_abs") return std::max(std::abs(*low), std::abs(*high));
    if (of == "range") return *high - *low;
    return values.back();
}

std::vector<double> values_of(const Check& check, const Run& run) {
    const std::span<const double> column = column_of(run, check.what);
    std::vector<double> values(column.begin(), column.end());
    if (!check.minus.empty()) {
        const std::span<const double> minus = column_of(run, check.minus);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] -= minus[i];
    }
    return values;
}

std::string ended_text(const Run& run) { return "the run ended at t = " + shortest(run.t_end) + " s"; }

Measured measure_column(const Check& check, const Run& run, double log_every) {
    const std::vector<double> values = values_of(check, run);
    if (values.empty()) return {{}, "the run has no rows"};
    if (!check.of.empty()) return {reduce(check.of, values), ""};
    const std::span<const double> t = column_of(run, "t");
    const auto row = std::lower_bound(t.begin(), t.end(), check.at - 1e-9 * log_every);
    if (row == t.end() || *row - check.at > 1e-9 * log_every)
        return {{}, "no row at t = " + shortest(check.at) + " s; " + ended_text(run)};
    return {values[static_cast<std::size_t>(row - t.begin())], ""};
}

std::vector<double> event_times(const Run& run, const std::string& type) {
    std::vector<double> times;
    for (const Event& event : run.events)
        if (event_types[event.type] == type) times.push_back(event.t);
    return times;
}

// Whether the check needs the whole run.
bool needs_all(const Check& check) {
    return check.subject == Check::column ? !check.of.empty() : check.subject != Check::event;
}

Measured measure(const Check& check, const Run& run, std::span<const double> params) {
    if (needs_all(check) && run.t_end < param(params, "time.stop")) return {{}, ended_text(run)};
    if (check.subject == Check::column) return measure_column(check, run, param(params, "time.log_every"));
    if (check.subject == Check::summary) return {summary_number(run, check.what), ""};
    const std::vector<double> times = event_times(run, check.what);
    if (check.subject == Check::count) return {static_cast<double>(times.size()), ""};
    if (check.index < times.size()) return {times[check.index], ""};
    return {{}, (times.size() == 1 ? "there was " : "there were ") + counted(times.size(), check.what + " event")};
}

std::string limit_text(const Check& check) {
    std::string out;
    const auto add = [&](const char* word, double value) {
        out += (out.empty() ? "" : ", ") + std::string(word) + shortest(value);
    };
    if (check.equals) {
        add("equals ", *check.equals);
        if (check.abs > 0) add("abs ", check.abs);
        if (check.rel > 0) add("rel ", check.rel);
    }
    if (check.above) add("above ", *check.above);
    if (check.below) add("below ", *check.below);
    return out;
}

bool holds(const Check& check, double value) {
    if (check.equals) {
        const double off = std::abs(value - *check.equals);
        return off <= check.abs || off <= check.rel * std::abs(*check.equals);
    }
    return (!check.below || value < *check.below) && (!check.above || value > *check.above);
}

CheckResult evaluate_one(const Check& check, const Run& run, std::span<const double> params) {
    const Measured measured = measure(check, run, params);
    CheckResult result{.name = check.name,
                       .passed = measured.value && holds(check, *measured.value),
                       .value = measured.value,
                       .limit = limit_text(check),
                       .deviation = {},
                       .reason = measured.reason};
    if (measured.value && check.equals) result.deviation = std::abs(*measured.value - *check.equals);
    return result;
}

}  // namespace

std::vector<CheckForm> check_forms() {
    std::vector<CheckForm> forms;
    for (std::size_t i = 0; i < subjects.size(); ++i)
        forms.push_back({subjects[i], keys_of(static_cast<Check::Subject>(i))});
    return forms;
}

Words words_of_check(std::string_view key) {
    if (key == "event" || key == "count") return event_types;
    if (key == "of") return reductions;
    return key == "summary" ? summary_number_names() : Words{};
}

std::vector<Check> read_checks(const Node& list, std::span<const double> params, std::span<const std::size_t> columns,
                               const std::string& file, std::vector<Problem>& problems) {
    std::vector<Check> checks;
    if (list.type != Node::list && list.type != Node::unset)
        problems.push_back(located({.code = "check.type",
                                    .path = "checks",
                                    .message = "expects a list of checks",
                                    .got = node_text(list),
                                    .hint = "checks: [{name: ..., column: tip_x, at: 10, equals: 1, abs: 1e-6}]"},
                                   list.mark, file));
    if (list.type != Node::list) return checks;
    for (std::size_t i = 0; i < list.children.size(); ++i)
        checks.push_back(CheckReader(list.children[i], item("checks", i), params, columns, file, problems).read());
    return checks;
}

ColumnSet columns_in(const std::vector<Check>& checks) {
    ColumnSet columns;
    for (const Check& check : checks) {
        if (check.subject != Check::column) continue;
        for (const std::string* name : {&check.what, &check.minus})
            if (const auto index = index_of(*name)) columns.set(*index);
    }
    return columns;
}

std::vector<CheckResult> evaluate(const std::vector<Check>& checks, const Run& run, std::span<const double> params) {
    std::vector<CheckResult> results;
    for (const Check& check : checks) results.push_back(evaluate_one(check, run, params));
    return results;
}

}  // namespace arm3r
