#pragma once
// A run in a file, with its summary beside it, each whole or not at all. A format is a line of the list in run_file.cpp.

#include <functional>
#include <string>

#include "record/run_data.hpp"

namespace arm3r {

// "out/run.csv" -> "out/run.json"
std::string summary_path(const std::string& path);

// Writes a run as the ending of PATH says; `summary` is called by a thread of its own where that saves time. Throws Error
// ARM3R_E_VALUE where the ending is none that a run is written with, and ARM3R_E_OUTPUT where a file cannot be written.
void save_run(const Run& run, const std::function<const char*()>& summary, const std::string& path);

// Throws as save_run() would if it could not write there.
void probe_run_file(const std::string& path);

}  // namespace arm3r
