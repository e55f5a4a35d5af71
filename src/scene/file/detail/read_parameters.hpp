// Validates JSON against the table of the scene file. Private to this room.
#pragma once

#include "formats/json/read_json.hpp"
#include "scene/file/parameters.hpp"
#include "scene/file/schema.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

// Where defects go and where relative paths start.
struct Reading {
  std::filesystem::path folder;
  std::vector<std::string> defects;
};

// The values of one object, defaults included; what is wrong is added to reading.defects and left out.
// where: the file and the place in it, as in Parameters.
Parameters read_object(const Json& json, const ObjectSpec& spec, const std::string& where, Reading& reading);

}  // namespace coapt
