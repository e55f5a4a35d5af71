// The files that a scene reads.
#pragma once

#include "formats/json/read_json.hpp"
#include "scene/file/scene.hpp"

#include <filesystem>
#include <vector>

namespace coapt {

// Every text in the JSON that is the path of a file, from the folder on.
std::vector<std::filesystem::path> named_files(const Json& json, const std::filesystem::path& folder);

// The files that the scene names. Throws InputError where the scene was not read from a file.
std::vector<std::filesystem::path> named_files(const Scene& scene);

}  // namespace coapt
