// Files read and written as a whole.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace coapt::formats {

// The bytes of a file without the byte order mark of UTF-8. Throws InputError when the path is not a file
// that can be read.
std::string read_whole(const std::filesystem::path& path);

// Writes the parts one after the other to a file beside the target and renames it: the target is whole or
// untouched. Throws InputError when that fails.
void write_whole(const std::filesystem::path& path, std::initializer_list<std::string_view> parts);
inline void write_whole(const std::filesystem::path& path, std::string_view bytes) {
  write_whole(path, std::initializer_list<std::string_view>{bytes});
}

}  // namespace coapt::formats
