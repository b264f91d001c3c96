// Random numbers without a state, (6.6): each is a function of seed, stream and counter alone, the same bits in any
// order, lane or thread. Two kinds of numbers must not share a stream: at the same counter they share their bits.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>

#include "arm3r/numbers/elementary.hpp"

namespace arm3r {

// Philox 4x32-10 of Salmon, Moraes, Dror and Shaw (2011): ten rounds of multiplication on four words of 32 bits.
constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t first = std::uint64_t{0xd2511f53} * counter[0];
        const std::uint64_t second = std::uint64_t{0xcd9e8d57} * counter[2];
        counter = {static_cast<std::uint32_t>(second >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
                   static_cast<std::uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
        key[0] += 0x9e3779b9;
        key[1] += 0xbb67ae85;
    }
    return counter;
}

// The 128 bits at a place, as two numbers: low words first, the counter's last word is 0.
constexpr std::array<std::uint64_t, 2> random_block(std::uint64_t seed, std::uint32_t stream, std::uint64_t counter) {
    const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
    const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
    const auto word = philox({low(counter), high(counter), stream, 0}, {low(seed), high(seed)});
    return {word[0] | std::uint64_t{word[1]} << 32, word[2] | std::uint64_t{word[3]} << 32};
}

constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint32_t stream, std::uint64_t counter) {
    return random_block(seed, stream, counter)[0];
}

// An odd multiple of 2^-53 from the upper 52 bits: symmetric about 1/2, never 0 or 1.
constexpr double open_unit(std::uint64_t bits) { return static_cast<double>(bits >> 11 | 1) * 0x1p-53; }

// Uniform within (0, 1).
constexpr double uniform(std::uint64_t seed, std::uint32_t stream, std::uint64_t counter) {
    return open_unit(random_bits(seed, stream, counter));
}

// A normal number of mean 0 and variance 1 from two uniform ones, at most 8.58 in size: Box and Muller (1958).
inline double box_muller(double radius, double angle) {
    return sqrt(-2.0 * log(radius)) * sincos(2.0 * std::numbers::pi * angle).cos;
}

// Normal with mean 0 and variance 1.
inline double standard_normal(std::uint64_t seed, std::uint32_t stream, std::uint64_t counter) {
    const auto [first, second] = random_block(seed, stream, counter);
    return box_muller(open_unit(first), open_unit(second));
}

}  // namespace arm3r
