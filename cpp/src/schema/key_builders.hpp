#pragma once
// The words that the lists of keys (keys_*.cpp) are written in. Each function returns the key with one property more.

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "arm3r/control/law_table.hpp"
#include "arm3r/numbers/primitives.hpp"
#include "schema/schema.hpp"

namespace arm3r {

using Words = std::vector<std::string>;

constexpr double unset = std::numeric_limits<double>::quiet_NaN();
constexpr Bounds any_position{-1e6, 1e6};
constexpr Bounds not_negative{0, 1e12};
constexpr Bounds a_length{1e-6, 1e6};
constexpr Bounds an_instant{-1e9, 1e9};
constexpr Bounds no_bounds{-1e300, 1e300};

// A key for as many numbers as it has defaults; for a word; for true or false.
Key number(std::string path, std::vector<double> fallback, Source source, Bounds bounds, std::string unit,
           std::string doc);
Key choice(std::string path, Words words, Source source, std::string doc);
Key flag(std::string path, bool fallback, std::string doc);

Key of_kind(Kind kind, Key key);
Key with_form(Form form, Key key, std::string word = {});
Key list_of(std::size_t min_size, std::size_t most, Key key);
Key table_column(std::string missing, Key key);     // of a table with two points or more, where it may come from a file
Key table_file(std::string path, std::string doc);  // the file with the columns of the table in its section
Key where(std::string when_key, Words when, Key key);  // exists where the choice at when_key is one of these words
Key needed(Key key);                                   // must be given
Key derived(std::string unset_means, Key key);         // what it means where it is not given
Key or_infinite(Key key);
Key but(std::map<std::string, std::vector<double>> fallback_for, Key key);  // with a default of its own for some laws

// A key, or several, that exist for these laws only.
Key for_laws(Words which, Key key);
void append_for_laws(std::vector<Key>& keys, const Words& which, std::vector<Key> some);

// The words of the laws of which `holds` is true.
template <class Holds>
Words laws_that(Holds holds) {
    Words words;
    for (const LawProperties& law : law_table)
        if (holds(law)) words.emplace_back(law.word);
    return words;
}
inline Words of_force() {
    return laws_that([](const LawProperties& law) { return law.takes_force; });
}

}  // namespace arm3r
