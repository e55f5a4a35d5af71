// The file that is imported, of whatever format. Private to this room.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"
#include "mesh/numbering.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt::detail {

struct ImportSource {
  Valve valve;
  Numbering numbering;  // how the file of the leaflets counts them
};

// Of a surface alone the longest rim is the annulus, and the other one, if there is one, the free edge. Of a
// finite-element model the options take the load and the contact, where they are left open. Throws
// InputError.
ImportSource read_source(const std::filesystem::path& file, ImportOptions& options,
                         std::vector<std::string>& warnings);

// A sentence on leaflets between two rims, as those of mitral and tricuspid valves, that come with neither
// chords nor tips, while nothing but the annulus is held; else empty. Leaflets of the aortic kind, which meet
// the annulus with their free edges, have other rims.
std::string missing_chords(const std::string& file, const ImportOptions& options, const Valve& valve);

}  // namespace coapt::detail
