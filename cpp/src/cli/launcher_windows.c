/* The command `arm3r` of a Python installation on Windows: it starts the executable inside the package arm3r_cpp, which
 * lies in a folder of the same installation, waits for it, and ends with its exit code. The words it was called by stay. */

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <stdio.h>
#include <wchar.h>

enum { exit_usage = 2, levels_up = 2, longest_path = 32768 };

/* Where the package lies below the folder in which Scripts/ is. */
static const wchar_t *const places[] = {L"\\Lib\\site-packages", L"\\site-packages", L""};

/* Replaces a path by that of the folder `levels` above. */
static void go_up(wchar_t *path, int levels) {
    for (wchar_t *separator; levels > 0 && (separator = wcsrchr(path, L'\\')); --levels) *separator = L'\0';
}

/* While this program waits: Ctrl-C is for the executable. */
static BOOL WINAPI ignore(DWORD event) {
    (void)event;
    return TRUE;
}

/* Ends with the exit code of the executable; returns where it is not there. */
static void run_executable(const wchar_t *path) {
    STARTUPINFOW startup = {0};
    PROCESS_INFORMATION process;
    DWORD code = exit_usage;
    startup.cb = sizeof startup;
    if (!CreateProcessW(path, GetCommandLineW(), NULL, NULL, TRUE, 0, NULL, NULL, &startup, &process)) return;
    SetConsoleCtrlHandler(ignore, TRUE);
    WaitForSingleObject(process.hProcess, INFINITE);
    GetExitCodeProcess(process.hProcess, &code);
    ExitProcess(code);
}

int main(void) {
    static wchar_t prefix[longest_path], path[longest_path];
    GetModuleFileNameW(NULL, prefix, longest_path);
    go_up(prefix, levels_up);
    for (size_t i = 0; i < sizeof places / sizeof *places; ++i) {
        swprintf(path, longest_path, L"%ls%ls\\arm3r_cpp\\bin\\arm3r.exe", prefix, places[i]);
        run_executable(path);
    }
    fprintf(stderr, "arm3r: error[usage]: no package arm3r_cpp is installed below %ls; install it again with pip\n", prefix);
    return exit_usage;
}
