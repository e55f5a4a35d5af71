// How the elements of a mesh file are counted by its format.
#pragma once

#include "mesh/numbering.hpp"

#include <filesystem>

namespace coapt {

// From 1 in OBJ, whose faces name their vertices so; from 0 in every other format. Triangles are those that
// read_mesh makes: faces with more corners come after one another as they are cut.
Numbering file_numbering(const std::filesystem::path& file);

}  // namespace coapt
