// Closed curves from files: a measured annulus.
#pragma once

#include "core/types.hpp"

#include <filesystem>

namespace coapt {

// The corners of a closed polygon, 3 x n [mm]: of a .mrk.json the control points of its first closed curve,
// else of its first open curve, else of its first list of points; of any other file three numbers a line, as
// `coapt export` and spreadsheets write them. What does not say that it is closed must end where it begins:
// the ends at most three times as far apart as any two neighbours. A first point that is repeated at the end
// is kept. Throws InputError naming the file, its line or entry.
Points read_closed_curve(const std::filesystem::path& path);

}  // namespace coapt
