// The files that a scene names.
#pragma once

#include "formats/json/read_json.hpp"

#include <filesystem>
#include <vector>

namespace coapt {

// Every text in the JSON that is the path of a file, from the folder on.
std::vector<std::filesystem::path> named_files(const Json& json, const std::filesystem::path& folder);

}  // namespace coapt
