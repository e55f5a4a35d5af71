// Leaflets, or parts of them, that chords should hold and do not. Private to this room.
#pragma once

#include "formats/valve.hpp"
#include "mesh/numbering.hpp"

#include <string>
#include <vector>

namespace coapt::detail {

// Regions on which no chord inserts while others have chords, or without such names: pieces of the surface,
// and a run of the free edge longer than a valve leaves between two insertions. A sentence for each.
std::vector<std::string> bare_leaflets(const Valve& valve, Numbering numbering);

}  // namespace coapt::detail
