// A coarser mesh on some of the vertices of a mesh, and where each of the others lies on it.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <array>
#include <vector>

namespace coapt {

struct CoarsenOptions {
  double share = 0.25;    // wanted triangles over those given
  std::vector<int> keep;  // vertices that stay
  // Kind of each vertex, or empty. Vertices of a kind other than 0 (supports, say) are thinned out among
  // themselves along the boundary, and in areas where all neighbours are of the kind; the others stay.
  std::vector<int> kinds;
  // Edges that form lines; these are thinned out along themselves, as boundaries and region borders are.
  std::vector<std::array<int, 2>> lines;
};

struct Coarsening {
  TriangleMesh mesh;        // its vertices in the order of the fine ones
  std::vector<int> kept;    // fine vertex of each coarse one, ascending
  std::vector<int> number;  // coarse vertex of each fine one; -1: gone
  // Of each vertex that is gone: the coarse triangle that took its place, and the barycentric coordinates in
  // it of its closest point. Found in the neighbourhood of each collapse, so that a sheet that lies close to
  // another is never mistaken for it. -1 for vertices that stay.
  std::vector<int> host;
  Points weights;                         // 3 x fine vertex_count
  std::vector<std::array<int, 2>> lines;  // coarse edges of boundary, region borders and the given lines
};

// Removes vertices by collapsing edges into one of their ends, in rounds of collapses that do not touch each
// other, best first: short new edges, relative to those that the mesh had there, and round triangles; in
// between edges are flipped to the Delaunay side. Boundary loops, regions, orientation and grading are kept,
// nothing folds over, and corners of lines and vertices where the mesh is not manifold stay. Where this does
// not reach the wanted number the mesh is returned less coarse. Deterministic, and the same
// surface whatever the order of vertices and triangles, and whatever the frame unless the mesh is symmetric;
// triangles come in the order of their place. O(n log n). Pre: corner indices are in range, coordinates are
// finite, share is in (0, 1].
Coarsening coarsen(const TriangleMesh& mesh, const CoarsenOptions& options = {});

}  // namespace coapt
