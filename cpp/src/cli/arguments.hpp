#pragma once
// The command line of the executable, as data.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cli {

enum ExitCode {
    exit_ok = 0,
    exit_internal = 1,
    exit_usage = 2,
    exit_scenario = 3,
    exit_numeric = 4,
    exit_budget = 5,
    exit_output = 6,
    exit_callback = 8,
    exit_incompatible = 9,
    exit_check = 10
};

// Ends the program with this code, after `message` on stderr.
struct Exit {
    int code;
    std::string message;
};

struct Arguments {
    std::string call;  // "" for `arm3r --help` and `arm3r --version`
    std::vector<std::string> files;
    std::vector<std::pair<std::string, std::string>> edits;  // PATH, VALUE
    std::string output, format, controller;
    double time_limit = 0;           // s; 0: none
    std::vector<std::string> words;  // options in their long form, `--`, files: the same once more, for another program
    bool json = false, no_checks = false, trust = false, help = false, version = false, cmake_dir = false;
};

bool is_call(std::string_view name);                              // one of the executable's own
Arguments read_arguments(const std::vector<std::string>& words);  // throws Exit
std::string help(std::string_view call);                          // "" for the program itself
std::string unknown_call(const std::string& name);                // the message, with the likely call

}  // namespace cli
