// How far each vertex of a surface is from the parts of the surface that it could touch.
#pragma once

#include "core/types.hpp"

namespace coapt {

// Distance from each vertex to the nearest facet that is not its own neighbourhood. To that belong the facets
// with a corner within two edges of the vertex, and those with a corner that hangs together with the vertex
// inside a ball of 1.5 times the distance looked at: on a fine mesh the surface itself lies nearer than any
// other part of it. NaN where no facet lies within `reach`; it is looked at in steps of an eighth, a quarter,
// half and the whole of it. [length] O(n) for a reach of a few edges. Pre: reach > 0.
Vector vertex_gaps(const Points& x, const Triangles& triangles, double reach);

}  // namespace coapt
