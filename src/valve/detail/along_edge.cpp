#include "valve/detail/along_edge.hpp"

#include "mesh/vertex_graph.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <queue>
#include <utility>

namespace coapt {
namespace {

constexpr double kMostCotangent = 1000;  // of a triangle that has next to no area

std::vector<char> joined_to(const TriangleMesh& mesh, std::vector<int> reached) {
  const VertexGraph graph = vertex_graph(mesh.triangles, mesh.vertex_count());
  std::vector<char> is_joined(static_cast<size_t>(mesh.vertex_count()), 0);
  for (const int v : reached) is_joined[static_cast<size_t>(v)] = 1;
  while (!reached.empty()) {
    const int v = reached.back();
    reached.pop_back();
    for (const int w : graph.of(v))
      if (is_joined[static_cast<size_t>(w)] == 0) {
        is_joined[static_cast<size_t>(w)] = 1;
        reached.push_back(w);
      }
  }
  return is_joined;
}

// The cotangent of the angle at the apex, also where it is obtuse: that the circle's coordinates go on evenly
// over a flat piece, however it is cut into triangles, depends on it.
double weight_at(const TriangleMesh& mesh, int apex, int a, int b) {
  const Vec3 u = mesh.vertices.col(a) - mesh.vertices.col(apex),
             v = mesh.vertices.col(b) - mesh.vertices.col(apex);
  const double twice_area = u.cross(v).norm(), cosine = u.dot(v);
  return std::abs(cosine) < kMostCotangent * twice_area ? cosine / twice_area
                                                        : std::copysign(kMostCotangent, cosine);
}

}  // namespace

EdgeLengths edge_lengths(const TriangleMesh& mesh, const std::vector<int>& edge) {
  const VertexGraph graph = vertex_graph(mesh.triangles, mesh.vertex_count());
  EdgeLengths lengths;
  for (size_t k = 0; k < edge.size(); ++k) {
    const int v = edge[k], next = edge[(k + 1) % edge.size()];
    lengths.along.push_back(lengths.length);
    const auto near = graph.of(v);
    if (std::find(near.begin(), near.end(), next) != near.end())
      lengths.length += (mesh.vertices.col(v) - mesh.vertices.col(next)).norm();
  }
  return lengths;
}

// Dijkstra.
std::vector<double> distances_along_edges(const TriangleMesh& mesh, const std::vector<int>& sources) {
  const VertexGraph graph = vertex_graph(mesh.triangles, mesh.vertex_count());
  std::vector<double> result(static_cast<size_t>(mesh.vertex_count()), kInfinity);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const int source : sources) {
    result[static_cast<size_t>(source)] = 0;
    open.emplace(0, source);
  }
  while (!open.empty()) {
    const auto [length, v] = open.top();
    open.pop();
    if (length > result[static_cast<size_t>(v)]) continue;
    for (const int w : graph.of(v)) {
      const double way = length + (mesh.vertices.col(v) - mesh.vertices.col(w)).norm();
      if (way >= result[static_cast<size_t>(w)]) continue;
      result[static_cast<size_t>(w)] = way;
      open.emplace(way, w);
    }
  }
  return result;
}

std::vector<double> along_edge(const TriangleMesh& mesh, const std::vector<int>& edge,
                               const EdgeLengths& lengths) {
  const auto& [along, length] = lengths;
  const Eigen::Index n = mesh.vertex_count();
  const double turn = 2 * std::numbers::pi / std::max(length, 1e-300);
  std::vector<char> is_free = joined_to(mesh, edge);
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
  for (size_t k = 0; k < edge.size(); ++k) {
    is_free[static_cast<size_t>(edge[k])] = 0;
    right.row(edge[k]) << std::cos(turn * along[k]), std::sin(turn * along[k]);
  }
  const Eigen::MatrixX2d held = right;
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < n; ++v)
    if (is_free[static_cast<size_t>(v)] == 0) entries.emplace_back(v, v, 1.0);
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles((k + 1) % 3, t), b = mesh.triangles((k + 2) % 3, t);
      const double weight = weight_at(mesh, mesh.triangles(k, t), a, b);
      for (const auto& [v, other] : {std::pair(a, b), std::pair(b, a)}) {
        if (is_free[static_cast<size_t>(v)] == 0) continue;
        entries.emplace_back(v, v, weight);
        if (is_free[static_cast<size_t>(other)] != 0)
          entries.emplace_back(v, other, -weight);
        else
          right.row(v) += weight * held.row(other);
      }
    }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const Eigen::MatrixX2d places = factor.solve(right);
  std::vector<double> result(static_cast<size_t>(n), 0);
  for (Eigen::Index v = 0; v < n; ++v) {
    const double angle = std::atan2(places(v, 1), places(v, 0));
    if (std::isfinite(angle))
      result[static_cast<size_t>(v)] = (angle < 0 ? angle / turn + length : angle / turn);
  }
  return result;
}

}  // namespace coapt
