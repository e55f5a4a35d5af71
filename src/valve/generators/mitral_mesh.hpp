// The triangle mesh of the generated mitral valve.
#pragma once

#include "mesh/triangle_mesh.hpp"
#include "valve/generators/mitral_shape.hpp"

#include <vector>

namespace coapt {

struct MitralMesh {
  TriangleMesh leaflets;         // open; regions 0 "anterior", 1 "posterior"; normals to the ventricle
  Eigen::Matrix2Xd coordinates;  // (u, t) of each vertex on the MitralShape, 2 x vertex_count
  std::vector<int> annulus;      // the boundary loop t = 0 in the direction of boundary_loops
  std::vector<int> free_edge;    // the boundary loop t = 1, likewise
  std::vector<int> commissures;  // annulus vertices: anterolateral, posteromedial
};

// Staggered rows around the valve with equal steps of u; the height of the rows shrinks towards the free edge
// as the circumference does. Where the outline shears the triangles, edges are flipped until the mesh
// is Delaunay (sum of the two angles opposite each edge at most 180 degrees).
// The triangle count is within 5 % of `triangles`. Pre: triangles >= 100.
MitralMesh mitral_mesh(const MitralShape& shape, int triangles);

}  // namespace coapt
