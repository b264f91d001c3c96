#pragma once
// Where the parts of this installation lie, seen from the executable.

#include <string>

namespace cli {

std::string directory_of(const std::string& path);

std::string cmake_directory();  // holds arm3rConfig.cmake; throws Exit where the program is not installed
std::string scenario_schema();  // the JSON Schema of scenario files; "" where the program is not installed

}  // namespace cli
