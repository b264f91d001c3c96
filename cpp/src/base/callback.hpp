#pragma once
// How the library calls a function of its caller.

#include <exception>
#include <string>

#include "base/error.hpp"
#include "base/fp_environment.hpp"
#include "platform/threads.hpp"

namespace arm3r {

// An exception of the function becomes an Error, and its changes of the floating-point environment are undone. A thread
// that is ended within it (pthread_exit, as Python does with threads that outlive it) is ended, destructors included.
template <class Function, class... Arguments>
auto call_back(Function* function, Arguments... arguments) {
    const auto refuse = [](const std::string& what) {
        set_standard_fp_environment();
        throw Error(ARM3R_E_CALLBACK, "the function that was called back threw " + what);
    };
    try {
        const auto answer = function(arguments...);
        set_standard_fp_environment();
        return answer;
    } catch (const platform::ThreadEnd&) {
        throw;
    } catch (const std::exception& error) {
        refuse(std::string("an exception: ") + error.what());
    } catch (...) {
        if (platform::caught_thread_end()) platform::continue_thread_end();
        refuse("an unknown exception");
    }
    return decltype(function(arguments...)){};
}

}  // namespace arm3r
