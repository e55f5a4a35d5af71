// The small irregular patch on which element laws are tested.
#pragma once

#include "support/meshes.hpp"

#include <Eigen/Core>

namespace coapt {

inline TriangleMesh patch() {
  TriangleMesh mesh = grid_mesh(2, 2);
  mesh.vertices = shaken(mesh.vertices, 0.08, 3);
  return mesh;
}

inline Eigen::Matrix3d deformation(double f11, double f12, double f22) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 0) = f11;
  f(0, 1) = f12;
  f(1, 1) = f22;
  return f;
}

}  // namespace coapt
