#include "files/output_file.hpp"

#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "platform/files.hpp"
#include "platform/program.hpp"

namespace arm3r {

namespace {

[[noreturn]] void refuse_output(const std::string& path, const std::string& message, std::string hint = {}) {
    throw Error(
        ARM3R_E_OUTPUT,
        {{.code = "output", .message = "cannot be written: " + message, .hint = std::move(hint), .file = path}});
}

std::string directory_of(const std::string& path) { return path.substr(0, platform::last_separator(path) + 1); }

int create_beside(const std::string& path, std::string& temporary) {
    for (int attempt = 0;; ++attempt) {
        temporary = directory_of(path) + ".arm3r-" + std::to_string(platform::process_id()) + "-" +
                    std::to_string(attempt) + ".part";
        const int descriptor = platform::create_new(temporary);
        if (descriptor >= 0 || errno != EEXIST) return descriptor;
    }
}

}  // namespace

void check_target(const std::string& path) {
    using platform::FileKind;
    if (path.empty()) refuse_output(path, "the file name is empty");
    if (platform::last_separator(path) == path.size() - 1) refuse_output(path, std::strerror(EISDIR), "name a file");
    const FileKind kind = platform::own_kind_of(path);
    if (kind == FileKind::directory) refuse_output(path, std::strerror(EISDIR), "name a file");
    if (kind == FileKind::other) refuse_output(path, "not a regular file", "`-o -` writes to standard output");
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
    check_target(path_);
    descriptor_ = create_beside(path_, temporary_);
    if (descriptor_ < 0) refuse_output(path_, std::strerror(errno), errno == ENOENT ? "make the directory first" : "");
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) platform::close_file(descriptor_);
    if (!temporary_.empty()) platform::remove_file(temporary_);
}

void OutputFile::write(std::string_view data) {
    while (!data.empty()) {
        const std::ptrdiff_t size = platform::write_some(descriptor_, data.data(), data.size());
        if (size < 0 && errno != EINTR) refuse_output(path_, std::strerror(errno));
        if (size > 0) data.remove_prefix(static_cast<std::size_t>(size));
    }
}

void OutputFile::close() {
    const bool closed = platform::close_file(descriptor_);
    descriptor_ = -1;
    if (!closed) refuse_output(path_, std::strerror(errno));
}

void OutputFile::publish() {
    if (!platform::replace_file(temporary_, path_)) refuse_output(path_, std::strerror(errno));
    temporary_.clear();
}

std::string ending_of(std::string_view path) {
    const std::size_t name = platform::last_separator(path) + 1, dot = path.rfind('.');
    return std::string(dot == path.npos || dot <= name ? "" : path.substr(dot));
}

}  // namespace arm3r
