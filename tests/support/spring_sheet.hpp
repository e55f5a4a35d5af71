// Membranes of springs for tests, put together triangle by triangle and never joined by edge.
#pragma once

#include "energy/element_term.hpp"
#include "energy/kernels/spring.hpp"
#include "mesh/triangle_mesh.hpp"

#include <memory>
#include <vector>

namespace coapt {

struct SpringSheet {
  BilinearLine fibre, cross;   // along the direction and across it
  Vec3 direction = {1, 0, 0};  // of the fibre, in the plane of every triangle
  double thickness = 1;
  double smoothing = 0.002;
  bool resists = true;
};

inline SpringSheet linear_springs(double young, double thickness = 1) {
  SpringSheet sheet;
  sheet.fibre.young = sheet.cross.young = young;
  sheet.thickness = thickness;
  return sheet;
}

// The parts of all triangles, three of each, and their nodes.
inline std::unique_ptr<ElementTerm<Spring>> spring_term(const Points& X, const Triangles& triangles,
                                                        const SpringSheet& sheet) {
  std::vector<int> nodes;
  std::vector<Spring::Rest> rest;
  for (const auto& t : triangles.colwise())
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const Vec3 along = X.col(b) - X.col(a);
      const double share = along.normalized().dot(sheet.direction);
      nodes.insert(nodes.end(), {a, b});
      rest.push_back(Spring::rest(along.norm(), area_vector(X, t).norm(), sheet.thickness,
                                  blended(sheet.fibre, sheet.cross, share * share), sheet.smoothing,
                                  sheet.resists));
    }
  return std::make_unique<ElementTerm<Spring>>("springs", std::move(nodes), std::move(rest));
}

// Equilateral triangles of side 1 in the plane z = 0: `rows` rows of `columns` edges along x, every other row
// set off by half an edge, so that the sides are zigzag lines. Node i of row j is i + (columns + 1) j.
inline TriangleMesh lattice_mesh(int columns, int rows) {
  TriangleMesh mesh;
  const int width = columns + 1;
  mesh.vertices.resize(3, width * (rows + 1));
  mesh.triangles.resize(3, 2 * columns * rows);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < width; ++i)
      mesh.vertices.col(i + width * j) << i + 0.5 * (j % 2), j * std::sqrt(0.75), 0;
  int t = 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = i + width * j, b = a + 1, c = a + width, d = c + 1;
      if (j % 2 == 0) {
        mesh.triangles.col(t++) << a, b, c;
        mesh.triangles.col(t++) << b, d, c;
      } else {
        mesh.triangles.col(t++) << a, d, c;
        mesh.triangles.col(t++) << a, b, d;
      }
    }
  return mesh;
}

}  // namespace coapt
