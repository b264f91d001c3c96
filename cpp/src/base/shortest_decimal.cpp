#include "base/shortest_decimal.hpp"

#include <array>
#include <bit>
#include <utility>

namespace arm3r {
namespace {

constexpr int significand_bits = 52, exponent_bias = 1075;
constexpr int powers = 78;  // of ten, from 0 on: as many as the values below need

struct Wide {
    std::uint64_t high, low;
};

constexpr std::array<std::uint64_t, 4> ten_times(std::array<std::uint64_t, 4> x) {
    unsigned __int128 carry = 0;
    for (std::uint64_t& word : x) {
        carry += static_cast<unsigned __int128>(word) * 10;
        word = static_cast<std::uint64_t>(carry);
        carry >>= 64;
    }
    return x;
}

// The 128 leading bits of an integer, rounded up.
constexpr Wide leading_bits(const std::array<std::uint64_t, 4>& x) {
    const auto bit = [&](int i) { return i >= 0 && (x[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1) != 0; };
    int top = 255;
    while (!bit(top)) --top;
    Wide g{0, 0};
    for (int i = 0; i < 64; ++i) {
        g.high = g.high << 1 | std::uint64_t{bit(top - i)};
        g.low = g.low << 1 | std::uint64_t{bit(top - 64 - i)};
    }
    bool is_exact = true;
    for (int i = top - 128; i >= 0; --i) is_exact = is_exact && !bit(i);
    if (!is_exact && ++g.low == 0) ++g.high;
    return g;
}

constexpr std::array<Wide, powers> power_table = [] {
    std::array<Wide, powers> table{};
    std::array<std::uint64_t, 4> power{1, 0, 0, 0};
    for (Wide& entry : table) {
        entry = leading_bits(power);
        power = ten_times(power);
    }
    return table;
}();

constexpr int floor_log10_of_power_of_2(int e) { return (e * 1262611) >> 22; }
constexpr int floor_log10_of_three_quarters(int e) { return (e * 1262611 - 524031) >> 22; }  // of 3/4 * 2^e
constexpr int floor_log2_of_power_of_10(int e) { return (e * 1741647) >> 19; }

// The 64 leading bits of g x, and the last one set where anything is left over.
std::uint64_t rounded_to_odd(const Wide& g, std::uint64_t x) {
    const auto low = static_cast<unsigned __int128>(g.low) * x;
    const auto sum = static_cast<unsigned __int128>(g.high) * x + static_cast<std::uint64_t>(low >> 64);
    return static_cast<std::uint64_t>(sum >> 64) | (static_cast<std::uint64_t>(sum) > 1);
}

ShortestDecimal without_trailing_zeros(std::uint64_t digits, int exponent) {
    if (digits % 10 != 0) return {digits, exponent};
    for (const auto& [divisor, zeros] : {std::pair{100000000u, 8}, {10000u, 4}, {100u, 2}, {10u, 1}})
        while (digits % divisor == 0) {
            digits /= divisor;
            exponent += zeros;
        }
    return {digits, exponent};
}

}  // namespace

ShortestDecimal shortest_decimal(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const std::uint64_t fraction = bits & ((std::uint64_t{1} << significand_bits) - 1);
    const std::uint64_t c = fraction | std::uint64_t{1} << significand_bits;
    const int q = static_cast<int>(bits >> significand_bits & 0x7FF) - exponent_bias;
    // The value is c 2^q; below a power of 2 the neighbour is nearer. In units of 10^k / 4 it is `middle`, and all
    // between `low` and `high` read back to it.
    const bool is_power_of_2 = fraction == 0;
    const int k = is_power_of_2 ? floor_log10_of_three_quarters(q) : floor_log10_of_power_of_2(q);
    const int shift = q + floor_log2_of_power_of_10(-k) + 1;
    const Wide& g = power_table[static_cast<std::size_t>(-k)];
    const std::uint64_t low = rounded_to_odd(g, (4 * c - 2 + is_power_of_2) << shift);
    const std::uint64_t middle = rounded_to_odd(g, 4 * c << shift);
    const std::uint64_t high = rounded_to_odd(g, (4 * c + 2) << shift);
    const std::uint64_t is_odd = c & 1;  // then the ends themselves do not
    const auto is_inside = [&](std::uint64_t x) { return low + is_odd <= 4 * x && 4 * x + is_odd <= high; };

    const std::uint64_t s = middle / 4, tens = s / 10;
    const bool tens_below = is_inside(10 * tens), tens_above = is_inside(10 * tens + 10);
    if (tens_below != tens_above) return without_trailing_zeros(tens + tens_above, k + 1);
    const bool below = is_inside(s), above = is_inside(s + 1);
    if (below != above) return {s + above, k};
    const std::uint64_t half = 4 * s + 2;
    return {s + (middle > half || (middle == half && (s & 1) != 0)), k};
}

}  // namespace arm3r
