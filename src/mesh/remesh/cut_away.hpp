// A surface cut along a level line, and what lies beyond it taken away.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

struct CutMesh {
  TriangleMesh mesh;                 // vertices keep their numbers, those of the cut come last
  std::vector<int> source_triangle;  // of each triangle: the one that it is, or is a part of
  std::vector<char> is_on_cut;       // of each vertex: 1 where it lies on the cut
};

// Takes away the part where `level`, linear on each triangle, is below zero. Triangles that the level line
// crosses are divided along it; a vertex nearer to the line than `snap`, as a part of an edge from it (below
// 1/2), counts as on the line, so that no slivers arise: the cut may then leave the line by that much.
// Vertices that belong to nothing any more stay, as isolated points. Pre: one level per vertex, finite. O(n
// log n).
CutMesh cut_away(const TriangleMesh& mesh, const Vector& level, double snap);

// The same surface with the boundary edge between a and b divided at a fraction of the way from a; the new
// vertex is the last. `triangle` is the one on that edge. Pre: it has both ends.
void divide_edge(TriangleMesh& mesh, int triangle, int a, int b, double fraction);

}  // namespace coapt
