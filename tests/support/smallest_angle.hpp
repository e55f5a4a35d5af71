// How good the triangles of a generated mesh are.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {

// Of all triangles [degrees].
inline double smallest_angle(const TriangleMesh& mesh) {
  double least = 180;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3 at = mesh.vertices.col(mesh.triangles(k, t));
      const Vec3 u = mesh.vertices.col(mesh.triangles((k + 1) % 3, t)) - at;
      const Vec3 v = mesh.vertices.col(mesh.triangles((k + 2) % 3, t)) - at;
      least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / std::numbers::pi);
    }
  return least;
}

}  // namespace coapt
