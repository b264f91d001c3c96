#pragma once
// Common parts of the C interface: the guard, the checks of arguments, and the handles.

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arm3r/arm3r.h"
#include "base/error.hpp"
#include "base/fp_environment.hpp"
#include "platform/threads.hpp"
#include "record/run_data.hpp"
#include "results/checks.hpp"
#include "scenario/scenario.hpp"
#include "trust/horizon.hpp"

namespace arm3r {

// Stores an error for arm3r_error_message() of this thread, and returns its status.
int32_t store_error(const Error& error) noexcept;
int32_t store_error(arm3r_status status, const char* message) noexcept;

inline constexpr const char* out_of_memory =
    "error[memory]: there is not enough memory; of a run most goes to its rows (time.log_every)";

// The body of a C function: no exception leaves it, and the caller's floating-point environment is neither used nor
// changed. The one thing that passes through is the end of the thread within a callback.
template <class Body>
int32_t guard(Body&& body) {
    const StandardFpEnvironment standard;
    try {
        body();
        return ARM3R_OK;
    } catch (const platform::ThreadEnd&) {
        throw;
    } catch (const Error& error) {
        return store_error(error);
    } catch (const std::bad_alloc&) {
        return store_error(ARM3R_E_MEMORY, out_of_memory);
    } catch (const std::exception& error) {
        return store_error(ARM3R_E_INTERNAL, error.what());
    } catch (...) {
        if (platform::caught_thread_end()) platform::continue_thread_end();
        return store_error(ARM3R_E_INTERNAL, "an unknown exception");
    }
}

// Throws Error ARM3R_E_NULL.
void need(const void* pointer, const char* name);

// Text from outside: `size` bounds it. Refuses more than `most` bytes, a NUL inside, and what is not UTF-8.
std::string text_in(const char* text, std::size_t size, const char* name, std::size_t most = 4096);

// As need(), and that it may point to a double.
void check_pointer(const void* data, const char* name);

void check_index(std::size_t index, std::size_t count, const char* what);

std::span<const double> params_in(const double* params, std::size_t count);

// Reads the caller's version of a struct into that of the library; all begin with their size and end with reserved
// fields. Throws Error ARM3R_E_ABI if it contains something that this library does not know.
void read_struct(const void* given, void* into, std::size_t known, const char* name);

template <class Struct>
Struct struct_in(const Struct* given, const char* name) {
    Struct known{};
    read_struct(given, &known, sizeof known, name);
    for (const int64_t field : known.reserved)
        if (field != 0) throw Error(ARM3R_E_ABI, std::string(name) + ": a reserved field is not 0");
    return known;
}

// Null gives the defaults.
RunOptions options_in(const arm3r_run_options* options);

// Adds the location in the text to problems that were found in the numbers.
template <class Body>
auto with_locations(const Scenario& scenario, Body body) {
    try {
        return body();
    } catch (const Error& error) {
        if (error.problems().empty()) throw;
        throw Error(error.status(), located(error.problems(), scenario));
    }
}

// Texts that belong to a handle: each is made once and keeps its address.
class Texts {
public:
    template <class Make>
    const char* get(const std::string& what, Make&& make) const {
        const std::lock_guard lock(mutex_);
        auto found = texts_.find(what);
        if (found == texts_.end()) found = texts_.emplace(what, make()).first;
        return found->second.c_str();
    }
    void clear() { texts_.clear(); }

private:
    mutable std::mutex mutex_;
    mutable std::map<std::string, std::string> texts_;
};

}  // namespace arm3r

struct arm3r_run {
    arm3r::Run run;
    std::string name;      // "" where there was no scenario
    std::string scenario;  // resolved, as YAML
    std::vector<arm3r::CheckResult> checks;
    std::optional<arm3r::Setup> setup;
    std::optional<arm3r::Horizon> horizon;  // where it was asked for
    arm3r::Texts texts;
};

namespace arm3r {

// Sets what a run keeps of its scenario: name, text, warnings, checks, setup.
void describe(arm3r_run& handle, const Resolved& resolved, const char* yaml);

// Sets the run of a setup, and its horizon where the options ask for it. kept: columns beside those of the log.
void run_in(arm3r_run& handle, const Setup& setup, const arm3r_run_options* options, const ColumnSet& kept = {});

// Throws Error ARM3R_E_VALUE where the options ask for the horizon of a run with a law of the user's own.
void refuse_trust(const arm3r_run_options* options);

}  // namespace arm3r

struct arm3r_scenario {
    arm3r::Scenario scenario;
    arm3r::Texts texts;

    const arm3r::Resolved& resolved() const;  // made once after each change
    const char* yaml() const;                 // likewise
    void changed();

private:
    mutable std::mutex mutex_;
    mutable std::optional<arm3r::Resolved> resolved_;
};
