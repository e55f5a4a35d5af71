// How triangles hang together: components, sides, seams; and the repairs that need no judgement.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// Parts of a mesh that share no vertex, numbered by their smallest vertex.
struct Components {
  int count = 0;
  std::vector<int> of_triangle;
  std::vector<int> of_vertex;  // -1: the vertex is on no triangle
};

// Pre (here and below): corner indices are in range.
Components connected_components(const TriangleMesh& mesh);

// Which triangles to turn over so that neighbours across edges with two triangles agree. In each part of the
// surface that such edges connect, the side with the larger area stays.
struct Orientation {
  std::vector<bool> flip;  // of each triangle
  int flip_count = 0;
  std::vector<int> one_sided;  // triangles at which a part contradicts itself (a Moebius strip)
};
Orientation consistent_orientation(const TriangleMesh& mesh);

// Throws InputError when a part is one-sided.
TriangleMesh orient_consistently(const TriangleMesh& mesh);

// The first vertex at the same position, bit by bit (0 and -0 are the same), for each vertex.
std::vector<int> first_coincident(const Points& vertices);

// Joins vertices at the same position. Vertices keep their order; new_index tells where each one went.
struct WeldedMesh {
  TriangleMesh mesh;
  std::vector<int> new_index;
  int removed = 0;
};
WeldedMesh weld(const TriangleMesh& mesh);

// Vertices at which two or more fans of triangles meet that share no edge there.
std::vector<int> bowtie_vertices(const TriangleMesh& mesh);

}  // namespace coapt
