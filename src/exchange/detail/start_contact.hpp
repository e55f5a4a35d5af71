// Triangles of an imported mesh that pass through each other, which contact cannot start from. Private to
// this room.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"
#include "mesh/numbering.hpp"

#include <string>
#include <vector>

namespace coapt::detail {

// Finds the pairs that the contact of the scene refuses at its start, by the solver's own check, and pushes
// them apart where half a mean edge is enough and no triangle is folded or flattened by it; a sentence says
// how far vertices moved. Where that does not help it throws InputError with the pairs; without contact, with
// a published model, which chooses its contact later, and where nothing is to be repaired it is a warning.
// place: the file, for messages. Pre: corners in range, coordinates finite.
void separate_leaflets(const ImportOptions& options, const std::string& place, Valve& valve,
                       std::vector<std::string>& warnings, Numbering numbering);

}  // namespace coapt::detail
