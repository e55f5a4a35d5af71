// The valve JSON: leaflets (an OBJ beside it), annulus, anchors, chord network, pressure.
//
// Keys that are read: name, units, leaflets, closed_reference, pressure {value, unit}, leaflet_thickness
// (or leaflet_thickness_mm), annulus, annulus_closed, free_edge (or free_edges, a list of lists),
// commissures, papillary, papillary_closed, junctions, chords [{from, to, rest_length, area, material,
// level}], membranes {region: {type, keys of that term}}, cables {material: {type, keys of that term}}, or in
// their place materials and chord_materials (a formula under "model" and its numbers, see docs/formats.md),
// supports [{name, fix: ["x", ...]}], whose vertices and closed positions stand as NAME and NAME_closed in
// sets. Every other key is passed over, but a list of whole numbers is kept as a named node set and a list
// of positions as named points, and so are the members of an object "sets".
#pragma once

#include "formats/valve.hpp"
#include "mesh/numbering.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace coapt {

struct ValveFile {
  Valve valve;  // mm, MPa
  std::map<std::string, std::vector<int>>
      sets;                              // all named vertices of the leaflets, 0-based, in the file's order
  std::map<std::string, Points> points;  // [mm]
  std::vector<std::string> warnings;     // whole sentences
  Numbering numbering;                   // how the file of the leaflets counts them, for messages
};

enum class ValveMeshes { Read, Skip };

// Reads a valve JSON in any unit of length ("units", default mm) and with it the meshes that it names.
// With Skip the meshes are left out, vertex numbers are not compared with their size, and materials and
// chord_materials, which belong to regions of the mesh, are passed over.
// An annulus in another order than that of its rim is put in order, with its closed positions and a warning;
// one of two rims is refused (with the leaflets alone).
// Throws InputError with all defects, each naming file and entry.
ValveFile read_valve(const std::filesystem::path& path, ValveMeshes meshes = ValveMeshes::Read);

// The defects of vertex numbers at or above vertex_count, each naming `file` and the chord or list entry.
std::vector<std::string> vertex_defects(const ValveFile& file, const std::string& name, int vertex_count);

// Writes path (units mm, pressure in MPa) and beside it leaflets.obj and closed_reference.obj where the valve
// has them; reading gives the same numbers bit by bit. Throws InputError, and then writes nothing where a
// number is not finite or a coordinate greater than kGreatestCoordinate.
void write_valve(const std::filesystem::path& path, const Valve& valve);

}  // namespace coapt
