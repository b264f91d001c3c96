#include "cli/installation.hpp"

#include "cli/arguments.hpp"
#include "platform/files.hpp"
#include "platform/program.hpp"

namespace cli {

std::string directory_of(const std::string& path) { return path.substr(0, arm3r::platform::last_separator(path)); }

namespace {

std::string program_directory() { return directory_of(arm3r::platform::program_path()); }

// The path of a part that lies at `from_program`, seen from the folder of the executable; "" where it is missing.
std::string part(const char* from_program) {
    return arm3r::platform::absolute_path(program_directory() + "/" + from_program);
}

}  // namespace

std::string cmake_directory() {
    const std::string file = part(ARM3R_CMAKE_FROM_BIN "/arm3rConfig.cmake");
    if (file.empty())
        throw Exit{exit_usage, "arm3r: error[usage]: this program is not installed: no " ARM3R_CMAKE_FROM_BIN
                               "/arm3rConfig.cmake, seen from " +
                                   program_directory() + "; install it with pip or cmake --install"};
    return directory_of(file);
}

std::string scenario_schema() { return part(ARM3R_DATA_FROM_BIN "/docs/scenario.schema.json"); }

}  // namespace cli
