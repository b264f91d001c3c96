#include "files/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.hpp"

namespace arm3r {

namespace {

[[noreturn]] void refuse_output(const std::string& path, const std::string& message, std::string hint = {}) {
    throw Error(
        ARM3R_E_OUTPUT,
        {{.code = "output", .message = "cannot be written: " + message, .hint = std::move(hint), .file = path}});
}

std::string directory_of(const std::string& path) { return path.substr(0, path.rfind('/') + 1); }

void check_target(const std::string& path) {
    struct stat about{};
    if (path.empty()) refuse_output(path, "the file name is empty");
    if (path.ends_with('/')) refuse_output(path, std::strerror(EISDIR), "name a file");
    if (lstat(path.c_str(), &about) != 0) return;
    if (S_ISDIR(about.st_mode)) refuse_output(path, std::strerror(EISDIR), "name a file");
    if (!S_ISREG(about.st_mode) && !S_ISLNK(about.st_mode))
        refuse_output(path, "not a regular file", "`-o -` writes to standard output");
}

int create_beside(const std::string& path, std::string& temporary) {
    for (int attempt = 0;; ++attempt) {
        temporary = directory_of(path) + ".arm3r-" + std::to_string(getpid()) + "-" + std::to_string(attempt) + ".part";
        const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0 || errno != EEXIST) return descriptor;
    }
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
    check_target(path_);
    descriptor_ = create_beside(path_, temporary_);
    if (descriptor_ < 0) refuse_output(path_, std::strerror(errno), errno == ENOENT ? "make the directory first" : "");
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
}

void OutputFile::write(std::string_view data) {
    while (!data.empty()) {
        const ssize_t size = ::write(descriptor_, data.data(), data.size());
        if (size < 0 && errno != EINTR) refuse_output(path_, std::strerror(errno));
        if (size > 0) data.remove_prefix(static_cast<std::size_t>(size));
    }
}

void OutputFile::close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    if (result != 0) refuse_output(path_, std::strerror(errno));
}

void OutputFile::publish() {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) refuse_output(path_, std::strerror(errno));
    temporary_.clear();
}

std::string summary_path(const std::string& path) {
    const std::size_t name = path.rfind('/') + 1, dot = path.rfind('.');
    const std::string summary = (dot == path.npos || dot <= name ? path : path.substr(0, dot)) + ".json";
    if (summary == path) refuse_output(path, "the summary goes there", "give the CSV another suffix, .csv");
    return summary;
}

void probe_output(const std::string& path) {
    OutputFile{path};
    OutputFile{summary_path(path)};
}

}  // namespace arm3r
