#pragma once
// A name as a template argument, such as the key of a number.

#include <algorithm>
#include <cstddef>
#include <string_view>

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

}  // namespace arm3r
