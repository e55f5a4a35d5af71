// The mesh of a valve that is imported: judged, and repaired where it can be. Private to this room.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"
#include "mesh/numbering.hpp"
#include "mesh/remesh/repair_slivers.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt::detail {

// Repairs the leaflets as the options say, and says in whole sentences what was done, how far the surface
// moved, and what is doubtful about the mesh; elements are named by their numbering in the file, intersecting
// pairs (start_contact.hpp) those in the repaired mesh. Throws InputError for slivers that no step repairs
// and for pairs that contact cannot start from.
MeshRepair judge_leaflets(const ImportOptions& options, const std::string& file, Numbering numbering,
                          Valve& valve, std::vector<std::string>& warnings);

// One line for each step. Without steps a list that is there from before is removed.
void write_repairs(const std::filesystem::path& path, const MeshRepair& repair);

}  // namespace coapt::detail
