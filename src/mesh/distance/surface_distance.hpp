// How far one surface lies from another: mean, 95th percentile and maximum.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// Samples of a surface are its vertices, the middles of its edges and the centroids of its triangles. In mean
// and percentile they weigh 1/20, 2/15 and 9/20 of the area of each triangle they belong to (the quadrature
// rule of degree 3 on these seven points), so that a fine region does not outweigh a coarse one.
// The distance of each sample is that to the closest point of the other surface, unsigned.
struct SurfaceDistance {
  double mean = 0;          // area-weighted [length]
  double p95 = 0;           // 95 % of the area lie closer than this [length]
  double max = 0;           // over all samples [length]
  int sample_count = 0;     // of those that are counted
  Vector vertex_distances;  // of every vertex of `from`, also of those without a triangle [length]
};

// Vertices whose place means nothing, by number in any order: samples on an edge or a triangle of such a
// vertex of `from`, and samples whose closest point lies on a triangle of such a vertex of `to`, are not
// counted. Numbers beyond the vertices of the surface are passed over.
struct UncountedVertices {
  std::vector<int> from = {}, to = {};
};

// One direction, from a surface to another; call twice for both.
// Figures are NaN where no sample of any area is counted. Throws InputError when `from` has no area or `to`
// no triangle. Pre: all positions are finite.
SurfaceDistance surface_distance(const TriangleMesh& from, const TriangleMesh& to,
                                 const UncountedVertices& uncounted = {});

// From points, all of equal weight. Throws InputError when there is no point, or `to` has no triangle.
SurfaceDistance surface_distance(const Points& from, const TriangleMesh& to);

}  // namespace coapt
