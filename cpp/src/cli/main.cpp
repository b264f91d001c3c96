// The executable. It knows the library only by its C interface.

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "arm3r/arm3r.hpp"
#include "cli/arguments.hpp"
#include "cli/installation.hpp"
#include "cli/terminal.hpp"
#include "platform/files.hpp"
#include "platform/program.hpp"

namespace cli {

namespace platform = arm3r::platform;

namespace {

using arm3r::api::check;
using arm3r::api::Error;
using arm3r::api::Run;
using arm3r::api::Scenario;

int exit_code(int32_t status) {
    switch (status) {
        case ARM3R_OK: return exit_ok;
        case ARM3R_E_VALUE:  // a word of the command line that is no text
        case ARM3R_E_SIZE:
        case ARM3R_E_FILE: return exit_usage;
        case ARM3R_E_SIZE_CAP:
        case ARM3R_E_MEMORY: return exit_budget;
        case ARM3R_E_OUTPUT: return exit_output;
        case ARM3R_E_CALLBACK: return exit_callback;
        case ARM3R_E_ABI:
        case ARM3R_E_FORMAT: return exit_incompatible;
        case ARM3R_E_INTERNAL: return exit_internal;
        default: return exit_scenario;
    }
}

int exit_code_of_outcome(int32_t outcome) {
    if (outcome == ARM3R_RUN_OK) return exit_ok;
    if (outcome == ARM3R_RUN_CONTROLLER) return exit_callback;
    return outcome == ARM3R_RUN_BUDGET || outcome == ARM3R_RUN_STOPPED ? exit_budget : exit_numeric;
}

// ---- scenarios

Scenario load(const std::string& path, const Arguments& arguments) {
    Scenario scenario = Scenario::load(path);
    for (const auto& [at, value] : arguments.edits) scenario.set(at, value, "--set");
    if (arguments.no_checks) scenario.set("checks", "[]", "--no-checks");
    scenario.validate();
    return scenario;
}

// All scenarios, or the problems of all of them.
std::vector<Scenario> load_all(const Arguments& arguments) {
    std::vector<Scenario> scenarios;
    Exit failed{exit_ok, ""};
    for (const std::string& file : arguments.files) {
        try {
            scenarios.push_back(load(file, arguments));
        } catch (const Error& error) {
            if (failed.code == exit_ok) failed.code = exit_code(error.status());
            failed.message += (failed.message.empty() ? "" : "\n") + std::string(error.what());
        }
    }
    if (failed.code != exit_ok) throw failed;
    return scenarios;
}

// ---- output files

bool is_directory(const std::string& path) { return platform::kind_of(path) == platform::FileKind::directory; }

bool ends_with_separator(const std::string& path) {
    return !path.empty() && platform::last_separator(path) == path.size() - 1;
}

void make_with_parents(const std::string& path) {
    const std::size_t end = platform::last_separator(path);
    if (end != path.npos && end > 0) make_with_parents(path.substr(0, end));
    platform::make_directory(path);
}

void make_directory(const std::string& path) {
    make_with_parents(path);
    if (!is_directory(path))
        throw Exit{exit_output, path + ": error[output]: cannot be made; for several scenarios -o names a directory"};
}

// A directory that is yet to be made is not taken for a file.
void check_new_directory(const std::string& path) {
    const std::size_t dot = path.rfind('.'), name = platform::last_separator(path) + 1;
    if (platform::kind_of(path) == platform::FileKind::missing && dot != path.npos && dot > name &&
        !ends_with_separator(path))
        throw Exit{exit_usage, path +
                                   ": error[usage]: several scenarios are written into a directory, and this is the "
                                   "name of a file; write / at its end if it is a directory"};
}

void spare_scenarios(const std::vector<std::string>& files, const std::string& path) {
    for (const std::string& file : files)
        if (platform::is_same_file(file, path))
            throw Exit{exit_usage, path + ": error[usage]: this would overwrite a scenario; give -o another name"};
}

std::string summary_beside(const std::string& path) {
    const char* summary = nullptr;
    check(arm3r_output_summary(path.data(), path.size(), &summary));
    return summary;
}

// A file for each scenario, checked before the first run; "-" is standard output, "" nowhere.
std::vector<std::string> plan_outputs(const Arguments& arguments, const std::vector<Scenario>& scenarios) {
    const std::string& output = arguments.output;
    if (output.empty() || output == "-") {
        if (output == "-" && scenarios.size() > 1)
            throw Exit{exit_usage, "arm3r: error[usage]: -o - takes one scenario"};
        return std::vector<std::string>(scenarios.size(), output);
    }
    if (scenarios.size() > 1) check_new_directory(output);
    if (scenarios.size() > 1 || ends_with_separator(output)) make_directory(output);
    const bool directory = is_directory(output);
    std::vector<std::string> paths;
    std::set<std::string> seen;
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
        const std::string path =
            directory ? output + (ends_with_separator(output) ? "" : "/") + scenarios[i].name() + ".csv" : output;
        if (!seen.insert(path).second)
            throw Exit{exit_usage, path + ": error[usage]: two scenarios would write this file; give them names"};
        spare_scenarios(arguments.files, path);
        spare_scenarios(arguments.files, summary_beside(path));
        check(arm3r_output_probe(path.data(), path.size()));
        paths.push_back(path);
    }
    return paths;
}

int32_t print_piece(void* failure, const char* data, size_t size) {
    try {
        print({data, size});
        return 0;
    } catch (const Exit& exit) {
        *static_cast<Exit*>(failure) = exit;
        return 1;
    }
}

void print_csv(const Run& run) {
    Exit failure{exit_ok, ""};
    const int32_t status = arm3r_run_csv(run.get(), print_piece, &failure);
    if (failure.code != exit_ok) throw failure;
    check(status);
}

void write_results(const Run& run, const std::string& path) {
    if (path == "-") print_csv(run);
    else if (!path.empty()) run.save(path);
}

// ---- calls

Run simulate(const Scenario& scenario, const Arguments& arguments) {
    Progress progress(scenario.name());
    arm3r_run_options options{};
    options.struct_size = sizeof options;
    options.stop = stop_flag();
    options.progress = Progress::callback;
    options.user = &progress;
    options.time_limit = arguments.time_limit;
    options.trust = arguments.trust;
    return scenario.run(&options);
}

int code_of(const Run& run) {
    if (run.outcome() != ARM3R_RUN_OK) return exit_code_of_outcome(run.outcome());
    return run.checks().failed ? exit_check : exit_ok;
}

// The codes of runs are in order of severity, but for ok.
int worse(int a, int b) { return a == exit_ok ? b : b == exit_ok ? a : std::min(a, b); }

int call_run(const Arguments& arguments) {
    const std::vector<Scenario> scenarios = load_all(arguments);
    catch_signals();
    const std::vector<std::string> outputs = plan_outputs(arguments, scenarios);
    const bool several = scenarios.size() > 1;
    const auto say = [&](const std::string& text) { arguments.output == "-" ? complain(text) : print(text); };
    int code = exit_ok;
    std::size_t not_ok = 0;
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
        const Run run = simulate(scenarios[i], arguments);
        if (stop_requested()) return exit_ok;
        write_results(run, outputs[i]);
        const int this_code = code_of(run);
        code = worse(code, this_code);
        not_ok += this_code != exit_ok;
        if (several) say(arguments.json ? i ? ",\n" : "[\n" : i ? "\n" : "");
        say(arguments.json ? run.summary() : run.report());
    }
    if (several && arguments.json) say("]\n");
    if (several && !arguments.json)
        say("\n" + std::to_string(scenarios.size()) + " runs, " + std::to_string(not_ok) + " not ok\n");
    return code;
}

