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

inline constexpr const char *csv_ending = ".csv", *npz_ending = ".npz";  // those of a run's file

std::string ending_of(std::string_view path);  // ".csv"; "" where there is none

// "out/run.csv" -> "out/run.json"
std::string summary_path(const std::string& path);

// Throws Error ARM3R_E_OUTPUT where PATH can be no file, and ARM3R_E_VALUE where its ending is none that a run is written
// with: the file would not be what its name says.
void check_run_path(const std::string& path);

// Throws as check_run_path, and Error ARM3R_E_OUTPUT where PATH and its summary could not be written.
void probe_output(const std::string& path);

}  // namespace arm3r
