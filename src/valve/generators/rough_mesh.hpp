// Triangles as people have them: of uneven size and shape, with slivers.
#pragma once

#include "mesh/triangle_mesh.hpp"
#include "valve/generators/rough_surface.hpp"

#include <vector>

namespace coapt {

inline constexpr double kGreatestAspect = 900;  // of a triangle: longest edge over height

struct RoughMesh {
  TriangleMesh leaflets;         // open; one region for each leaflet; normals to the ventricle
  Eigen::Matrix2Xd coordinates;  // (u, t) of each vertex on the surface, 2 x vertex_count
  std::vector<int> annulus;      // the boundary loop t = 0 in the direction of boundary_loops
  std::vector<int> free_edge;    // the boundary loop t = 1, likewise
  std::vector<int> commissures;  // annulus vertices, in order of the leaflets
};

// A coarse grid, refined by splitting edges at random places where a random density asks for it, and made
// Delaunay; then jittered, with some edges turned the wrong way, and with about one triangle in fifty a
// sliver: needles from edges split close to an end, caps from vertices close to an edge, aspects from 30
// to kGreatestAspect, evenly in their logarithm. The triangle count is within 5 % of `triangles`.
// Pre: triangles >= 250.
RoughMesh rough_mesh(const RoughSurface& surface, int triangles, RandomSource& random);

}  // namespace coapt
