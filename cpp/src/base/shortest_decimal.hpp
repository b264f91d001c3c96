#pragma once
// The shortest decimal digits that read back to a double, for the sizes that occur in a log; Giulietti, "The Schubfach
// way to render doubles", 2020.

#include <cmath>
#include <cstdint>

namespace arm3r {

// value = digits * 10^exponent; the last digit is not 0.
struct ShortestDecimal {
    std::uint64_t digits;
    int exponent;
};

// Whether shortest_decimal() takes a value.
inline bool has_shortest_decimal(double value) {
    const double size = std::abs(value);
    return size >= 0x1p-200 && size < 0x1p50;
}

// Of |value|: of all decimals that read back to the same bits, one of the fewest digits, and of these the nearest.
ShortestDecimal shortest_decimal(double value);

}  // namespace arm3r
