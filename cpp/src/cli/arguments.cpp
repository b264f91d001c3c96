#include "cli/arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace cli {

namespace {

struct Call {
    std::string_view name, operands, does;
    std::size_t least, most;  // operands
};

constexpr Call calls[] = {
    {"run", "FILE...", "simulate scenarios (- is standard input); the summary goes to standard output", 1, 10'000},
    {"check", "FILE", "validate a scenario and print it resolved, each value with its origin", 1, 1},
    {"schema", "", "print the JSON Schema of scenario files; arm3r sweep --schema prints that of sweep files", 0, 0},
    {"columns", "", "print name, unit and meaning of every column of a run", 0, 0},
    {"template", "", "print a commented scenario to start from", 0, 0},
};

// Programs of the Python package, which are called as `arm3r NAME`.
struct Program {
    std::string_view name, operands, does;
};

constexpr Program programs[] = {
    {"examples", "[NAME]", "list the scenarios of this installation, print one, or copy them into a folder"},
    {"plot", "RUN", "draw figures of a run, of several runs, or of a sweep"},
    {"animate", "RUN", "draw a film of a run"},
    {"live", "[SCENARIO]", "open the live page: a scenario as scene, plots, text and sliders, in a browser"},
    {"view", "RUN", "open a run in the live page"},
    {"sweep", "SWEEP", "run a scenario many times with other values, into one table"},
    {"converge", "FILE", "run a scenario with smaller and smaller steps, and print the observed order"},
    {"verify", "FILE...", "compare formulas that you wrote with the model, and name the wrong terms"},
    {"import", "FILE.urdf", "print a scenario whose arm is that of a URDF"},
    {"export", "SCENARIO", "write the arm of a scenario as URDF, or as MJCF for MuJoCo"},
    {"docs", "[NAME]", "list the pages of this installation, or print one, such as verify or sweeps"},
    {"exercise", "CALL", "list and show exercises, judge what you hand in, and mark a folder of submissions"},
};

struct Option {
    std::string_view name, letter, value, calls, does;  // letter: the short form; value "": a flag; calls "": all
};

constexpr std::string_view no_call = "-";  // as `calls` of an option of the program itself

constexpr Option options[] = {
    {"--output", "-o", "OUT", "run",
     "write OUT (.csv, or .npz for NumPy; no other ending) and, beside it, the summary as .json; - is standard output; "
     "for several files, or with / at its end, OUT is a directory, which is created"},
    {"--set", "", "PATH=VALUE", "run check",
     "set PATH to VALUE (YAML), e.g. initial.q[1]='-30 deg'; null removes it; may be given several times"},
    {"--no-checks", "", "", "run", "leave out the scenario's checks, which hold for its own values only"},
    {"--json", "", "", "run", "print the summary as JSON: one object, or an array for several files"},
    {"--trust", "", "", "run", "print up to which time the joint angles are right to 1e-6 rad; takes three more runs"},
    {"--time-limit", "", "SECONDS", "run", "end a run that takes longer by the wall clock as `budget`"},
    {"--controller", "", "FILE[:FUNCTION]", "run",
     "use a MATLAB or Python function of yours as the controller, and compare it with the scenario's own; "
     "FILE is executed without confinement"},
    {"--format", "", "md", "schema columns", "print a Markdown page instead"},
    {"--help", "-h", "", "", "print this"},
    {"--version", "", "", "", "print the version"},
    {"--cmake-dir", "", "", no_call, "print the folder of arm3rConfig.cmake: cmake -Darm3r_DIR=$(arm3r --cmake-dir)"},
};

constexpr std::string_view exit_codes =
    "Exit codes: 0 ok, 1 bug, 2 usage or unreadable file, 3 scenario, 4 numeric, 5 budget, 6 output, 7 failed runs,\n"
    "            8 controller, 9 incompatible version, 10 a check failed, 11 a wrong formula, 12 a formula that\n"
    "            cannot be judged, from 128 a signal\n";

[[noreturn]] void usage_error(const std::string& message) { throw Exit{exit_usage, "arm3r: error[usage]: " + message}; }

const Call* find_call(std::string_view name) {
    const auto found =
        std::find_if(std::begin(calls), std::end(calls), [&](const Call& call) { return call.name == name; });
    return found == std::end(calls) ? nullptr : found;
}

bool takes(std::string_view call, const Option& option) {
    return option.calls.empty() ||
           (" " + std::string(option.calls) + " ").find(" " + std::string(call) + " ") != std::string::npos;
}

// A typing error of one or two letters: the words differ in at most two letters between a common head and a common
// tail.
bool is_typing_error(std::string_view typed, std::string_view meant) {
    while (!typed.empty() && !meant.empty() && typed.front() == meant.front())
        typed.remove_prefix(1), meant.remove_prefix(1);
    while (!typed.empty() && !meant.empty() && typed.back() == meant.back())
        typed.remove_suffix(1), meant.remove_suffix(1);
    return typed.size() <= 2 && meant.size() <= 2;
}

template <class Table>
std::string did_you_mean(std::string_view typed, const Table& table) {
    for (const auto& entry : table)
        if (is_typing_error(typed, entry.name) || (typed.size() > 2 && entry.name.starts_with(typed)))
            return "; did you mean " + std::string(entry.name) + "?";
    return {};
}

std::string printable(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, 80)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
    return text.size() > 80 ? out + "..." : out;
}

const Option& find_option(const std::string& name) {
    for (const Option& option : options)
        if (option.name == name || (!option.letter.empty() && option.letter == name)) return option;
    usage_error("unknown option " + printable(name) + did_you_mean(name, options));
}

double read_seconds(const std::string& text) {
    double seconds = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, seconds);
    if (error != std::errc() || stop != end || !(seconds > 0) || std::isinf(seconds))
        usage_error("--time-limit takes seconds, more than 0, got " + printable(text));
    return seconds;
}

