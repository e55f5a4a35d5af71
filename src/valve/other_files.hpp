// Files of other kinds that are taken for a scene, and scenes that are taken for a valve.
#pragma once

#include "formats/json/read_json.hpp"

#include <filesystem>
#include <string>

namespace coapt {

// Both throw InputError with what the file is and what makes a scene of it: a mesh and a finite-element model
// by the name of a file that is there, a valve JSON, markups and a result by their keys.
void refuse_other_file(const std::filesystem::path& path);
void refuse_other_json(const Json& json, const std::filesystem::path& path);

// Throws InputError where the JSON is that of a scene, which commands on valve files are given, and says what
// was expected in its place, or how it is solved.
void refuse_scene(const Json& json, const std::filesystem::path& path, const std::string& expected = "");

}  // namespace coapt
