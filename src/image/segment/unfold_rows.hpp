// Rows of a layer taken apart where columns that come together have crossed.
#pragma once

#include "image/segment/layer_grid.hpp"
#include "mesh/triangle_mesh.hpp"

namespace coapt {

// Two triangles for each cell, divided along the shorter diagonal; numbers of vertices are those of nodes,
// normals those of the grid.
TriangleMesh triangles_of(const LayerGrid& grid);

// Those of them that reach above the level line (`level` above 0 at a node).
TriangleMesh kept_part(const LayerGrid& grid, const Vector& level);

// At the tip of a leaflet columns come together, and some cross: the layer lies in pleats there, narrower
// than what the image shows. Points at triangles that are folded onto a neighbour or pass through another
// move towards the middle of their neighbours in the row, in rounds, and with each round that does not help
// those of one more column on both sides, until no triangle that reaches above the level line (`level` above
// 0 at a node) is left that is either. Where some are left, as where the layer itself turns back, the points
// of the best round are taken. The first row, which is the annulus, stays; no other point moves.
void unfold_rows(LayerGrid& grid, const Vector& level);

}  // namespace coapt
