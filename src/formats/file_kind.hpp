// What a path leads to where that is no file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace coapt::formats {

// "is a folder; name a file in it", "is a pipe, no file" or the like of a socket or a device; nothing of a
// file, and of what is not there.
std::optional<std::string> what_is_no_file(const std::filesystem::path& path);

}  // namespace coapt::formats
