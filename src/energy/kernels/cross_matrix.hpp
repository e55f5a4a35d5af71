// The matrix of a cross product.
#pragma once

#include "core/types.hpp"

namespace coapt {

// u -> v x u.
inline Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return m;
}

}  // namespace coapt
