#pragma once
// Files, by descriptors as POSIX has them. Paths are UTF-8; nothing translates the ends of lines. Functions that fail set
// errno.

#include <cstddef>
#include <string>
#include <string_view>

namespace arm3r::platform {

enum class FileKind { missing, regular, directory, link, other };

FileKind kind_of(const std::string& path);      // of what a link points to
FileKind own_kind_of(const std::string& path);  // `link` of a link itself
FileKind kind_of(int descriptor);

int open_to_read(const std::string& path);  // -1: fails. Opening a FIFO does not wait for its writer
int create_new(const std::string& path);    // to write; -1: fails, with EEXIST where there is such a file
bool close_file(int descriptor);
std::ptrdiff_t read_some(int descriptor, char* data, std::size_t size);  // bytes; 0: the end; -1: fails
std::ptrdiff_t write_some(int descriptor, const char* data, std::size_t size);

void remove_file(const std::string& path);
bool replace_file(const std::string& from, const std::string& to);  // at once: `to` is the old file or the new one
bool make_directory(const std::string& path);                       // the folder above it must exist
bool is_same_file(const std::string& a, const std::string& b);      // false where one is missing
std::string absolute_path(const std::string& path);                 // links resolved; "" where it is missing

std::size_t last_separator(std::string_view path);  // place of the last character that separates folders, or npos

}  // namespace arm3r::platform
