// Annulus curves and papillary points given to a valve. Private to this room.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt::detail {

// The rim nearest to the curve, or the longest where the curve is empty, becomes the annulus; where one other
// rim is left it becomes the free edge.
void choose_annulus(Valve& valve, const Points& curve);

// Reads annulus_closed, papillary and papillary_closed of the options and puts them into the valve. `file`
// names it in messages. Throws InputError with all defects.
void apply_curves(const ImportOptions& options, const std::string& file, Valve& valve,
                  std::vector<std::string>& warnings);

}  // namespace coapt::detail
