#pragma once
// Files that are written completely or not at all.

#include <string>
#include <string_view>

namespace arm3r {

// A file that is being written, under a temporary name next to its final one. It is removed unless it is published.
class OutputFile {
public:
    explicit OutputFile(std::string path);  // throws Error ARM3R_E_OUTPUT, like all below
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view data);
    void close();    // all data have been written
    void publish();  // the final name now has it

private:
    std::string path_, temporary_;
    int descriptor_ = -1;
};

std::string ending_of(std::string_view path);  // ".csv"; "" where there is none

// Throws Error ARM3R_E_OUTPUT where PATH can be no file.
void check_target(const std::string& path);

}  // namespace arm3r
