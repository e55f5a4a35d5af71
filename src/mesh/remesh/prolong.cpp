#include "mesh/remesh/prolong.hpp"

#include <Eigen/LU>

namespace coapt {
namespace {

using Eigen::Matrix3d;

// Two edges of a triangle and its unit normal, as columns.
Matrix3d frame(const Points& x, const Eigen::Vector3i& t) {
  Matrix3d frame;
  frame.col(0) = x.col(t[1]) - x.col(t[0]);
  frame.col(1) = x.col(t[2]) - x.col(t[0]);
  frame.col(2) = area_vector(x, t).normalized();
  return frame;
}

}  // namespace

Matrix3d motion_gradient(const Points& X, const Points& x, const Eigen::Vector3i& t) {
  Matrix3d inverse;
  bool is_invertible = false;
  frame(X, t).computeInverseWithCheck(inverse, is_invertible, 0);
  return is_invertible ? Matrix3d(frame(x, t) * inverse) : Matrix3d::Identity();
}

Points prolonged(const Coarsening& coarsening, const Points& X, const Points& x) {
  const TriangleMesh& coarse = coarsening.mesh;
  std::vector<Matrix3d> gradients;  // of the motion of each coarse triangle
  gradients.reserve(static_cast<size_t>(coarse.triangle_count()));
  for (int t = 0; t < coarse.triangle_count(); ++t)
    gradients.push_back(motion_gradient(coarse.vertices, x, coarse.triangles.col(t)));
  Points result(3, X.cols());
  for (Eigen::Index v = 0; v < X.cols(); ++v) {
    const int host = coarsening.host[static_cast<size_t>(v)];
    if (host < 0) {
      result.col(v) = x.col(coarsening.number[static_cast<size_t>(v)]);
      continue;
    }
    const Eigen::Vector3i t = coarse.triangles.col(host);
    const auto weights = coarsening.weights.col(v);
    const Vec3 from = coarse.vertices(Eigen::all, t) * weights, to = x(Eigen::all, t) * weights;
    result.col(v) = to + gradients[static_cast<size_t>(host)] * (X.col(v) - from);
  }
  return result;
}

}  // namespace coapt