void apply(const Option& option, const std::string& value, Arguments& arguments) {
    if (option.name == "--output") {
        if (value.empty()) usage_error("-o needs a file name");
        if (!arguments.output.empty()) usage_error("-o is given twice");
        arguments.output = value;
    } else if (option.name == "--set") {
        const std::size_t equals = value.find('=');
        if (equals == value.npos || equals == 0) usage_error("--set takes PATH=VALUE, got " + printable(value));
        arguments.edits.emplace_back(value.substr(0, equals), value.substr(equals + 1));
    } else if (option.name == "--format") {
        if (value != option.value) usage_error("--format takes md, got " + printable(value));
        arguments.format = value;
    } else if (option.name == "--time-limit") {
        arguments.time_limit = read_seconds(value);
    } else if (option.name == "--controller") {
        if (value.empty()) usage_error("--controller needs a file name");
        if (!arguments.controller.empty()) usage_error("--controller is given twice");
        arguments.controller = value;
    } else {
        arguments.json |= option.name == "--json";
        arguments.trust |= option.name == "--trust";
        arguments.no_checks |= option.name == "--no-checks";
        arguments.cmake_dir |= option.name == "--cmake-dir";
        arguments.help |= option.name == "--help";
        arguments.version |= option.name == "--version";
    }
}

struct Used {
    std::vector<const Option*> options;
    std::vector<std::string> words;  // the options in their long form, with their values
};

// "--output=X" and "-oX" as "--output" and "X". A word like "-output" is left whole, and so refused.
std::pair<std::string, std::optional<std::string>> parted(const std::string& word) {
    const std::size_t equals = word.find('=');
    const auto is_long = [&](const Option& option) { return "-" + word.substr(0, equals) == option.name; };
    if (word.starts_with("--") ? equals == word.npos : word.size() == 2) return {word, {}};
    if (word.starts_with("--")) return {word.substr(0, equals), word.substr(equals + 1)};
    if (std::any_of(std::begin(options), std::end(options), is_long)) return {word.substr(0, equals), {}};
    return {word.substr(0, 2), word.substr(word[2] == '=' ? 3 : 2)};
}

