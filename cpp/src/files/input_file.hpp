#pragma once
// The bytes of a file that a user names: a regular file, or standard input as "-".

#include <cstddef>
#include <string>

namespace arm3r {

// At most `enough` bytes of it. Throws Error ARM3R_E_FILE.
std::string read_input(const std::string& path, std::size_t enough);

}  // namespace arm3r
