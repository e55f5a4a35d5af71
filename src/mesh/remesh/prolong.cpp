#include "mesh/remesh/prolong.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <algorithm>

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

namespace {

std::vector<Matrix3d> triangle_gradients(const TriangleMesh& mesh, const Points& x) {
  std::vector<Matrix3d> gradients;
  gradients.reserve(static_cast<size_t>(mesh.triangle_count()));
  for (int t = 0; t < mesh.triangle_count(); ++t)
    gradients.push_back(motion_gradient(mesh.vertices, x, mesh.triangles.col(t)));
  return gradients;
}

}  // namespace

std::vector<Matrix3d> prolonged_gradients(const Coarsening& coarsening, const Points& x) {
  const TriangleMesh& coarse = coarsening.mesh;
  const std::vector<Matrix3d> of_triangle = triangle_gradients(coarse, x);
  const auto count = static_cast<size_t>(coarse.vertex_count());
  std::vector<Matrix3d> sum(count, Matrix3d::Zero());
  std::vector<double> area(count, 0);
  for (int t = 0; t < coarse.triangle_count(); ++t) {
    const double weight = area_vector(coarse.vertices, coarse.triangles.col(t)).norm();
    for (const int v : coarse.triangles.col(t)) {
      sum[static_cast<size_t>(v)] += weight * of_triangle[static_cast<size_t>(t)];
      area[static_cast<size_t>(v)] += weight;
    }
  }
  std::vector<Matrix3d> gradients;
  for (size_t v = 0; v < coarsening.host.size(); ++v) {
    const int host = coarsening.host[v];
    const auto own = static_cast<size_t>(std::max(coarsening.number[v], 0));
    gradients.push_back(host >= 0       ? of_triangle[static_cast<size_t>(host)]
                        : area[own] > 0 ? Matrix3d(sum[own] / area[own])
                                        : Matrix3d::Identity());
  }
  return gradients;
}

void fit_to_gradients(const Triangles& triangles, const Points& X, const std::vector<Matrix3d>& gradients,
                      const std::vector<char>& may_move, Points& x) {
  std::vector<int> unknown(may_move.size(), -1), vertices;
  for (const auto t : triangles.colwise())
    for (const int v : t)
      if (may_move[static_cast<size_t>(v)] != 0 && unknown[static_cast<size_t>(v)] < 0 &&
          area_vector(X, t).norm() > 0) {
        unknown[static_cast<size_t>(v)] = static_cast<int>(vertices.size());
        vertices.push_back(v);
      }
  const auto size = std::ssize(vertices);
  if (size == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(size, 3);
  for (const auto t : triangles.colwise()) {
    const Vec3 normal = area_vector(X, t);
    const double area = normal.norm();
    if (!(area > 0)) continue;
    Vec3 slopes[3];  // of the linear functions that are one at a corner
    Matrix3d gradient = Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      slopes[k] = normal.cross(Vec3(X.col(t[(k + 2) % 3]) - X.col(t[(k + 1) % 3]))) / (2 * area * area);
      gradient += gradients[static_cast<size_t>(t[k])] / 3;
    }
    for (int i = 0; i < 3; ++i) {
      const int row = unknown[static_cast<size_t>(t[i])];
      if (row < 0) continue;
      wanted.row(row) += (area * (gradient * slopes[i])).transpose();
      for (int j = 0; j < 3; ++j) {
        const int column = unknown[static_cast<size_t>(t[j])];
        const double weight = area * slopes[i].dot(slopes[j]);
        if (column >= 0)
          entries.emplace_back(row, column, weight);
        else
          wanted.row(row) -= weight * x.col(t[j]).transpose();
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) return;
  const Eigen::MatrixXd found = solver.solve(wanted);
  if (!found.allFinite()) return;
  for (Eigen::Index k = 0; k < size; ++k) x.col(vertices[static_cast<size_t>(k)]) = found.row(k).transpose();
}

Points prolonged(const Coarsening& coarsening, const Points& X, const Points& x) {
  const TriangleMesh& coarse = coarsening.mesh;
  const std::vector<Matrix3d> gradients = triangle_gradients(coarse, x);
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
