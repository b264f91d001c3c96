// The platform on Windows. Paths become UTF-16 for the system's own functions.

#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <windows.h>

#include <fcntl.h>
#include <io.h>
#include <malloc.h>
#include <process.h>
#include <shellapi.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <memory>

#include "platform/files.hpp"
#include "platform/memory.hpp"
#include "platform/program.hpp"
#include "platform/threads.hpp"

namespace arm3r::platform {

namespace {

std::wstring wide(const std::string& text) {
    const int size = static_cast<int>(text.size());
    std::wstring out(MultiByteToWideChar(CP_UTF8, 0, text.data(), size, nullptr, 0), L'\0');
    MultiByteToWideChar(CP_UTF8, 0, text.data(), size, out.data(), static_cast<int>(out.size()));
    return out;
}

std::string utf8(const std::wstring& text) {
    const int size = static_cast<int>(text.size());
    std::string out(WideCharToMultiByte(CP_UTF8, 0, text.data(), size, nullptr, 0, nullptr, nullptr), '\0');
    WideCharToMultiByte(CP_UTF8, 0, text.data(), size, out.data(), static_cast<int>(out.size()), nullptr, nullptr);
    return out;
}

FileKind kind_from(unsigned mode) {
    if ((mode & _S_IFMT) == _S_IFREG) return FileKind::regular;
    return (mode & _S_IFMT) == _S_IFDIR ? FileKind::directory : FileKind::other;
}

void set_errno(DWORD error) {
    switch (error) {
        case ERROR_FILE_NOT_FOUND:
        case ERROR_PATH_NOT_FOUND: errno = ENOENT; break;
        case ERROR_DISK_FULL: errno = ENOSPC; break;
        default: errno = EACCES;
    }
}

// A file that is open only to ask about it; folders can be opened so as well.
class Handle {
public:
    explicit Handle(const std::string& path)
        : handle_(CreateFileW(wide(path).c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                              OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr)) {}
    ~Handle() {
        if (handle_ != INVALID_HANDLE_VALUE) CloseHandle(handle_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    explicit operator bool() const { return handle_ != INVALID_HANDLE_VALUE; }
    HANDLE get() const { return handle_; }

private:
    HANDLE handle_;
};

// As CommandLineToArgvW and the C library read it again: in quotation marks, with backslashes before one doubled.
std::wstring quoted(const std::wstring& word) {
    std::wstring out = L"\"";
    std::size_t backslashes = 0;
    for (const wchar_t c : word) {
        if (c == L'"') out.append(backslashes + 1, L'\\');
        backslashes = c == L'\\' ? backslashes + 1 : 0;
        out += c;
    }
    return out.append(backslashes, L'\\') + L'"';
}

void (*end_handler)(int) = nullptr;
volatile LONG end_requests = 0;

BOOL WINAPI on_console_event(DWORD event) {
    if (InterlockedIncrement(&end_requests) > 1) return FALSE;  // the default ends the program
    end_handler(event == CTRL_C_EVENT ? SIGINT : SIGTERM);
    return TRUE;
}

// While this program waits for another one: Ctrl-C is for that one.
BOOL WINAPI ignore_console_event(DWORD) { return TRUE; }

}  // namespace

// ---- memory

void* allocate_aligned(std::size_t alignment, std::size_t bytes) noexcept { return _aligned_malloc(bytes, alignment); }

void free_aligned(void* block) noexcept { _aligned_free(block); }

void advise_large_pages(void*, std::size_t) noexcept {}

// ---- threads

int allowed_cpus() {
    DWORD_PTR own = 0, all = 0;
    if (!GetProcessAffinityMask(GetCurrentProcess(), &own, &all)) return 1;
    return std::max(1, __builtin_popcountll(own));
}

bool caught_thread_end() { return false; }

void continue_thread_end() { throw; }

// ---- files

FileKind kind_of(const std::string& path) {
    struct _stat64 about{};
    return _wstat64(wide(path).c_str(), &about) == 0 ? kind_from(about.st_mode) : FileKind::missing;
}

FileKind own_kind_of(const std::string& path) {
    const DWORD attributes = GetFileAttributesW(wide(path).c_str());
    const bool is_link = attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_REPARSE_POINT);
    return is_link && !(attributes & FILE_ATTRIBUTE_DIRECTORY) ? FileKind::link : kind_of(path);
}

FileKind kind_of(int descriptor) {
    struct _stat64 about{};
    return _fstat64(descriptor, &about) == 0 ? kind_from(about.st_mode) : FileKind::missing;
}

int open_to_read(const std::string& path) {
    if (kind_of(path) == FileKind::directory) return errno = EISDIR, -1;
    return _wopen(wide(path).c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
}

int create_new(const std::string& path) {
    return _wopen(wide(path).c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
}

bool close_file(int descriptor) { return _close(descriptor) == 0; }

std::ptrdiff_t read_some(int descriptor, char* data, std::size_t size) {
    return _read(descriptor, data, static_cast<unsigned>(std::min<std::size_t>(size, INT_MAX)));
}

std::ptrdiff_t write_some(int descriptor, const char* data, std::size_t size) {
    return _write(descriptor, data, static_cast<unsigned>(std::min<std::size_t>(size, INT_MAX)));
}

void remove_file(const std::string& path) { _wunlink(wide(path).c_str()); }

bool replace_file(const std::string& from, const std::string& to) {
    if (MoveFileExW(wide(from).c_str(), wide(to).c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH))
        return true;
    set_errno(GetLastError());
    return false;
}

bool make_directory(const std::string& path) { return CreateDirectoryW(wide(path).c_str(), nullptr); }

bool is_same_file(const std::string& a, const std::string& b) {
    const Handle one(a), other(b);
    BY_HANDLE_FILE_INFORMATION of_one, of_other;
    return one && other && GetFileInformationByHandle(one.get(), &of_one) &&
           GetFileInformationByHandle(other.get(), &of_other) &&
           of_one.dwVolumeSerialNumber == of_other.dwVolumeSerialNumber &&
           of_one.nFileIndexHigh == of_other.nFileIndexHigh && of_one.nFileIndexLow == of_other.nFileIndexLow;
}

std::string absolute_path(const std::string& path) {
    if (kind_of(path) == FileKind::missing) return "";
    const std::unique_ptr<wchar_t, decltype(&std::free)> full(_wfullpath(nullptr, wide(path).c_str(), 0), std::free);
    return full ? utf8(full.get()) : "";
}

std::size_t last_separator(std::string_view path) { return path.find_last_of("/\\"); }

// ---- the program

int process_id() { return _getpid(); }

void prepare_program() {
    for (const int descriptor : {0, 1, 2}) _setmode(descriptor, _O_BINARY);
    SetConsoleOutputCP(CP_UTF8);
}

std::vector<std::string> program_arguments(int, char**) {
    int count = 0;
    const std::unique_ptr<LPWSTR, decltype(&LocalFree)> words(CommandLineToArgvW(GetCommandLineW(), &count), LocalFree);
    std::vector<std::string> out;
    for (int i = 0; words && i < count; ++i) out.push_back(utf8(words.get()[i]));
    return out;
}

std::string program_path() {
    std::wstring path(32768, L'\0');
    path.resize(GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size())));
    return utf8(path);
}

std::vector<std::string> search_path() {
    std::vector<std::string> directories;
    const wchar_t* path = _wgetenv(L"PATH");
    std::string rest = path ? utf8(path) : "";
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(';'), rest.size());
        if (end > 0) directories.push_back(rest.substr(0, end));
        rest.erase(0, end + 1);
    }
    return directories;
}

