// Files read and written as a whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace coapt::formats {

// Throws InputError when the path is not a file that can be read.
std::string read_whole(const std::filesystem::path& path);

// Writes to a file beside the target and renames it: the target is whole or untouched.
// Throws InputError when that fails.
void write_whole(const std::filesystem::path& path, std::string_view bytes);

}  // namespace coapt::formats
