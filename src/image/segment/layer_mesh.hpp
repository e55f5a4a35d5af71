// A triangle mesh of the part of a layer that is leaflet.
#pragma once

#include "image/segment/layer_grid.hpp"
#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

struct LayerMesh {
  TriangleMesh mesh;           // normals to the ventricle
  std::vector<int> annulus;    // closed loop of vertices in the direction of boundary_loops
  std::vector<int> free_edge;  // likewise
  Eigen::Matrix3Xi nodes;      // of each vertex: three points of the grid
  Points weights;              // and the share of each
};

// The layer cut off where a column has the length that `ends` gives (one for each column) [mm], with
// triangles of about equal size, edges of about `edge_length` [mm]: coarsened, then made round. One manifold
// layer with two rims. Throws InputError where the layer has another number of rims: the leaflets reach down
// to the end of what was tracked.
LayerMesh layer_mesh(const LayerGrid& grid, const Vector& ends, double edge_length);

// A value of every point of the grid, at the vertices.
Vector at_vertices(const LayerMesh& mesh, const Vector& of_nodes);

}  // namespace coapt
