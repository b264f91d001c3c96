#include "base/text.hpp"
#include "record/metrics.hpp"
#include "scenario/sweep.hpp"
#include "schema/columns.hpp"
#include "schema/key_builders.hpp"

namespace arm3r {
namespace {

Key special(std::string path, std::string written, std::string doc, std::size_t size = 1) {
    Key key = number(std::move(path), std::vector(size, unset), Source::ours, no_bounds, "", std::move(doc));
    return with_form(Form::fixed, of_kind(Kind::special, std::move(key)), std::move(written));
}

Key whole(std::string path, double fallback, Bounds bounds, std::string doc) {
    return of_kind(Kind::integer, number(std::move(path), {fallback}, Source::ours, bounds, "", std::move(doc)));
}

// A choice without a default; `what`: its words where they are very many.
Key given(std::string path, Words words, std::string what, std::string doc) {
    Key key = choice(std::move(path), std::move(words), Source::ours, std::move(doc));
    key.fallback = {unset};
    return needed(with_form(Form::fixed, std::move(key), std::move(what)));
}

// The keys of a scenario that have values, and their single numbers.
Words places() {
    Words names;
    for (const Key& key : schema())
        if (key.kind != Kind::section && key.kind != Kind::column) names.push_back(key.path);
    for (std::size_t i = 0; i < param_count(); ++i)
        if (key_at(i).size > 1 && key_at(i).kind != Kind::column) names.push_back(param_name(i));
    return names;
}

template <class Table>
Words names_in(const Table& table) {
    Words names;
    for (const auto& column : table) names.emplace_back(column.name);
    return names;
}

Key metrics() {
    Key key = list_of(1, summary_table().size(),
                      number("metrics", {unset}, Source::ours, no_bounds, "",
                             "Columns of the summary that are kept, besides the outcome. Default: all."));
    key.choices = names_in(summary_table());
    return of_kind(Kind::column, std::move(key));
}

std::vector<Key> make_keys() {
    const Words drawing = {"random", "latin_hypercube"};
    const Words numbers = {"max", "min", "mean", "final", "range", "max_abs"};
    const std::string space = "[from, to, count]";
    std::vector<Key> keys = {
        needed(special("format", "1", "The version of this format: 1.")),
        needed(special("scenario", "the name of a file, or the keys of a scenario",
                       "A file, relative to this one, or a scenario as a map.")),
        special("set", "a map of values by path",
                "Values by path, put into the scenario; then those of `--set PATH=VALUE`."),
        choice("mode", {"grid", "list", "random", "latin_hypercube"}, Source::ours,
               "`grid`: every combination, the last axis varies fastest; `list`: the first values of all axes, then "
               "the second ones; `random`; `latin_hypercube`."),
        needed(special("axes", "a list such as [{key: wall.contact.stiffness, geomspace: [1.0e+2, 1.0e+6, 40]}]",
                       "What varies: a `key`, and one of the rules.")),
        given("axes.key", places(), "keys of a scenario that can vary, no sections",
              "A key of the scenario, or one of its numbers."),
        special("axes.values", "a list of values",
                "`[...]`: these numbers, words, true and false, or lists if the key takes several numbers."),
        special("axes.linspace", space + " of finite numbers",
                "`[a, b, n]`: n numbers from a to b, with equal differences.", 3),
        special("axes.geomspace", space + " of numbers above 0",
                "`[a, b, n]`: n numbers from a to b, with equal ratios.", 3),
        where("mode", drawing,
              special("axes.uniform", "[from, to], the smaller number first",
                      "`[a, b]`: random, with equal probability from a to b.", 2)),
        where("mode", drawing,
              special("axes.log_uniform", "[from, to], numbers above 0, the smaller one first",
                      "`[a, b]`: random, the logarithm with equal probability.", 2)),
        where("mode", drawing,
              special("axes.normal", "[mean, deviation], the deviation above 0",
                      "`[mean, deviation]`: random, of a normal distribution.", 2)),
        where("mode", drawing,
              needed(whole("runs", unset, {1, 1e10}, "How many runs, in `random` and `latin_hypercube`."))),
        whole("seed", 1, {0, 9007199254740991}, "Seed of the random values."),
        metrics(),
        special("statistics", "a list such as [{column: depth, of: max}]",
                "`{column, of}`: " + listed(numbers) + " of a column of the run; `mean` is that of the rows."),
        given("statistics.column", names_in(column_table), "names that `arm3r columns` lists", "A column of the run."),
        given("statistics.of", numbers, "", "Which number of the column."),
        whole("shard", 1000, {1, 1e6},
              "Number of runs in one job; a worker holds them in memory, and if that is too little the sweep ends "
              "(exit 5).")};
    connect(keys);
    return keys;
}

}  // namespace

const std::vector<Key>& sweep_keys() {
    static const std::vector<Key> keys = make_keys();
    return keys;
}

}  // namespace arm3r
