#pragma once
// The running program: its arguments, signals, terminal, and the programs that it becomes.

#include <string>
#include <vector>

namespace arm3r::platform {

int process_id();

// Before all else: a write to a full file or to a reader that has gone then behaves as the executable expects.
void prepare_program();
std::vector<std::string> program_arguments(int count, char** words);  // UTF-8, words[0] included
std::string program_path();                                           // of this executable, absolute; "" where unknown

std::vector<std::string> search_path();  // the folders of PATH
// The executable file of this name in a folder, "" where there is none.
std::string program_in(const std::string& directory, const std::string& name);
// Goes on as another program, with words[0] as its name. Returns where it cannot be started.
void become_program(const std::string& path, const std::vector<std::string>& words);

// The exit code of another program, with words[0] as its name, that is run to its end, and what it printed on standard
// output; -1 where it cannot be started.
struct Ended {
    int code;
    std::string output;
};
Ended run_program(const std::string& path, const std::vector<std::string>& words);

// The first request to end the program (Ctrl-C, SIGTERM, SIGHUP) calls the handler with its number, and returns; a second
// one ends it. A signal that the caller ignores stays ignored.
void catch_end_requests(void (*handler)(int));
[[noreturn]] void die_of(int request);

bool is_terminal(int descriptor);

}  // namespace arm3r::platform
