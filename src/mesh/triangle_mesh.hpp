// A triangle mesh as plain data, and the plain functions that read it.
#pragma once

#include "core/types.hpp"

#include <string>
#include <vector>

namespace coapt {

struct TriangleMesh {
  Points vertices = Points(3, 0);         // 3 x vertex_count [length]
  Triangles triangles = Triangles(3, 0);  // 3 x triangle_count, counter-clockwise seen from the normal's side
  std::vector<int> regions;               // region of each triangle; empty: the mesh has one unnamed region
  std::vector<std::string> region_names;  // indexed by the entries of `regions`

  int vertex_count() const { return static_cast<int>(vertices.cols()); }
  int triangle_count() const { return static_cast<int>(triangles.cols()); }
};

// An undirected edge and the triangles on it. A manifold inner edge has two, a boundary edge one.
struct Edge {
  int a = 0, b = 0;            // a < b
  std::vector<int> triangles;  // in ascending order
};

// All edges in ascending order of (a, b).
std::vector<Edge> edges(const Triangles& triangles);

// The boundary as closed loops of vertices, each in the direction in which its triangles run along
// it; loops are ordered by their smallest vertex and start there.
// Pre: the mesh is manifold and consistently oriented (see mesh_check.hpp); otherwise loops may be cut
// into open chains, which are returned as they are.
std::vector<std::vector<int>> boundary_loops(const Triangles& triangles);

// Area vector (half the cross product) of one triangle: its length is the area, its direction the normal.
Vec3 area_vector(const Points& x, const Eigen::Vector3i& triangle);

// Sum of the triangle areas [length^2].
double surface_area(const Points& x, const Triangles& triangles);

// A third of the area of the triangles around each node, 1 x node_count [length^2].
Vector nodal_areas(const Points& x, const Triangles& triangles);

// Mean length of the edges [length]; 0 for a mesh without triangles.
double mean_edge_length(const Points& x, const Triangles& triangles);

// Length of the diagonal of the axis-aligned bounding box [length]; 0 for no points.
double bounding_box_diagonal(const Points& x);

}  // namespace coapt
