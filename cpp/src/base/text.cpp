#include "base/text.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"

namespace arm3r {

namespace {

std::string hex(std::uint32_t value, int digits) {
    std::string out;
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += "0123456789abcdef"[value >> shift & 15];
    return out;
}

std::string escape(std::int32_t code_point) {
    switch (code_point) {
        case '\n': return "\\n";
        case '\r': return "\\r";
        case '\t': return "\\t";
        default: return "\\u" + hex(static_cast<std::uint32_t>(code_point), 4);
    }
}

}  // namespace

std::int32_t next_code_point(std::string_view text, std::size_t& at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(at);
    if (first < 0x80) return ++at, static_cast<std::int32_t>(first);
    const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || at + size > text.size()) return -1;
    std::int32_t code_point = static_cast<std::int32_t>(first & (0x7Fu >> size));
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(at + i) & 0xC0) != 0x80) return -1;
        code_point = code_point << 6 | (byte(at + i) & 0x3F);
    }
    const bool overlong = code_point < (size == 2 ? 0x80 : size == 3 ? 0x800 : 0x10000);
    const bool surrogate = code_point >= 0xD800 && code_point <= 0xDFFF;
    if (overlong || surrogate || code_point > 0x10FFFF) return -1;
    at += size;
    return code_point;
}

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();)
        if (next_code_point(text, at) < 0) return false;
    return true;
}

std::size_t count_characters(std::string_view text) {
    std::size_t count = 0;
    for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    return count;
}

bool is_control(std::int32_t c) { return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x2028 || c == 0x2029; }

bool is_bidi_control(std::int32_t c) {
    return c == 0x061C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t begin = at;
        const std::int32_t c = next_code_point(text, at);
        if (c < 0) {
            out += "\\ufffd";
            ++at;
        } else if (c == '"' || c == '\\') {
            (out += '\\') += static_cast<char>(c);
        } else if (is_control(c)) {
            out += escape(c);
        } else {
            out += text.substr(begin, at - begin);
        }
    }
    return out += '"';
}

std::string json_number(double value) {
    if (std::isnan(value)) return "null";
    if (std::isinf(value)) return value > 0 ? "\"inf\"" : "\"-inf\"";
    return shortest(value);
}

std::string visible(std::string_view text, std::size_t limit) {
    std::string out;
    std::size_t count = 0;
    for (std::size_t at = 0; at < text.size(); ++count) {
        if (count == limit) return out += "...";
        const std::size_t begin = at;
        const std::int32_t c = next_code_point(text, at);
        if (c < 0) out += "\\x" + hex(static_cast<unsigned char>(text[at++]), 2);
        else if (is_control(c) || is_bidi_control(c)) out += escape(c);
        else out += text.substr(begin, at - begin);
    }
    return out;
}

std::string counted(std::size_t count, std::string_view what) {
    return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

std::string_view trimmed(std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    return text;
}

std::string listed(const std::vector<std::string>& words, std::string_view between) {
    std::string out;
    for (const std::string& word : words) (out += out.empty() ? "" : between) += word;
    return out;
}

bool is_in(const std::vector<std::string>& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace arm3r
