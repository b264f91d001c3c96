// What exceptions and thread_local objects of C++ need of the platform, and LLVM's libraries leave to it.

// The tag of the exceptions of C++: `throw` and `catch` of WebAssembly name it. Its one value is a pointer.
__asm__(
    ".tagtype __cpp_exception i32\n"
    ".globl __cpp_exception\n"
    "__cpp_exception:\n");

// There is one thread, and it does not end before the module is dropped: no thread_local object is destroyed.
extern "C" int __cxa_thread_atexit(void (*)(void*), void*, void*) { return 0; }
