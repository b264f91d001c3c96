#pragma once
// The latest values of a quantity, by the number of their sample.

#include <algorithm>
#include <array>
#include <cstddef>

#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

// A copy takes those that were written, no more: most controllers have no delay.
template <std::size_t size>
class DelayLine {
public:
    DelayLine() = default;
    DelayLine(const DelayLine& other) { *this = other; }
    DelayLine& operator=(const DelayLine& other) {
        written_ = other.written_;
        std::copy_n(other.values_.begin(), written_, values_.begin());
        return *this;
    }

    const Vec3<double>& at(double sample) const { return values_[std::size_t(std::max(0.0, sample)) % size]; }
    Vec3<double>& to_write(double sample) {
        const std::size_t place = std::size_t(sample) % size;
        written_ = std::max(written_, place + 1);
        return values_[place];
    }

private:
    std::size_t written_ = 0;
    std::array<Vec3<double>, size> values_;
};

}  // namespace arm3r
