// Files read and written as a whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>

namespace coapt::formats {

// Throws InputError for a folder, a device or a pipe; a file that is not there passes.
void refuse_what_is_no_file(const std::filesystem::path& path);

// The bytes of a file without the byte order mark of UTF-8. Throws InputError when the path is not a regular
// file that can be read, or is greater than `greatest` [bytes].
std::string read_whole(const std::filesystem::path& path,
                       std::uintmax_t greatest = std::numeric_limits<std::uintmax_t>::max());

// Writes the parts one after the other to a file beside the target and renames it: the target is whole or
// untouched, and nothing else is left behind. Throws InputError when that fails (OutputError where
// the file was begun: a full disk), and where the target is
// there and no regular file (a folder, a device): it would take its place.
void write_whole(const std::filesystem::path& path, std::initializer_list<std::string_view> parts);
inline void write_whole(const std::filesystem::path& path, std::string_view bytes) {
  write_whole(path, std::initializer_list<std::string_view>{bytes});
}

}  // namespace coapt::formats
