#include "files/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "platform/files.hpp"

namespace arm3r {

namespace {

constexpr int standard_input = 0;

[[noreturn]] void refuse(const std::string& path, std::string code, std::string message, std::string hint = {}) {
    throw Error(ARM3R_E_FILE,
                {{.code = std::move(code), .message = std::move(message), .hint = std::move(hint), .file = path}});
}

class File {
public:
    explicit File(int descriptor) : descriptor_(descriptor) {}
    ~File() {
        if (descriptor_ > standard_input) platform::close_file(descriptor_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    int descriptor() const { return descriptor_; }

private:
    int descriptor_;
};

std::string read_up_to(int descriptor, const std::string& path, std::size_t enough) {
    std::string text;
    constexpr std::size_t at_a_time = 65536;
    while (text.size() < enough) {
        const std::size_t before = text.size(), wanted = std::min(at_a_time, enough - before);
        text.resize(before + wanted);
        const std::ptrdiff_t size = platform::read_some(descriptor, text.data() + before, wanted);
        text.resize(before + static_cast<std::size_t>(std::max<std::ptrdiff_t>(size, 0)));
        if (size < 0 && errno != EINTR) refuse(path, "file.read", std::strerror(errno));
        if (size == 0) break;
    }
    return text;
}

}  // namespace

bool is_absolute(const std::string& name) {
    return platform::last_separator(name.substr(0, 1)) == 0 || (name.size() > 1 && name[1] == ':');
}

std::string path_beside(const std::string& file, const std::string& name) {
    if (name == "-") return "./-";  // no standard input
    const std::size_t folder = platform::last_separator(file);
    return is_absolute(name) || folder == file.npos ? name : file.substr(0, folder + 1) + name;
}

std::string read_input(const std::string& path, std::size_t enough) {
    if (path.empty()) refuse(path, "file.name", "the file name is empty");
    if (path == "-") return read_up_to(standard_input, "standard input", enough);
    const File file(platform::open_to_read(path));
    if (file.descriptor() < 0) refuse(path, "file.open", std::strerror(errno));
    const platform::FileKind kind = platform::kind_of(file.descriptor());
    if (kind == platform::FileKind::directory) refuse(path, "file.kind", std::strerror(EISDIR));
    if (kind != platform::FileKind::regular)
        refuse(path, "file.kind", "not a regular file", "`-` reads standard input");
    return read_up_to(file.descriptor(), path, enough);
}

}  // namespace arm3r
