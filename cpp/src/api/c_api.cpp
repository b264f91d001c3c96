// Failures of the C interface, kept for the thread they happened in; and the checks of what comes in.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "api/c_api.hpp"
#include "base/text.hpp"
#include "batch/simulation.hpp"
#include "schema/schema.hpp"

namespace arm3r {

namespace {

struct Failure {
    std::string message, json;
    const char* fixed_message = nullptr;  // where there was no memory for more
};

thread_local Failure last;

const char* class_of(arm3r_status status) {
    switch (status) {
        case ARM3R_OK: return "ok";
        case ARM3R_E_NULL: return "argument.null";
        case ARM3R_E_SIZE: return "argument.size";
        case ARM3R_E_INDEX: return "argument.index";
        case ARM3R_E_VALUE: return "argument.value";
        case ARM3R_E_REACH: return "arm.reach";
        case ARM3R_E_SINGULAR: return "arm.singular";
        case ARM3R_E_OVERLAP: return "argument.overlap";
        case ARM3R_E_BUSY: return "argument.busy";
        case ARM3R_E_FILE: return "file";
        case ARM3R_E_OVER: return "argument.over";
        case ARM3R_E_SCENARIO: return "scenario";
        case ARM3R_E_SIZE_CAP: return "run.size";
        case ARM3R_E_MEMORY: return "memory";
        case ARM3R_E_OUTPUT: return "output";
        case ARM3R_E_CALLBACK: return "callback";
        case ARM3R_E_ABI: return "abi";
        case ARM3R_E_FORMAT: return "format";
        case ARM3R_E_INTERNAL: return "internal";
    }
    return "internal";
}

std::string json(const Problem& p) {
    return "{\"code\": " + json_string(p.code) + ", \"message\": " + json_string(p.message) +
           ", \"file\": " + json_string(p.file) + ", \"line\": " + std::to_string(p.line) +
           ", \"column\": " + std::to_string(p.column) + ", \"path\": " + json_string(p.path) +
           ", \"got\": " + json_string(p.got) + ", \"allowed\": " + json_string(p.allowed) +
           ", \"hint\": " + json_string(p.hint) + "}";
}

std::string json(const Error& error) {
    const std::string code = error.problems().empty() ? class_of(error.status()) : error.problems().front().code;
    std::string problems;
    for (const Problem& problem : error.problems()) problems += (problems.empty() ? "" : ", ") + json(problem);
    return "{\"status\": " + std::to_string(error.status()) + ", \"code\": " + json_string(code) +
           ", \"message\": " + json_string(error.what()) + ", \"problems\": [" + problems + "]}";
}

}  // namespace

int32_t store_error(const Error& error) noexcept {
    try {
        last = {error.what(), json(error)};
    } catch (...) {
        last.fixed_message = out_of_memory;
    }
    return error.status();
}

int32_t store_error(arm3r_status status, const char* message) noexcept {
    try {
        const bool bug = status == ARM3R_E_INTERNAL;
        return store_error(Error(status, bug ? std::string("a bug in arm3r, please report it: ") + message : message));
    } catch (...) {
        last.fixed_message = message;
        return status;
    }
}

void need(const void* pointer, const char* name) {
    if (!pointer) throw Error(ARM3R_E_NULL, "the argument `" + std::string(name) + "` is null");
}

std::string text_in(const char* text, std::size_t size, const char* name, std::size_t most) {
    need(text, name);
    const std::string argument = "the argument `" + std::string(name) + "`";
    if (size > most)
        throw Error(ARM3R_E_SIZE,
                    argument + " has " + std::to_string(size) + " bytes; at most " + std::to_string(most));
    std::string copy(text, size);
    if (copy.find('\0') != copy.npos) throw Error(ARM3R_E_VALUE, argument + " holds a NUL byte");
    if (!is_utf8(copy)) throw Error(ARM3R_E_VALUE, argument + " is not UTF-8");
    return copy;
}

void read_struct(const void* given, void* into, std::size_t known, const char* name) {
    constexpr std::size_t largest = 4096;
    const auto refuse = [&](const std::string& why) { throw Error(ARM3R_E_ABI, std::string(name) + ": " + why); };
    std::size_t size;
    std::memcpy(&size, given, sizeof size);
    if (size < sizeof(std::size_t) || size > largest || size % sizeof(std::size_t))
        refuse("struct_size is " + std::to_string(size) + ", this library knows " + std::to_string(known));
    const auto* bytes = static_cast<const unsigned char*>(given);
    if (size > known && std::any_of(bytes + known, bytes + size, [](unsigned char byte) { return byte != 0; }))
        refuse("it has fields that this library does not know");
    std::memcpy(into, given, std::min(size, known));
}

void check_pointer(const void* data, const char* name) {
    need(data, name);
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(double) != 0)
        throw Error(ARM3R_E_VALUE, std::string(name) + " is not aligned for doubles");
}

void check_index(std::size_t index, std::size_t count, const char* what) {
    if (index >= count)
        throw Error(ARM3R_E_INDEX, "there is no " + std::string(what) + " " + std::to_string(index) + "; there are " +
                                       std::to_string(count));
}

std::span<const double> params_in(const double* params, std::size_t count) {
    need(params, "params");
    if (!is_param_count(count))
        throw Error(ARM3R_E_SIZE, "params has " + std::to_string(count) + " numbers; a scenario has " +
                                      std::to_string(param_count()) + ", and more for long tables alone");
    return {params, count};
}

RunOptions options_in(const arm3r_run_options* given) {
    if (!given) return {};
    const arm3r_run_options options = struct_in(given, "arm3r_run_options");
    if (!(options.time_limit >= 0) || std::isinf(options.time_limit))
        throw Error(ARM3R_E_VALUE, "arm3r_run_options: time_limit must be finite and not negative");
    return {.stop = options.stop, .progress = options.progress, .user = options.user, .time_limit = options.time_limit};
}

bool wants_trust(const arm3r_run_options* given) {
    const std::int64_t trust = given ? struct_in(given, "arm3r_run_options").trust : 0;
    if (trust != 0 && trust != 1) throw Error(ARM3R_E_VALUE, "arm3r_run_options: trust must be 0 or 1");
    return trust == 1;
}

void run_in(arm3r_run& handle, const Setup& setup, const arm3r_run_options* given, const ColumnSet& kept) {
    const bool trust = wants_trust(given);
    RunOptions options = options_in(given);
    options.kept = trust ? kept | states_in_log() : kept;
    handle.run = simulate(setup, options);
    handle.setup = setup;
    if (trust) handle.horizon = horizon_of(setup, handle.run, options);
    if (trust && !handle.horizon)
        handle.run.warnings.emplace_back(
            "the time up to which the joint angles are right is not known: a limit ended one of the runs that tell it");
}

void refuse_trust(const arm3r_run_options* options) {
    if (wants_trust(options))
        throw Error(
            ARM3R_E_VALUE,
            "arm3r_run_options: trust is not possible with a law of your own: it takes more runs of the same law, "
            "which may have a memory");
}

}  // namespace arm3r

using namespace arm3r;

const char* arm3r_error_message(void) { return last.fixed_message ? last.fixed_message : last.message.c_str(); }

const char* arm3r_error_json(void) {
    if (last.fixed_message)
        return "{\"status\": -402, \"code\": \"memory\", \"message\": \"not enough memory\", \"problems\": []}";
    return last.json.empty() ? "{\"status\": 0, \"code\": \"\", \"message\": \"\", \"problems\": []}"
                             : last.json.c_str();
}
