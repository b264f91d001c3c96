#pragma once
// The flat parameters by names that are known at compile time: each name is looked up once in a process.

#include <algorithm>

#include "arm3r/numbers/vectors.hpp"
#include "schema/schema.hpp"

namespace arm3r {

template <std::size_t N>
struct Name {
    char text[N];

    consteval Name(const char (&literal)[N]) { std::copy_n(literal, N, text); }
    constexpr operator std::string_view() const { return {text, N - 1}; }
};

template <std::size_t N, std::size_t M>
consteval Name<N + M - 1> operator+(const Name<N>& a, const char (&b)[M]) {
    char joined[N + M - 1];
    std::copy_n(b, M, std::copy_n(a.text, N - 1, joined));
    return joined;
}

template <Name path>
double at(std::span<const double> params, std::size_t item = 0) {
    static const std::size_t offset = known_key(path).offset;
    return params[offset + item];
}

template <Name path>
Vec3<double> vector_at(std::span<const double> params) {
    return {at<path>(params, 0), at<path>(params, 1), at<path>(params, 2)};
}

// Whether the choice at `path` is `word`.
template <Name path, Name word>
bool is(std::span<const double> params) {
    static const double index = choice_index(known_key(path), word);
    return at<path>(params) == index;
}

}  // namespace arm3r
