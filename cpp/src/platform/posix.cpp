// The platform on Linux and macOS.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#ifdef __linux__
#include <sched.h>
#endif
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif
#if defined(__linux__) && defined(_LIBCPP_VERSION)
#include <cxxabi.h>
#include <unwind.h>
extern "C" char** __cxa_get_globals();  // of the C++ ABI; LLVM's header has no line for it
#endif

#include "platform/files.hpp"
#include "platform/memory.hpp"
#include "platform/program.hpp"
#include "platform/threads.hpp"

namespace arm3r::platform {

namespace {

FileKind kind_from(mode_t mode) {
    if (S_ISREG(mode)) return FileKind::regular;
    if (S_ISDIR(mode)) return FileKind::directory;
    return S_ISLNK(mode) ? FileKind::link : FileKind::other;
}

}  // namespace

// ---- memory

void* allocate_aligned(std::size_t alignment, std::size_t bytes) noexcept {
    return std::aligned_alloc(alignment, bytes);
}

void free_aligned(void* block) noexcept { std::free(block); }

void advise_large_pages([[maybe_unused]] void* block, [[maybe_unused]] std::size_t bytes) noexcept {
#ifdef MADV_HUGEPAGE
    madvise(block, bytes, MADV_HUGEPAGE);
#endif
}

// ---- threads

int allowed_cpus() {
#ifdef __linux__
    cpu_set_t cpus;
    const int allowed = sched_getaffinity(0, sizeof cpus, &cpus) == 0 ? CPU_COUNT(&cpus) : 1;
#else
    const int allowed = static_cast<int>(std::thread::hardware_concurrency());
#endif
    return std::max(1, allowed);
}

#if !defined(__linux__) || !defined(_LIBCPP_VERSION)
bool caught_thread_end() { return false; }
void continue_thread_end() { throw; }
#else

namespace {

// LLVM's C++ library points to the header of the exception that is caught last; what the unwinder knows is its last member.
_Unwind_Exception* caught_exception() {
    constexpr std::size_t header = 128;
    return reinterpret_cast<_Unwind_Exception*>(*__cxa_get_globals() + header) - 1;
}

}  // namespace

// Of no type of C++, and with the mark that the C library gives it.
bool caught_thread_end() { return !abi::__cxa_current_exception_type() && caught_exception()->exception_class == 0; }

void continue_thread_end() {
    _Unwind_Exception* end = caught_exception();
    *__cxa_get_globals() = nullptr;  // it is caught no longer
    _Unwind_Resume_or_Rethrow(end);
    std::terminate();
}

#endif

// ---- files

FileKind kind_of(const std::string& path) {
    struct stat about{};
    return stat(path.c_str(), &about) == 0 ? kind_from(about.st_mode) : FileKind::missing;
}

FileKind own_kind_of(const std::string& path) {
    struct stat about{};
    return lstat(path.c_str(), &about) == 0 ? kind_from(about.st_mode) : FileKind::missing;
}

FileKind kind_of(int descriptor) {
    struct stat about{};
    return fstat(descriptor, &about) == 0 ? kind_from(about.st_mode) : FileKind::missing;
}

int open_to_read(const std::string& path) { return open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY); }

int create_new(const std::string& path) { return open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); }

bool close_file(int descriptor) { return close(descriptor) == 0; }

std::ptrdiff_t read_some(int descriptor, char* data, std::size_t size) { return read(descriptor, data, size); }

std::ptrdiff_t write_some(int descriptor, const char* data, std::size_t size) { return write(descriptor, data, size); }

void remove_file(const std::string& path) { unlink(path.c_str()); }

bool replace_file(const std::string& from, const std::string& to) { return std::rename(from.c_str(), to.c_str()) == 0; }

bool make_directory(const std::string& path) { return mkdir(path.c_str(), 0777) == 0; }

bool is_same_file(const std::string& a, const std::string& b) {
    struct stat one{}, other{};
    return stat(a.c_str(), &one) == 0 && stat(b.c_str(), &other) == 0 && one.st_dev == other.st_dev &&
           one.st_ino == other.st_ino;
}

std::string absolute_path(const std::string& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr), std::free);
    return real ? real.get() : "";
}

std::size_t last_separator(std::string_view path) { return path.rfind('/'); }

// ---- the program

int process_id() { return getpid(); }

void prepare_program() {
    std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit then returns an error
    std::signal(SIGPIPE, SIG_DFL);  // also where the caller ignores it: a reader that has gone ends the program quietly
}

std::vector<std::string> program_arguments(int count, char** words) { return {words, words + count}; }

std::string program_path() {
#ifdef __APPLE__
    char path[4096];
    std::uint32_t size = sizeof path;
    return _NSGetExecutablePath(path, &size) == 0 ? absolute_path(path) : "";
#else
    return absolute_path("/proc/self/exe");
#endif
}

std::vector<std::string> search_path() {
    std::vector<std::string> directories;
    const char* path = std::getenv("PATH");
    std::string rest = path ? path : "";
    while (!rest.empty()) {
        const std::size_t colon = std::min(rest.find(':'), rest.size());
        if (colon > 0) directories.push_back(rest.substr(0, colon));
        rest.erase(0, colon + 1);
    }
    return directories;
}

std::string program_in(const std::string& directory, const std::string& name) {
    const std::string path = directory + "/" + name;
    return access(path.c_str(), X_OK) == 0 && kind_of(path) != FileKind::directory ? path : "";
}

void become_program(const std::string& path, const std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
    pointers.push_back(nullptr);
    execv(path.c_str(), pointers.data());
}

Ended run_program(const std::string& path, const std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
    pointers.push_back(nullptr);
    int ends[2];
    if (pipe(ends) != 0) return {-1, ""};
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]), close(ends[1]);
        execv(path.c_str(), pointers.data());
        _exit(127);
    }
    close(ends[1]);
    std::string output;
    char piece[4096];
    for (ssize_t size = 1; child > 0 && size != 0;) {
        size = read(ends[0], piece, sizeof piece);
        if (size > 0) output.append(piece, static_cast<std::size_t>(size));
        else if (size < 0 && errno != EINTR) break;
    }
    close(ends[0]);
    int status = 0;
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return {child > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

void catch_end_requests(void (*handler)(int)) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before{}, action{};
        action.sa_handler = handler;
        action.sa_flags = SA_RESETHAND;
        sigaction(number, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
    }
}

void die_of(int request) {
    std::signal(request, SIG_DFL);
    std::raise(request);
    _exit(128 + request);
}

bool is_terminal(int descriptor) { return isatty(descriptor); }

}  // namespace arm3r::platform