std::string program_in(const std::string& directory, const std::string& name) {
    const std::string path = directory + "\\" + name + (name.ends_with(".exe") ? "" : ".exe");
    return kind_of(path) == FileKind::regular ? path : "";
}

void become_program(const std::string& path, const std::vector<std::string>& words) {
    std::vector<std::wstring> texts;
    for (const std::string& word : words) texts.push_back(quoted(wide(word)));
    std::vector<const wchar_t*> pointers;
    for (const std::wstring& text : texts) pointers.push_back(text.c_str());
    pointers.push_back(nullptr);
    SetConsoleCtrlHandler(ignore_console_event, TRUE);
    const std::intptr_t code = _wspawnv(_P_WAIT, wide(path).c_str(), pointers.data());
    if (code != -1) ExitProcess(static_cast<UINT>(code));
}

Ended run_program(const std::string& path, const std::vector<std::string>& words) {
    std::wstring line;
    for (const std::string& word : words) line += (line.empty() ? L"" : L" ") + quoted(wide(word));
    SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
    HANDLE from = nullptr, to = nullptr;
    if (!CreatePipe(&from, &to, &inherited, 0)) return {-1, ""};
    SetHandleInformation(from, HANDLE_FLAG_INHERIT, 0);
    STARTUPINFOW start{};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdInput = GetStdHandle(STD_INPUT_HANDLE), start.hStdOutput = to;
    start.hStdError = GetStdHandle(STD_ERROR_HANDLE);
    PROCESS_INFORMATION child{};
    const bool started =
        CreateProcessW(wide(path).c_str(), line.data(), nullptr, nullptr, TRUE, 0, nullptr, nullptr, &start, &child);
    CloseHandle(to);
    std::string output;
    char piece[4096];
    for (DWORD size = 0; started && ReadFile(from, piece, sizeof piece, &size, nullptr) && size > 0;)
        output.append(piece, size);
    CloseHandle(from);
    DWORD code = 0;
    if (started) {
        WaitForSingleObject(child.hProcess, INFINITE);
        GetExitCodeProcess(child.hProcess, &code);
        CloseHandle(child.hProcess), CloseHandle(child.hThread);
    }
    return {started ? static_cast<int>(code) : -1, output};
}

void catch_end_requests(void (*handler)(int)) {
    end_handler = handler;
    SetConsoleCtrlHandler(on_console_event, TRUE);
}

void die_of(int) {
    constexpr UINT ended_by_control_c = 0xC000013A;
    ExitProcess(ended_by_control_c);
}

bool is_terminal(int descriptor) { return _isatty(descriptor); }

}  // namespace arm3r::platform
