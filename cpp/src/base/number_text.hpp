#pragma once
// The one way in which text becomes a number, strict and free of the locale: [+-]digits[.digits][e[+-]digits], also .5

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace arm3r {

struct NumberRules {
    bool degrees = false;   // `VALUE deg` is VALUE*pi/180
    bool infinity = false;  // `inf` is a value
    bool whole = false;     // no fraction and no exponent
};

struct NumberFault {
    std::string code, message, hint;
};

// The number, or nothing and the reason in `fault`.
std::optional<double> read_number(std::string_view text, const NumberRules& rules, NumberFault& fault);

// A double in the shortest form that reads back to the same bits; "inf". No sign on zero.
std::string shortest(double value);

// Writes the same into a buffer of at least 32 characters; returns the end.
char* write_shortest(char* begin, double value);

}  // namespace arm3r
