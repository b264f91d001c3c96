#pragma once
// The bytes of a file that a user names: a regular file, or standard input as "-".

#include <cstddef>
#include <string>

namespace arm3r {

// At most `enough` bytes of it. Throws Error ARM3R_E_FILE.
std::string read_input(const std::string& path, std::size_t enough);

// The path of a file that another file names: a relative name counts from the folder of the other.
std::string path_beside(const std::string& file, const std::string& name);
bool is_absolute(const std::string& name);

}  // namespace arm3r
