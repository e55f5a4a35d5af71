// Where the branch point of a chord may hang so that no segment passes through the open leaflets.
#pragma once

#include "mesh/triangle_mesh.hpp"
#include "valve/generators/chord_junctions.hpp"

#include <vector>

namespace coapt {

// A chord's fan on open leaflets: the trunk from `limits.ends` column 0, the papillary tip, to the branch
// point, and branches from there to `vertices`, whose positions are the other columns.
struct OpenFan {
  const TriangleMesh& leaflets;  // normals to the ventricle
  std::vector<int> vertices;
  std::vector<bool>
      is_inside;  // of each: no vertex of the free edge, so its branch leaves on the ventricular side
};

// The branch point nearest to `start` from which no segment passes through a leaflet and none is longer than
// its rest length of `limits`; where there is none, the one that exceeds the lengths least. Triangles at the
// end of a branch do not count, but a branch that ends inside leaves on the ventricular side of its vertex.
// `start` itself if nothing within a quarter more than the trunk's length will do. The places that are tried
// are the same on every platform. Pre: limits.ends as above.
Vec3 place_clear_junction(const Vec3& start, const JunctionLimits& limits, const OpenFan& fan);

}  // namespace coapt
