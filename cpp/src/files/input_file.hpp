#pragma once
// The bytes of a scenario file: a regular file, or standard input as "-"; never more than a scenario may have.

#include <string>

namespace arm3r {

std::string read_input(const std::string& path);  // throws Error ARM3R_E_FILE

}  // namespace arm3r
