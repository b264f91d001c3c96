/* The command `arm3r` of a Python installation: it becomes the executable inside the package arm3r_cpp, which lies in a
 * folder of the same installation. The name it was called by stays, for arm3r-plot and others are looked for beside it. */

#include <glob.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif

enum { exit_usage = 2, levels_up = 2 };

/* Where a package lies below the folder in which bin/ is. */
static const char* const places[] = {"lib*/python3*/site-packages", "lib*/python3*/dist-packages", "."};

/* Replaces a path by that of the folder `levels` above. */
static void go_up(char* path, int levels) {
    for (char* slash; levels > 0 && (slash = strrchr(path, '/')); --levels) *slash = '\0';
}

/* Writes the path of this program, "" where it is not known. */
static void find_program(char* path, size_t size) {
#ifdef __APPLE__
    uint32_t room = (uint32_t)size;
    if (_NSGetExecutablePath(path, &room) != 0) path[0] = '\0';
#else
    const ssize_t length = readlink("/proc/self/exe", path, size - 1);
    path[length > 0 ? length : 0] = '\0';
#endif
}

static void become_executable(const char* prefix, char** words) {
    char pattern[PATH_MAX + 64];
    for (size_t i = 0; i < sizeof places / sizeof *places; ++i) {
        glob_t found;
        snprintf(pattern, sizeof pattern, "%s/%s/arm3r_cpp/bin/arm3r", prefix, places[i]);
        if (glob(pattern, 0, NULL, &found) != 0) continue;
        for (size_t k = 0; k < found.gl_pathc; ++k) execv(found.gl_pathv[k], words);
        globfree(&found);
    }
}

int main(int count, char** words) {
    char path[PATH_MAX] = "";
    (void)count;
    find_program(path, sizeof path);
    go_up(path, levels_up);
    become_executable(path, words);
    fprintf(stderr, "arm3r: error[usage]: no package arm3r_cpp is installed below %s; install it again with pip\n",
            path);
    return exit_usage;
}