// An option with its value, in the same word or in the next one. Returns how many words it took.
std::size_t read_option(const std::vector<std::string>& words, std::size_t at, Arguments& arguments, Used& used) {
    const std::string& word = words[at];
    const auto [name, value] = parted(word);
    const Option& option = find_option(name);
    used.options.push_back(&option);
    const auto take = [&](const std::string& given) {
        apply(option, given, arguments);
        used.words.push_back(std::string(option.name) + (option.value.empty() ? "" : "=" + given));
    };
    if (option.value.empty()) {
        if (value) usage_error(std::string(option.name) + " takes no value");
        take("");
        return 1;
    }
    if (value) return take(*value), 1;
    if (at + 1 == words.size()) usage_error(word + " needs a value: " + std::string(option.value));
    take(words[at + 1]);
    return 2;
}

void check_fit(const Arguments& arguments, const Used& used) {
    const Call* call = find_call(arguments.call);
    if (!call)
        usage_error(arguments.call.empty() ? "no command given; see arm3r --help" : unknown_call(arguments.call));
    for (const Option* option : used.options)
        if (!takes(call->name, *option))
            usage_error("arm3r " + arguments.call + " has no option " + std::string(option->name));
    if (arguments.trust && !arguments.controller.empty())
        usage_error("--trust takes more runs, and the function of --controller may have a memory: give one of them");
    if (arguments.files.size() < call->least)
        usage_error("arm3r " + arguments.call + " needs " + std::string(call->operands));
    if (arguments.files.size() > call->most)
        usage_error("arm3r " + arguments.call + (call->most ? " takes one file" : " takes no operand") + ", got " +
                    printable(arguments.files[call->most]));
}

std::string two_columns(const std::string& left, std::string_view right) {
    return "  " + left + std::string(left.size() < 24 ? 24 - left.size() : 1, ' ') + std::string(right) + "\n";
}

std::string option_line(const Option& option) {
    std::string left = option.letter.empty() ? "" : std::string(option.letter) + ", ";
    left += option.name;
    if (!option.value.empty()) left += " " + std::string(option.value);
    return two_columns(left, option.does);
}

std::string program_help() {
    std::string out = "usage: arm3r COMMAND ...\n\n";
    const auto add = [&](const auto& entry) {
        out += two_columns(std::string(entry.name) + " " + std::string(entry.operands), entry.does);
    };
    std::for_each(std::begin(calls), std::end(calls), add);
    out += "\nCommands of the Python package, which must be installed:\n\n";
    std::for_each(std::begin(programs), std::end(programs), add);
    out += two_columns("NAME ...", "any other NAME runs arm3r-NAME, found beside this program or on PATH") + "\n";
    for (const Option& option : options)
        if (option.calls.empty() || option.calls == no_call) out += option_line(option);
    return out + "\narm3r COMMAND --help describes a command.\n\n" + std::string(exit_codes);
}

}  // namespace

bool is_call(std::string_view name) { return find_call(name) != nullptr; }

std::string unknown_call(const std::string& name) {
    const std::string own = did_you_mean(name, calls), hint = own.empty() ? did_you_mean(name, programs) : own;
    return "unknown command " + printable(name) + ", and no program arm3r-" + printable(name) +
           (hint.empty() ? "; see" : hint + " See") + " arm3r --help";
}

Arguments read_arguments(const std::vector<std::string>& words) {
    Arguments arguments;
    Used used;
    bool options_end = false;
    for (std::size_t at = 0; at < words.size();) {
        const std::string& word = words[at];
        if (!options_end && word.size() > 1 && word[0] == '-') {
            if (word == "--") ++at, options_end = true;
            else at += read_option(words, at, arguments, used);
        } else {
            (arguments.call.empty() ? arguments.call : arguments.files.emplace_back()) = word;
            ++at;
        }
    }
    arguments.words = used.words;
    arguments.words.emplace_back("--");
    arguments.words.insert(arguments.words.end(), arguments.files.begin(), arguments.files.end());
    if (arguments.help || arguments.version) return arguments;
    if (!arguments.cmake_dir || !arguments.call.empty()) check_fit(arguments, used);
    return arguments;
}

std::string help(std::string_view name) {
    const Call* call = find_call(name);
    if (!call) return program_help();
    std::string out = "usage: arm3r " + std::string(name) + " " + std::string(call->operands) + " [options]\n\n  " +
                      std::string(call->does) + "\n\n";
    for (const Option& option : options)
        if (takes(name, option)) out += option_line(option);
    return out + "\n" + std::string(exit_codes);
}

}  // namespace cli
