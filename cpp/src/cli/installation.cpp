#include "cli/installation.hpp"

#include <cstdlib>
#include <memory>

#include "cli/arguments.hpp"

namespace cli {

std::string directory_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

namespace {

std::string program_directory() {
    const std::unique_ptr<char, decltype(&std::free)> path(realpath("/proc/self/exe", nullptr), std::free);
    return path ? directory_of(path.get()) : "";
}

// The path of a part that lies at `from_program`, seen from the folder of the executable; "" where it is missing.
std::string part(const char* from_program) {
    const std::string path = program_directory() + "/" + from_program;
    const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr), std::free);
    return real ? real.get() : "";
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
