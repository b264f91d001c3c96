#include "base/number_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "base/shortest_decimal.hpp"
#include "base/text.hpp"

namespace arm3r {

namespace {

constexpr double pi = 3.14159265358979323846;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t digits(std::string_view text, std::size_t at) {
    while (at < text.size() && is_digit(text[at])) ++at;
    return at;
}

// The parts of a number at the head of a text; `size` 0 where there is none.
struct Parts {
    std::size_t whole = 0, fraction = 0, exponent = 0, size = 0;  // first digit of each part; 0: no such part
};

Parts parts_of(std::string_view text) {
    Parts parts;
    std::size_t at = !text.empty() && (text[0] == '+' || text[0] == '-');
    const auto is = [&](char c) { return at < text.size() && text[at] == c; };
    const std::size_t end = digits(text, parts.whole = at);
    const bool has_whole = end > at;
    at = end;
    if (is('.') && digits(text, at + 1) > at + 1) {
        parts.fraction = at + 1;
        at = digits(text, at + 1);
    }
    if (!has_whole && parts.fraction == 0) return {};
    parts.size = at;
    if (is('e')) {
        std::size_t exponent = at + 1;
        if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
        if (digits(text, exponent) > exponent) {
            parts.exponent = at + 1;
            parts.size = digits(text, exponent);
        }
    }
    return parts;
}

std::string_view without_plus(std::string_view text) { return text.substr(text.starts_with('+')); }

bool has_nonzero_digit(std::string_view number) {
    return number.substr(0, number.find('e')).find_first_of("123456789") != number.npos;
}

// Whether |number|, known not to fit a double, is too large rather than too small.
bool is_large(std::string_view number, const Parts& parts) {
    long exponent = 0;
    if (parts.exponent) {
        const std::string_view text = without_plus(number.substr(parts.exponent));
        if (std::from_chars(text.data(), text.data() + text.size(), exponent).ec != std::errc()) return text[0] != '-';
    }
    const std::size_t first = number.find_first_of("123456789");
    const std::size_t point = parts.fraction ? parts.fraction - 1 : digits(number, parts.whole);
    return exponent + static_cast<long>(point) - static_cast<long>(first) > 0;
}

std::optional<double> convert(std::string_view number, const Parts& parts, NumberFault& fault) {
    double value = 0;
    const std::string_view plain = without_plus(number);
    const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
    const bool out_of_range = error == std::errc::result_out_of_range;
    if (!has_nonzero_digit(number)) return 0.0;
    if ((out_of_range && is_large(number, parts)) || std::isinf(value)) {
        fault = {"number.range", "out of double range", "the largest double is 1.7976931348623157e308"};
        return {};
    }
    if (out_of_range || std::abs(value) < std::numeric_limits<double>::min()) {
        fault = {"number.range", "underflows: too small for a double", "write 0, or at least 2.2250738585072014e-308"};
        return {};
    }
    return value;
}

struct Unit {
    std::string_view name;
    double divisor;
    std::string_view si;
};

constexpr Unit units[] = {
    {"mm", 1000, "m"},     {"cm", 100, "m"},      {"m", 1, "m"},           {"km", 1e-3, "m"},
    {"g", 1000, "kg"},     {"kg", 1, "kg"},       {"t", 1e-3, "kg"},       {"us", 1e6, "s"},
    {"ms", 1000, "s"},     {"s", 1, "s"},         {"sec", 1, "s"},         {"N", 1, "N"},
    {"kN", 1e-3, "N"},     {"Nm", 1, "N m"},      {"N/m", 1, "N/m"},       {"N/mm", 1e-3, "N/m"},
    {"kN/m", 1e-3, "N/m"}, {"Hz", 1, "Hz"},       {"kHz", 1e-3, "Hz"},     {"rad", 1, "rad"},
    {"m/s", 1, "m/s"},     {"mm/s", 1000, "m/s"}, {"cm/s", 100, "m/s"},    {"km/h", 3.6, "m/s"},
    {"rad/s", 1, "rad/s"}, {"m/s^2", 1, "m/s^2"}, {"kg/m^3", 1, "kg/m^3"}, {"g/cm^3", 1e-3, "kg/m^3"},
};

bool is_degrees(std::string_view unit) {
    return unit == "deg" || unit == "\u00b0" || unit == "degree" || unit == "degrees" || unit == "deg/s";
}

// What is wrong with the text of a number, and what was probably meant: `before` + `text` + `after` says it.
struct Fix {
    std::string rule;  // where no text is known that can be read
    std::string before = {}, text = {}, after = {};
};

// Of `number` followed by `unit`.
Fix unit_fix(std::string_view number, std::string_view unit, const NumberRules& rules) {
    if (is_degrees(unit)) {
        if (rules.degrees) return {"", "write ", std::string(number) + " deg"};
        return {"only joint angles, joint rates and phases can be given in degrees"};
    }
    const auto known = std::find_if(std::begin(units), std::end(units), [&](const Unit& u) { return u.name == unit; });
    NumberFault ignored;
    if (known != std::end(units) && rules.unit && known->si != *rules.unit)
        return {rules.unit->empty() ? "this number has no unit" : "its unit is " + std::string(*rules.unit)};
    if (known != std::end(units))
        if (const std::optional<double> value = convert(number, parts_of(number), ignored))
            return {"", "numbers are plain SI: write ", yaml_number(*value / known->divisor),
                    " (" + std::string(known->si) + ")"};
    constexpr std::string_view no_word = "e+-.,:_0123456789";  // e: an exponent that was not finished
    const bool is_word = !unit.empty() && no_word.find(unit[0]) == unit.npos;
    return {is_word ? "numbers are plain SI, without their unit" : ""};
}

Fix based_fix(std::string_view text) {
    const std::size_t sign = !text.empty() && (text[0] == '+' || text[0] == '-');
    if (text.size() < sign + 3 || text[sign] != '0') return {};
    const char letter = text[sign + 1];
    const int base = letter == 'x' || letter == 'X'   ? 16
                     : letter == 'o' || letter == 'O' ? 8
                     : letter == 'b' || letter == 'B' ? 2
                                                      : 0;
    long long value = 0;
    const char* end = text.data() + text.size();
    if (base == 0 || std::from_chars(text.data() + sign + 2, end, value, base).ptr != end) return {};
    return {"", "only decimal numbers: this would be ", std::string(text.substr(0, sign)) + std::to_string(value)};
}

constexpr auto digit_pairs = [] {
    std::array<char, 200> pairs{};
    for (std::size_t i = 0; i < pairs.size(); ++i)
        pairs[i] = static_cast<char>('0' + (i % 2 == 0 ? i / 20 : i / 2 % 10));
    return pairs;
}();

void write_pair(char* out, std::uint32_t below_100) { std::memcpy(out, &digit_pairs[2 * below_100], 2); }

void write_8_digits(char* out, std::uint32_t number) {
    const std::uint32_t high = number / 10000, low = number % 10000;
    write_pair(out, high / 100), write_pair(out + 2, high % 100);
    write_pair(out + 4, low / 100), write_pair(out + 6, low % 100);
}

constexpr int most_digits = 18;  // that write_decimal() takes
constexpr std::uint64_t eight_digits = 100'000'000;

int count_digits(std::uint64_t number) {
    static constexpr auto powers = [] {
        std::array<std::uint64_t, most_digits + 1> all{1};
        for (std::size_t i = 1; i < all.size(); ++i) all[i] = 10 * all[i - 1];
        return all;
    }();
    const int least = (std::bit_width(number) * 1233) >> 12;
    return least + (number >= powers[static_cast<std::size_t>(least)]);
}

// In the shorter of the two notations, as std::to_chars does: 0.00123, 1.23e-05. Pieces of fixed sizes are copied, past
// the end of what is wanted.
char* write_decimal(char* out, const ShortestDecimal& decimal) {
    char text[48] = "";  // the last digit is number 24
    const std::uint64_t leading = decimal.digits / eight_digits;
    write_pair(text + 6, static_cast<std::uint32_t>(leading / eight_digits));
    write_8_digits(text + 8, static_cast<std::uint32_t>(leading % eight_digits));
    write_8_digits(text + 16, static_cast<std::uint32_t>(decimal.digits % eight_digits));
    const int size = count_digits(decimal.digits), exponent = decimal.exponent, point = size + exponent;
    const char* const digits = text + 24 - size;
    const int point_saved = size == 1;
    if (exponent < -(size + 3) + point_saved || exponent > 5 - point_saved) {
        out[0] = digits[0], out[1] = '.';
        std::memcpy(out + 2, digits + 1, most_digits);
        out += size > 1 ? size + 1 : 1;
        out[0] = 'e', out[1] = point > 0 ? '+' : '-';
        write_pair(out + 2, static_cast<std::uint32_t>(std::abs(point - 1)));
        return out + 4;
    }
    if (exponent >= 0) {
        std::memcpy(out, digits, most_digits);
        std::memset(out + size, '0', 6);
        return out + point;
    }
    if (point <= 0) {
        std::memcpy(out, "0.0000000000000000000000", 24);
        std::memcpy(out + 2 - point, digits, most_digits);
        return out + 2 - exponent;
    }
    std::memcpy(out, digits, most_digits);
    out[point] = '.';
    std::memcpy(out + point + 1, digits + point, most_digits);
    return out + size + 1;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

// Without the zeros before its first digit; "" where there are none.
std::string without_leading_zeros(std::string_view text) {
    const std::size_t sign = text.find_first_not_of("+-"), end = digits(text, std::min(sign, text.size()));
    if (sign > 1 || end < sign + 2 || text[sign] != '0') return {};
    const std::size_t first = std::min(text.find_first_not_of('0', sign), end - 1);
    return std::string(text.substr(0, sign)) + std::string(text.substr(first));
}

bool is_no_finite_number(std::string_view text) {
    const std::size_t start = std::min(text.find_first_not_of("+-."), text.size());
    const std::string_view word = text.substr(start);
    return word == "inf" || word == "Inf" || word == "INF" || word == "nan" || word == "NaN" || word == "NAN" ||
           word == "infinity";
}

// One step from the text of a number that cannot be read towards one that can.
Fix next_fix(const std::string& text, const NumberRules& rules) {
    const std::size_t good = parts_of(text).size;
    const std::string head = text.substr(0, good), rest = text.substr(good);
    if (const Fix fix = based_fix(text); !fix.text.empty()) return fix;
    if (text.find("\u2212") != text.npos)
        return {"write the minus sign as -", "write the minus sign as -: ", replaced(text, "\u2212", "-")};
    if (is_no_finite_number(text)) return {rules.infinity ? "write inf for no limit" : "the value must be finite"};
    if (const std::string fewer = without_leading_zeros(text); !fewer.empty()) return {"", "write ", fewer};
    if (good == 0) return {};
    if (rest.empty() && rules.whole) {
        NumberFault ignored;
        const std::optional<double> value = convert(text, parts_of(text), ignored);
        const bool is_whole = value && *value == std::trunc(*value) && std::abs(*value) < 1e15;
        return {"write it without fraction and exponent", "write it without fraction and exponent: ",
                is_whole ? std::to_string(static_cast<long long>(*value)) : ""};
    }
    if (rest[0] == ',') return {"use a point", "use a point: ", head + "." + rest.substr(1)};
    if (rest[0] == '_') return {"no separators", "no separators: write ", replaced(text, "_", "")};
    if (rest[0] == ':') return {"no sexagesimal numbers"};
    if (rest == ".") return {"", "write ", head, rules.whole ? "" : " or " + text + "0"};
    if (rest[0] == 'E')
        return {"write the exponent with a small e", "write the exponent with a small e: ", replaced(text, "E", "e")};
    const std::size_t word = rest.find_first_not_of(' '), end = rest.find_last_not_of(' ');
    return unit_fix(head, word == rest.npos ? "" : std::string_view(rest).substr(word, end + 1 - word), rules);
}

std::optional<double> parse(std::string_view text, const NumberRules& rules, NumberFault& fault);

// The likely fix. A text that it names can be read: a fix that only leads to the next mistake is followed to its end.
std::string likely_fix(std::string_view text, const NumberRules& rules) {
    constexpr int most_mistakes = 8;
    Fix fix = next_fix(std::string(text), rules);
    std::string rule = fix.rule;
    for (int i = 0; i < most_mistakes && !fix.text.empty(); ++i) {
        NumberFault ignored;
        if (parse(fix.text, rules, ignored)) return fix.before + fix.text + fix.after;
        fix = next_fix(fix.text, rules);
        if (!fix.rule.empty()) rule = fix.rule;
    }
    return rule;
}

std::optional<double> refuse(std::string_view text, std::size_t good, const NumberRules& rules, NumberFault& fault) {
    fault.code = "number.syntax";
    fault.message = rules.whole ? "not a whole number" : "not a number";
    if (good > 0 && good < text.size()) {
        std::size_t end = good;
        next_code_point(text, end);
        fault.message += ": unexpected '" + std::string(text.substr(good, end - good)) + "' at character " +
                         std::to_string(count_characters(text.substr(0, good)) + 1);
    }
    return {};
}

// The number, or nothing and in `fault` what is wrong, without a hint where the text must be another.
std::optional<double> parse(std::string_view text, const NumberRules& rules, NumberFault& fault) {
    if (rules.infinity && (text == "inf" || text == "+inf" || text == "-inf"))
        return text[0] == '-' ? -HUGE_VAL : HUGE_VAL;
    const bool in_degrees = rules.degrees && text.ends_with(" deg");
    const std::string_view number = in_degrees ? trimmed(text.substr(0, text.size() - 4)) : text;
    const Parts parts = parts_of(number);
    if (parts.size == 0 || parts.size < number.size()) return refuse(text, parts.size, rules, fault);
    if (!without_leading_zeros(number).empty()) {
        fault = {"number.syntax", "a number must not start with 0", ""};
        return {};
    }
    if (rules.whole && (parts.fraction || parts.exponent)) {
        fault = {"number.whole", "must be a whole number", ""};
        return {};
    }
    const std::optional<double> value = convert(number, parts, fault);
    return value && in_degrees ? *value * pi / 180 : value;
}

}  // namespace

std::optional<double> read_number(std::string_view text, const NumberRules& rules, NumberFault& fault) {
    if (rules.quoted) text = trimmed(text);
    const std::optional<double> value = parse(text, rules, fault);
    if (!value && fault.hint.empty()) fault.hint = likely_fix(text, rules);
    if (!value || !rules.quoted) return value;
    fault = {"number.quoted", "a number has no quotes", "write " + std::string(text)};
    return {};
}

char* write_shortest(char* out, double value) {
    if (!has_shortest_decimal(value)) return std::to_chars(out, out + number_room, value == 0 ? 0.0 : value).ptr;
    *out = '-';
    out += value < 0;
    return write_decimal(out, shortest_decimal(value));
}

std::string yaml_number(std::string_view text) {
    const Parts parts = parts_of(text);
    if (parts.size != text.size() || parts.size == 0) return std::string(text);  // inf
    const std::string sign = text.starts_with('-') ? "-" : "";
    const std::size_t mantissa_end = parts.exponent ? parts.exponent - 1 : text.size();
    std::string mantissa(text.substr(parts.whole, mantissa_end - parts.whole));
    if (mantissa.starts_with('.')) mantissa = "0" + mantissa;
    if (!parts.exponent) return sign + mantissa;
    if (!parts.fraction) mantissa += ".0";
    std::string_view exponent = text.substr(parts.exponent);
    const bool is_negative = exponent.starts_with('-');
    exponent.remove_prefix(exponent.find_first_not_of("+-"));
    exponent.remove_prefix(std::min(exponent.find_first_not_of('0'), exponent.size() - 1));
    return sign + mantissa + (is_negative ? "e-" : "e+") + std::string(exponent);
}

std::string yaml_number(double value) { return yaml_number(shortest(value)); }

std::string shortest(double value) {
    char text[number_room];
    return {text, write_shortest(text, value)};
}

std::string rounded(double value, int digits) {
    char text[64];
    const double shown = value == 0 ? 0 : value;
    return {text, std::to_chars(text, text + sizeof text, shown, std::chars_format::general, digits).ptr};
}

std::string rounded(const std::array<double, 3>& values, int digits) {
    return "(" + rounded(values[0], digits) + ", " + rounded(values[1], digits) + ", " + rounded(values[2], digits) +
           ")";
}

}  // namespace arm3r
