// The platform in WebAssembly: one thread, and no files, signals or other programs. The host of the module reads the
// scenario and keeps the results.

#include <cerrno>
#include <cstdlib>

#include "platform/files.hpp"
#include "platform/memory.hpp"
#include "platform/program.hpp"
#include "platform/threads.hpp"

namespace arm3r::platform {

namespace {

int no_files() {
    errno = ENOSYS;
    return -1;
}

}  // namespace

// ---- memory

void* allocate_aligned(std::size_t alignment, std::size_t bytes) noexcept {
    return std::aligned_alloc(alignment, bytes);
}

void free_aligned(void* block) noexcept { std::free(block); }

void advise_large_pages(void*, std::size_t) noexcept {}

// ---- threads

int allowed_cpus() { return 1; }

bool caught_thread_end() { return false; }

void continue_thread_end() { throw; }

// ---- files

FileKind kind_of(const std::string&) { return FileKind::missing; }
FileKind own_kind_of(const std::string&) { return FileKind::missing; }
FileKind kind_of(int) { return FileKind::missing; }

int open_to_read(const std::string&) { return no_files(); }
int create_new(const std::string&) { return no_files(); }
bool close_file(int) { return no_files() == 0; }
std::ptrdiff_t read_some(int, char*, std::size_t) { return no_files(); }
std::ptrdiff_t write_some(int, const char*, std::size_t) { return no_files(); }

void remove_file(const std::string&) {}
bool replace_file(const std::string&, const std::string&) { return no_files() == 0; }
bool make_directory(const std::string&) { return no_files() == 0; }
bool is_same_file(const std::string&, const std::string&) { return false; }
std::string absolute_path(const std::string&) { return ""; }

std::size_t last_separator(std::string_view path) { return path.rfind('/'); }

// ---- the program

int process_id() { return 1; }

}  // namespace arm3r::platform
