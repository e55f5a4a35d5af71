// Triangles that close an open rim, so that a pressurised surface encloses a volume.
#pragma once

#include "core/types.hpp"

#include <vector>

namespace coapt {

// Triangulates a closed loop by cutting off, again and again, the ear with the shortest diagonal. Where
// two stretches of a rim lie against each other, as the free edges of a closed valve do, the diagonals
// zip them together and the fan's area all but vanishes.
// loop: at least three nodes in the direction in which the surface's triangles run along it; the fan runs
// against it, so that surface and fan together are consistently oriented. Cost O(m log m).
Triangles close_rim(const Points& x, const std::vector<int>& loop);

}  // namespace coapt
