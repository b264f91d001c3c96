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

// pthread_exit unwinds the stack on Linux, which must go on. GNU's C++ library throws a ThreadEnd then. LLVM's has no such
// class, and only catch (...) catches the end of a thread: caught_thread_end() says whether it is one, and
// continue_thread_end() goes on with it. Elsewhere threads are ended without an exception.
#ifdef __GLIBCXX__
using ThreadEnd = abi::__forced_unwind;
#else
struct ThreadEnd {};
#endif
bool caught_thread_end();
[[noreturn]] void continue_thread_end();

}  // namespace arm3r::platform
