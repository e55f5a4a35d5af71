// The ends of the columns of a layer, shortened where it would pass through itself.
#pragma once

#include "image/segment/layer_grid.hpp"

#include <vector>

namespace coapt {

// Length that each column has left at each of its points [mm], below 0 beyond its end; one value per node.
Vector length_left(const LayerGrid& grid, const Vector& ends);

// Towards the free edge two parts of a layer can run into each other and follow the same tissue, each past
// the other. Of two triangles that pass through each other the one nearer to the end of its columns goes, and
// what is below it, in rounds until none do or 6 mm of a column are gone; the edge then has no notch steeper
// than 3 : 1. Returns the ends [mm].
Vector trim_crossings(const LayerGrid& grid, const Vector& ends);

// Ends lowered to at most `wanted` [mm], one for each column (infinity: as it is), but not by more than 6 mm
// below what was `given`, and those of their neighbours as far as the slope needs. Whether any came down.
bool lower_ends(const LayerGrid& grid, const Vector& given, const Vector& wanted, Vector& ends);

}  // namespace coapt
