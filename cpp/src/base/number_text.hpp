#pragma once
// The one way in which text becomes a number, strict and free of the locale: [+-]digits[.digits][e[+-]digits], also .5

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace arm3r {

struct NumberRules {
    bool degrees = false;                       // `VALUE deg` is VALUE*pi/180
    bool infinity = false;                      // `inf` is a value
    bool whole = false;                         // no fraction and no exponent
    bool quoted = false;                        // the text stands in quotes, and so is no number
    std::optional<std::string_view> unit = {};  // of the number, "" for none; not given: it is not known
};

struct NumberFault {
    std::string code, message, hint;
};

// The number, or nothing and the reason in `fault`.
std::optional<double> read_number(std::string_view text, const NumberRules& rules, NumberFault& fault);

// A double in the shortest form that reads back to the same bits; "inf". No sign on zero.
std::string shortest(double value);

// A double for people, to significant digits. No sign on zero.
std::string rounded(double value, int digits);
// "(1.5, 0, -2)"
std::string rounded(const std::array<double, 3>& values, int digits);

// The same value for a YAML file, so that readers of YAML 1.1 take it for a number too: 1.0e-9, 1.0e+6. From a text with
// the syntax above, or from a double.
std::string yaml_number(std::string_view text);
std::string yaml_number(double value);

// Writes the shortest form into a buffer of at least `number_room` characters, all of which it may change; returns the
// end. The bytes are those of std::to_chars.
inline constexpr std::size_t number_room = 64;
char* write_shortest(char* begin, double value);

}  // namespace arm3r
