// Files that outlast a loss of power.
#pragma once

#include <filesystem>
#include <string_view>

namespace coapt::formats {

// Replaces the target by the bytes, as write_whole() does; and they have reached the disk before they take
// the place of what was there. A file `PATH.new` is there meanwhile, and stays where the process is killed.
// Throws InputError as write_whole() does.
void write_durable(const std::filesystem::path& path, std::string_view bytes);

}  // namespace coapt::formats
