// Scenes and meshes in the formats of others.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

// Writes what the extension of `out` names:
//   .feb                       the scene as a FEBio model, specification 4.0
//   .obj .ply .stl .off .vtp   the scene's mesh at the start
//   .mrk.json                  points for 3D Slicer: `what` is a set of nodes of the scene, or a set with
//   "_closed"
//                              behind it for where it goes; the annulus and rims as closed curves
// `from` is a scene, or for the mesh formats also a mesh. Coordinates are those of the scene, taken as LPS;
// files that can say so do ("SPACE=LPS"). Returns warnings, whole sentences. Throws InputError.
std::vector<std::string> export_file(const std::filesystem::path& from, const std::filesystem::path& out,
                                     const std::string& what = "annulus");

}  // namespace coapt