int call_check(const Arguments& arguments) {
    const Scenario scenario = load(arguments.files[0], arguments);
    complain(scenario.warnings());
    print(scenario.yaml(true));
    return exit_ok;
}

// The line at the head tells an editor where the schema lies.
void call_template() {
    if (const std::string schema = scenario_schema(); !schema.empty())
        print("# yaml-language-server: $schema=" + schema + "\n");
    print(arm3r_template());
}

int call(const Arguments& arguments) {
    const bool markdown = arguments.format == "md";
    if (arguments.call == "run") return call_run(arguments);
    if (arguments.call == "check") return call_check(arguments);
    if (arguments.call == "schema") print(markdown ? arm3r_schema_markdown() : arm3r_schema_json());
    if (arguments.call == "columns") print(markdown ? arm3r_columns_markdown() : arm3r_columns_text());
    if (arguments.call == "template") call_template();
    return exit_ok;
}

// ---- arm3r NAME: another program

// The path of the called program: as it was called, then with its links resolved.
std::vector<std::string> own_directories(const std::string& called) {
    std::string path = called;
    if (platform::last_separator(called) == called.npos)
        for (const std::string& directory : platform::search_path())
            if (const std::string found = platform::program_in(directory, called); path == called && !found.empty())
                path = found;
    if (platform::last_separator(path) == path.npos) return {};
    std::vector<std::string> directories = {directory_of(path)};
    if (const std::string real = platform::absolute_path(path); !real.empty())
        directories.push_back(directory_of(real));
    return directories;
}

