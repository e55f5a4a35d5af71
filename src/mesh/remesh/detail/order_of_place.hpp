// A mesh in an order of its own, so that what is made of it does not depend on the numbers of its vertices
// and triangles. Private to this room.
#pragma once

#include "mesh/remesh/coarsen.hpp"

#include <vector>

namespace coapt::coarsening {

struct OrderedMesh {
  TriangleMesh mesh;        // vertices by x, y and z; triangles by their vertices, least one first
  CoarsenOptions options;   // in the numbers of this mesh
  std::vector<int> vertex;  // given vertex of each one here
};

// Vertices at one place keep their order, and so do triangles with the same corners.
OrderedMesh in_order_of_place(const TriangleMesh& mesh, const CoarsenOptions& options);

// The coarsening of the ordered mesh in the numbers of the given one.
Coarsening renumbered(const Coarsening& coarsening, const OrderedMesh& ordered, const TriangleMesh& given);

}  // namespace coapt::coarsening
