#pragma once
// The one table of everything a scenario can say. Parsing, defaults, provenance, validation, suggestions, parameter
// indices, JSON Schema and the reference page are all read from it. It knows neither YAML nor files.

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace arm3r {

enum class Kind {
    number,    // a real number
    angle,     // a real number, rad; `VALUE deg` allowed
    integer,   // a whole number
    flag,      // true | false
    choice,    // one word of `choices`
    section,   // a map that may be absent; the parameter is 1 where it is present (only `wall`)
    column,    // the name of a column of a run; one word of `choices`
    file,      // the name of a file with lists of the section; its number is NaN, the lists are those of the file
    arm_file,  // what is said of arm.urdf; its number is NaN, the keys are those of the file
    special,   // of a sweep: what its reader reads itself; `word` says how it is written
};

const char* kind_name(Kind kind);

inline constexpr const char* of_the_file = "the file's";  // `unset` of a list that a table needs

enum class Source { lecture, inferred, ours };  // where a default comes from

// How the `size` numbers of a key may be written.
enum class Form {
    fixed,             // size 1: a number; size > 1: a list of exactly `size`
    number_or_vector,  // one number, stored as (x, NaN, NaN), or a list of 3
    vector_or_word,    // a list of `size`, or `word`, which stores +inf in every place
    by_choice,         // stored like number_or_vector; the choice at when_key decides: `word` takes a list of 3, any
                       // other one number
    list,              // a list of `min_size` to `size`, with NaN after its end; may be longer if `any_length`
};

struct Bounds {
    double low, high;
    bool open_low = false, open_high = false;
};

struct Key {
    std::string path;  // dotted, "arm.link2.mass"
    Kind kind;
    std::size_t size;  // doubles it takes in the flat array
    Form form;
    std::vector<double> fallback;  // default; NaN: not given (derived, or as `unset` says)
    Source source;
    Bounds bounds;  // of each number; inf as a value only with allow_infinity
    bool allow_infinity = false;
    std::string unit;  // "m", "N m s/rad"; "" for none
    std::string doc;   // one sentence
    std::vector<std::string> choices = {};
    std::map<std::string, std::vector<double>> fallback_for = {};  // by the choice at when_key, where it differs
    std::string word = {};               // for vector_or_word: "infinite"; for by_choice: that which takes a list;
                                         // for a choice or columns: what messages call very many words
    std::size_t min_size = 0;            // for list
    bool any_length = false;             // for list
    std::string when_key = {};           // the key exists only where the choice at this path ...
    std::vector<std::string> when = {};  // ... is one of these words
    bool required = false;               // must be given (where it exists at all)
    std::string unset = {};              // what NaN means: "length/2", "as the plant"
    std::size_t offset = 0;              // first index in the flat array; this and the next two: filled by schema()
    const Key* decided_by = nullptr;     // the key at when_key
    const Key* plant = nullptr;          // of a key of controller.model: the plant's
};

// Of a whole table: fills in the offsets, and the choices that decide.
void connect(std::vector<Key>& keys);

// Every key, in the order of the reference page. `name` (text), `format` and `checks` are the reader's own.
const std::vector<Key>& schema();
const Key* find_key(std::string_view path);
const Key& known_key(std::string_view path);  // for paths that are written in the code
std::size_t param_count();
const Key& key_at(std::size_t index);            // the key whose number has this index in the flat array
std::string param_name(std::size_t index);       // "initial.q[1]"
std::size_t param_index(std::string_view name);  // throws Error ARM3R_E_INDEX, with the nearest right name
std::vector<double> param_defaults();

// The default of one key, given the choices that stand in `params` (keys are in such an order that a choice precedes
// what depends on it). Beside fallback_for three defaults depend on choices: initial.q on arm.convention, links on shapes
// and arm.model, the wall's stiffness on its law and preset.
std::vector<double> default_of(const Key& key, std::span<const double> params);

double param(std::span<const double> params, std::string_view path, std::size_t item = 0);

// ---- lists of any length
//
// A list that is longer than the `size` of its key stands behind the flat array: the offset of the key, the number of
// numbers, the numbers; the places of the key hold NaN then.

// In all lists of a table, so that a scenario with them can be read again; and in one of them: there are two or more.
inline constexpr std::size_t max_table_numbers = 40'000, max_list_length = max_table_numbers / 2;

// The numbers of a list, wherever they stand.
std::span<const double> list_at(std::span<const double> params, const Key& key);
// Puts a list of n NaN behind the flat array.
std::span<double> append_list(std::vector<double>& params, const Key& key, std::size_t n);
// Whether there can be so many numbers: none behind the flat array, or enough for a list, and not too many.
bool is_param_count(std::size_t count);
// Whether what stands behind the flat array are such lists and nothing else.
bool has_whole_lists(std::span<const double> params);

// The word stored for a choice (one that is not given in controller.model is the plant's), the number that stands for a
// word, and whether the key exists for the choices made in `params`.
const std::string& choice_of(std::span<const double> params, const Key& key);
const std::string& choice_of(std::span<const double> params, std::string_view path);
double choice_index(const Key& key, std::string_view word);
bool key_exists(const Key& key, std::span<const double> params);

// Of a key that does not exist: itself, or the choice above it that does not exist because of the choice at its when_key.
const Key& key_refused(const Key& key, std::span<const double> params);

// How many numbers its list may have: "3", "2 to 16", or "2 or more"; and whether the choices made in
// `params` let a by_choice key take a list.
std::string list_sizes(const Key& key);
bool takes_list(const Key& key, std::span<const double> params);

// The words of the choice that decides on a key for which there is no such key.
std::vector<std::string> words_without(const Key& key);

}  // namespace arm3r
