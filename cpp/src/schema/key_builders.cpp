#include "schema/key_builders.hpp"

namespace arm3r {

Key number(std::string path, std::vector<double> fallback, Source source, Bounds bounds, std::string unit,
           std::string doc) {
    const std::size_t size = fallback.size();
    return {.path = std::move(path),
            .kind = Kind::number,
            .size = size,
            .form = Form::fixed,
            .fallback = std::move(fallback),
            .source = source,
            .bounds = bounds,
            .unit = std::move(unit),
            .doc = std::move(doc)};
}

Key choice(std::string path, Words words, Source source, std::string doc) {
    return {.path = std::move(path),
            .kind = Kind::choice,
            .size = 1,
            .form = Form::fixed,
            .fallback = {0},
            .source = source,
            .bounds = no_bounds,
            .unit = "",
            .doc = std::move(doc),
            .choices = std::move(words)};
}

Key of_kind(Kind kind, Key key) {
    key.kind = kind;
    return key;
}

Key with_form(Form form, Key key, std::string word) {
    key.form = form;
    key.word = std::move(word);
    return key;
}

Key list_of(std::size_t min_size, std::size_t most, Key key) {
    key.form = Form::list;
    key.size = most;
    key.min_size = min_size;
    key.fallback.assign(most, unset);
    return key;
}

Key table_column(std::string missing, Key key) {
    constexpr std::size_t places = 16;  // of a table of which single numbers can be varied
    key = derived(std::move(missing), list_of(2, places, std::move(key)));
    key.any_length = true;
    return key;
}

Key table_file(std::string path, std::string doc) {
    return derived("the lists given here",
                   of_kind(Kind::file, number(std::move(path), {unset}, Source::ours, no_bounds, "", std::move(doc))));
}

Key where(std::string when_key, Words when, Key key) {
    key.when_key = std::move(when_key);
    key.when = std::move(when);
    return key;
}

Key needed(Key key) {
    key.required = true;
    return key;
}

Key derived(std::string unset_means, Key key) {
    key.unset = std::move(unset_means);
    return key;
}

Key or_infinite(Key key) {
    key.allow_infinity = true;
    return key;
}

Key flag(std::string path, bool fallback, std::string doc) {
    return of_kind(Kind::flag,
                   number(std::move(path), {double(fallback)}, Source::ours, no_bounds, "", std::move(doc)));
}

Key for_laws(Words which, Key key) { return where("controller.type", std::move(which), std::move(key)); }

void append_for_laws(std::vector<Key>& keys, const Words& which, std::vector<Key> some) {
    for (Key& key : some) keys.push_back(key.when_key.empty() ? for_laws(which, std::move(key)) : std::move(key));
}

Key but(std::map<std::string, std::vector<double>> fallback_for, Key key) {
    key.fallback_for = std::move(fallback_for);
    return key;
}

}  // namespace arm3r
