// Leaflets that pass through themselves, as a mesh made from an image may do, pushed apart.
#pragma once

#include "formats/valve.hpp"

namespace coapt {

struct LeafletSeparation {
  int pairs = 0;            // of triangles that touched or passed through each other
  double largest_move = 0;  // of a vertex [length]
};

// Moves vertices off the annulus, which stays, until no two triangles without a common vertex have a point in
// common; a tenth of the mean edge is left between what was pushed apart (mesh/distance/separate.hpp).
// Nothing is changed where no pair does. Throws InputError, and changes nothing, where pairs are left or a
// vertex would have to move by more than two mean edges: it says how many pairs there are, where the first
// one is, and what can be done.
LeafletSeparation separate_leaflets(Valve& valve);

}  // namespace coapt
