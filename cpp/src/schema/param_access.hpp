#pragma once
// The flat parameters by names that are known at compile time: each name is looked up once in a process.

#include "arm3r/numbers/name.hpp"
#include "arm3r/numbers/vectors.hpp"
#include "schema/choice_words.hpp"
#include "schema/schema.hpp"

namespace arm3r {

template <Name path>
double at(std::span<const double> params, std::size_t item = 0) {
    static const std::size_t offset = known_key(path).offset;
    return params[offset + item];
}

template <Name path>
std::span<const double> list_at(std::span<const double> params) {
    static const Key& key = known_key(path);
    return list_at(params, key);
}

template <Name path>
Vec3<double> vector_at(std::span<const double> params) {
    return {at<path>(params, 0), at<path>(params, 1), at<path>(params, 2)};
}

// What the choice at `path` means.
template <Name path, class Enum>
Enum choice_at(std::span<const double> params) {
    return choice_words<Enum>[std::size_t(at<path>(params))].value;
}

// Whether the choice at `path` is `word`.
template <Name path, Name word>
bool is(std::span<const double> params) {
    static const double index = choice_index(known_key(path), word);
    return at<path>(params) == index;
}

}  // namespace arm3r
