// Fibre directions on a surface, from what is known of them along some edges and at some vertices.
#pragma once

#include "mesh/numbering.hpp"
#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// A direction that is known: along or across the edge between two vertices, in the surface, or a vector at
// one vertex, of any length, whose part in the surface counts. No sign: d and -d are the same fibre.
struct FibreGuide {
  enum class Kind { Along, Across, AtVertex };
  Kind kind = Kind::Along;
  int a = 0, b = 0;               // the edge; AtVertex: the vertex a
  Vec3 direction = Vec3::Zero();  // AtVertex
};

struct FibreField {
  Points directions = Points(3, 0);  // unit, in the plane of each triangle, 3 x triangle_count; the sign
                                     // means nothing
  Vector anisotropy;                 // per triangle: (l1 - l2)/(l1 + l2) of the eigenvalues of M, in [0, 1];
                                     // 0: no direction is better than another
};

struct FibreOptions {
  bool joins_regions = false;  // false: each region on its own, as if cut out
  Numbering numbering = {};    // of vertices and triangles in messages
};

// Laplace's equation for M = d (x) d on the surface, natural conditions where nothing is known, and the first
// eigenvector of M in each triangle. Source: Toma et al. 2016, eq. 3, but M is a tensor of the surface that
// is carried along it (Levi-Civita), not one of space: the answer does not depend on how a sheet is bent, and
// is that of the flat sheet on every developable surface. In the plane both are the same. See docs/theory.md.
//
// Linear Crouzeix-Raviart elements, M at the middle of each edge in the frame of that edge, cotangent weights
// as they are (none is clamped: the matrix is positive definite whatever the triangles' shapes, and linear M
// is reproduced exactly on slivers). A guide along an edge holds at its middle; of vertices with vectors an
// edge between two takes the mean of both M, and one without such a neighbour holds on all edges that it
// ends. Later guides win over earlier ones on the same edge. Orientation and non-manifold edges do not
// matter; on the latter M is one.
//
// Throws InputError with all defects: a guide for vertices that no edge joins or that are on no triangle, a
// vector of length zero or normal to the surface, a triangle without area, and a connected part (of a region)
// without any guide. O(n^1.5). Pre: corner indices are in range, coordinates are finite.
FibreField fibre_field(const TriangleMesh& mesh, const std::vector<FibreGuide>& guides,
                       const FibreOptions& options = {});

// The field on a coarser mesh on some of the vertices: M of the triangles around the corners (those of the
// same region where there are some) in the plane of each coarse triangle. kept: fine vertex of each coarse
// one.
FibreField coarsened(const FibreField& fine, const TriangleMesh& fine_mesh, const TriangleMesh& coarse_mesh,
                     const std::vector<int>& kept);

// Directions in space, one per triangle, of any length, turned into a field: their part in each triangle's
// plane; anisotropy 1. Throws InputError naming `where` and the triangles whose direction is zero or normal
// to them, or when the number of directions is not that of the triangles.
FibreField in_surface(const Points& directions, const TriangleMesh& mesh, const std::string& where,
                      Numbering numbering = {});

// Where unit directions in the triangles at X point when the nodes are at x: F d, normalised. A triangle that
// has collapsed along d keeps d.
Points carried(const Points& directions, const Triangles& triangles, const Points& X, const Points& x);

}  // namespace coapt
