#pragma once
// Text as the outside sees it: UTF-8 checked, quoted for JSON, made harmless for a terminal.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace arm3r {

// The code point at `at`, which moves behind it; -1 where the bytes are not UTF-8 (then `at` stays).
std::int32_t next_code_point(std::string_view text, std::size_t& at);
bool is_utf8(std::string_view text);
std::size_t count_characters(std::string_view text);

// Code points that change how the text around them is displayed, or that a terminal obeys.
bool is_control(std::int32_t code_point);
bool is_bidi_control(std::int32_t code_point);

std::string json_string(std::string_view text);  // with its quotes
std::string json_number(double value);           // NaN: null, infinity: "inf"

// For messages: control characters escaped, at most `limit` characters.
std::string visible(std::string_view text, std::size_t limit = 80);

// "1 item", "2 items"
std::string counted(std::size_t count, std::string_view what);

std::string_view trimmed(std::string_view text);  // without blanks at its ends

// "a, b, c"
std::string listed(const std::vector<std::string>& words, std::string_view between = ", ");

bool is_in(const std::vector<std::string>& words, std::string_view word);

}  // namespace arm3r
