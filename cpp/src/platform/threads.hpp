#pragma once
// Threads of a process, and the exception that ends one.

#include <cxxabi.h>

namespace arm3r::platform {

#ifdef __wasm__
constexpr bool has_threads = false;
#else
constexpr bool has_threads = true;
#endif

int allowed_cpus();  // CPUs that this process may use, at least 1

#ifdef __GLIBCXX__
using ThreadEnd = abi::__forced_unwind;  // pthread_exit throws it: it must be thrown on
#else
struct ThreadEnd {};  // a thread is ended without an exception
#endif

}  // namespace arm3r::platform
