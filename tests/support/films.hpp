// Films of constant tension, and the cylinder between two rings.
#pragma once

#include "energy/element_term.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"

#include <cmath>
#include <numbers>

namespace coapt {

inline std::unique_ptr<EnergyTerm> film_term(const Triangles& triangles, double tension = 1) {
  return std::make_unique<ElementTerm<SurfaceTension>>(
      "film", triangle_nodes(triangles), std::vector<SurfaceTension::Rest>(triangles.cols(), {tension}));
}

inline FixedMask fixed_boundary(const TriangleMesh& mesh) {
  std::vector<int> rim;
  for (const Edge& edge : edges(mesh.triangles))
    if (edge.triangles.size() == 1) rim.insert(rim.end(), {edge.a, edge.b});
  return fixed_nodes(mesh.vertex_count(), rim);
}

// Around the z axis, its middle at z = 0; 2 `around` triangles in each row, their diagonals alternating. Node
// i + around j is that of column i and row j.
inline TriangleMesh cylinder_mesh(int around, int rows, double radius, double height) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, around * (rows + 1));
  mesh.triangles.resize(3, 2 * around * rows);
  int t = 0;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const int a = i + around * j, b = (i + 1) % around + around * j, c = b + around, d = a + around;
      mesh.vertices.col(a) =
          Vec3(radius * std::cos(angle), radius * std::sin(angle), height * (1.0 * j / rows - 0.5));
      if (j == rows) continue;
      if ((i + j) % 2 == 0) {
        mesh.triangles.col(t++) << a, b, c;
        mesh.triangles.col(t++) << a, c, d;
      } else {
        mesh.triangles.col(t++) << a, b, d;
        mesh.triangles.col(t++) << b, c, d;
      }
    }
  return mesh;
}

}  // namespace coapt