// The paths of programs arm3r-NAME: beside this one, and on PATH.
std::vector<std::string> programs_named(const std::string& name, const std::string& called) {
    if (platform::last_separator(name) != name.npos) return {};
    std::vector<std::string> directories = own_directories(called), found;
    for (const std::string& directory : platform::search_path()) directories.push_back(directory);
    for (const std::string& directory : directories)
        if (const std::string path = platform::program_in(directory, "arm3r-" + name); !path.empty())
            found.push_back(path);
    return found;
}

// Goes on as the program arm3r-NAME, with these words behind its own name. Returns where there is none.
void become(const std::string& name, const std::string& called, std::vector<std::string> words) {
    words.insert(words.begin(), "");
    for (const std::string& path : programs_named(name, called)) {
        words[0] = path;
        platform::become_program(path, words);
    }
}

// Reads the file of arm.urdf by the Python package: arm3r-import prints the keys of the arm, or what is wrong.
struct ArmReader {
    std::string program, text;

    static int32_t read(void* self, const char* request, const char** text) {
        ArmReader& reader = *static_cast<ArmReader*>(self);
        const platform::Ended ended = platform::run_program(reader.program, {reader.program, "--keys", request});
        reader.text = ended.output;
        if (ended.code < 0) reader.text = "the Python package's program cannot be started: " + reader.program;
        *text = reader.text.c_str();
        return ended.code;
    }
};

void set_arm_reader(const std::string& called) {
    static ArmReader reader;
    const std::vector<std::string> programs = programs_named("import", called);
    if (programs.empty()) return;
    reader.program = programs.front();
    check(arm3r_set_arm_reader(ArmReader::read, &reader));
}

[[noreturn]] void run_controller(const Arguments& arguments, const std::string& called) {
    become("run", called, arguments.words);
    throw Exit{exit_usage,
               "arm3r: error[usage]: --controller is run by the Python package, and there is no program arm3r-run "
               "beside this one or on PATH; install the package: `pip install .` in the sources"};
}

int main(const std::vector<std::string>& words) {
    if (words.size() < 2) return print(help("")), exit_ok;
    if (const std::string& name = words[1]; !name.starts_with('-') && !is_call(name)) {
        become(name, words[0], {words.begin() + 2, words.end()});
        throw Exit{exit_usage, "arm3r: error[usage]: " + unknown_call(name)};
    }
    const Arguments arguments = read_arguments({words.begin() + 1, words.end()});
    if (arguments.help) return print(help(arguments.call)), exit_ok;
    if (arguments.version)
        return print("arm3r " + std::string(arm3r_version()) + "\n" + arm3r_build_info() + "\n"), exit_ok;
    if (arguments.cmake_dir) return print(cmake_directory() + "\n"), exit_ok;
    if (!arguments.controller.empty()) run_controller(arguments, words[0]);
    set_arm_reader(words[0]);
    return call(arguments);
}

}  // namespace

}  // namespace cli

int main(int count, char** words) {
    arm3r::platform::prepare_program();
    int code = cli::exit_internal;
    try {
        code = cli::main(arm3r::platform::program_arguments(count, words));
    } catch (const cli::Exit& exit) {
        cli::complain(exit.message + "\n");
        code = exit.code;
    } catch (const arm3r::api::Error& error) {
        cli::complain(std::string(error.what()) + "\n");
        code = cli::exit_code(error.status());
    } catch (const std::bad_alloc&) {
        cli::complain("arm3r: error[memory]: there is not enough memory\n");
        code = cli::exit_budget;
    }
    if (cli::stop_requested()) cli::die_by_signal();
    return code;
}
