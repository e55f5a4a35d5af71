// Valves from the files of finite-element programs: Abaqus (.inp) and FEBio (.feb).
#pragma once

#include "formats/valve.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

struct ValveModel {
  Valve valve;  // mm, MPa: the file's numbers as they are
  bool has_contact = false, is_pressure_dead = false;
  std::vector<std::string> warnings;  // whole sentences
};

// True for the extensions that read_model reads.
bool is_model_file(const std::filesystem::path& path);

// Reads shells, chords, held and moved nodes, pressure, materials and sets (docs/formats.md says of each what
// is read and how). What a scene has no place for is named in a warning. Throws InputError with all defects,
// each naming the file and its line, node or element.
ValveModel read_model(const std::filesystem::path& path);

}  // namespace coapt
