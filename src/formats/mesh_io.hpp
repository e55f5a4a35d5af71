// Triangle meshes from and to files: OBJ, PLY, STL, OFF and VTP, told apart by the extension.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::string> warnings;  // what was changed or left out while reading, each naming the file
  std::string space = {};             // "LPS" where the file states its frame, as 3D Slicer does; else empty
};

// Whether the extension is one of those.
bool is_mesh_file(const std::filesystem::path& path);

// Reads a surface. Polygons are cut into a fan of triangles from their first corner and counted in a
// warning. Regions come from OBJ groups (else objects, else materials), STL solids, and the integer face
// array `region` of PLY and VTP; names that are not UTF-8 are taken as Latin-1. Coordinates are taken as they
// are: a file carries no unit. But one that says SPACE=RAS in its header (VTP: in the string SPACE of its
// field data) is turned to LPS: x and y get the other sign, and a warning says so. Throws InputError with
// every defect found (at most 20 are listed), each naming file and line, when the file cannot be read, is not
// of its format, holds a number that is not finite, an index out of range, a face of less than three corners,
// no face at all, or not what its counts announce. Geometry and topology are judged by check_mesh.
MeshFile read_mesh(const std::filesystem::path& path);

enum class MeshCoding { Ascii, Binary };

// Writes a surface with its regions where the format can hold them (OBJ, PLY, STL ASCII, VTP), so that
// reading gives the same numbers bit by bit; binary STL alone keeps single precision, and STL forgets
// vertices without a triangle. Without `coding`, PLY and VTP are binary and STL is ASCII; OBJ and OFF are
// always text. `space` is the frame of the coordinates as 3D Slicer reads it, "LPS" or "RAS": where it is
// given and the format has a place for it (all but STL ASCII) the file says "SPACE=LPS". The file appears
// under its name only when it is whole. Pre: regions, where not empty, has one entry per triangle and indexes
// region_names. Throws InputError for an unknown extension, or when the file cannot be written.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                std::optional<MeshCoding> coding = std::nullopt, const std::string& space = "");

}  // namespace coapt
