#pragma once
// A run as CSV, and the hash of its columns.

#include <cstdint>
#include <functional>
#include <string_view>

#include "record/run_data.hpp"

namespace arm3r {

// In pieces; the sink returns false to stop. False where it did.
bool write_csv(const Run& run, const std::function<bool(std::string_view)>& sink);

// 64-bit FNV-1a over the columns' bytes, column after column, doubles in little-endian order.
std::uint64_t fnv1a64(const Run& run);

}  // namespace arm3r
