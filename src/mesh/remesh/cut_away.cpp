#include "mesh/remesh/cut_away.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace coapt {
namespace {

// Levels with those near the line set to zero.
Vector snapped(const TriangleMesh& mesh, const Vector& level, double snap) {
  Vector result = level;
  for (const Edge& edge : edges(mesh.triangles))
    for (const auto& [near, far] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)})
      if (level[near] * level[far] < 0 && std::abs(level[near]) < snap * std::abs(level[far] - level[near]))
        result[near] = 0;
  return result;
}

class Cutter {
 public:
  // level: snapped; as_given: before that.
  Cutter(const TriangleMesh& mesh, const Vector& level, const Vector& as_given)
      : old_(mesh), level_(level), as_given_(as_given) {
    result_.mesh.region_names = mesh.region_names;
    result_.mesh.vertices = mesh.vertices;
    result_.is_on_cut.assign(static_cast<size_t>(mesh.vertex_count()), 0);
    for (int v = 0; v < mesh.vertex_count(); ++v) result_.is_on_cut[static_cast<size_t>(v)] = level[v] == 0;
  }

  CutMesh run() {
    for (int t = 0; t < old_.triangle_count(); ++t) add_kept_part(t);
    TriangleMesh& mesh = result_.mesh;
    mesh.triangles.resize(3, static_cast<Eigen::Index>(corners_.size()));
    for (size_t k = 0; k < corners_.size(); ++k)
      mesh.triangles.col(static_cast<Eigen::Index>(k)) << corners_[k][0], corners_[k][1], corners_[k][2];
    const auto first = mesh.vertices.cols();
    mesh.vertices.conservativeResize(3, first + static_cast<Eigen::Index>(added_.size()));
    for (size_t k = 0; k < added_.size(); ++k)
      mesh.vertices.col(first + static_cast<Eigen::Index>(k)) = added_[k];
    result_.is_on_cut.resize(static_cast<size_t>(mesh.vertices.cols()), 1);
    return std::move(result_);
  }

 private:
  // The corners of the part that stays, in the triangle's sense: a polygon of up to four.
  void add_kept_part(int t) {
    const Eigen::Vector3i c = old_.triangles.col(t);
    if (level_[c[0]] <= 0 && level_[c[1]] <= 0 && level_[c[2]] <= 0) {
      // With all its corners on the line it belongs to the side that it was on.
      const bool is_on_line = level_[c[0]] == 0 && level_[c[1]] == 0 && level_[c[2]] == 0;
      if (is_on_line && as_given_[c[0]] + as_given_[c[1]] + as_given_[c[2]] > 0) add({c[0], c[1], c[2]}, t);
      return;
    }
    std::vector<int> polygon;
    for (int k = 0; k < 3; ++k) {
      const int a = c[k], b = c[(k + 1) % 3];
      if (level_[a] >= 0) polygon.push_back(a);
      if (level_[a] * level_[b] < 0) polygon.push_back(crossing(a, b));
    }
    if (polygon.size() == 3) add({polygon[0], polygon[1], polygon[2]}, t);
    if (polygon.size() != 4) return;
    // The shorter diagonal.
    const auto apart = [&](size_t i, size_t j) {
      return (position(polygon[i]) - position(polygon[j])).norm();
    };
    const size_t s = apart(0, 2) <= apart(1, 3) ? 0 : 1;
    add({polygon[s], polygon[s + 1], polygon[s + 2]}, t);
    add({polygon[s], polygon[s + 2], polygon[(s + 3) % 4]}, t);
  }

  void add(const std::array<int, 3>& corners, int source) {
    corners_.push_back(corners);
    result_.source_triangle.push_back(source);
    if (!old_.regions.empty()) result_.mesh.regions.push_back(old_.regions[static_cast<size_t>(source)]);
  }

  int crossing(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [place, is_new] =
        crossings_.try_emplace({low, high}, old_.vertex_count() + static_cast<int>(added_.size()));
    if (is_new) {
      const double part = level_[low] / (level_[low] - level_[high]);
      added_.push_back(old_.vertices.col(low) + part * (old_.vertices.col(high) - old_.vertices.col(low)));
    }
    return place->second;
  }

  Vec3 position(int v) const {
    return v < old_.vertex_count() ? Vec3(old_.vertices.col(v))
                                   : added_[static_cast<size_t>(v - old_.vertex_count())];
  }

  const TriangleMesh& old_;
  const Vector &level_, &as_given_;
  CutMesh result_;
  std::vector<std::array<int, 3>> corners_;
  std::vector<Vec3> added_;
  std::map<std::pair<int, int>, int> crossings_;  // by edge, smaller vertex first
};

}  // namespace

CutMesh cut_away(const TriangleMesh& mesh, const Vector& level, double snap) {
  const Vector levels = snapped(mesh, level, snap);
  return Cutter(mesh, levels, level).run();
}

void divide_edge(TriangleMesh& mesh, int triangle, int a, int b, double fraction) {
  const int middle = mesh.vertex_count(), added = mesh.triangle_count();
  mesh.vertices.conservativeResize(3, middle + 1);
  mesh.vertices.col(middle) = mesh.vertices.col(a) + fraction * (mesh.vertices.col(b) - mesh.vertices.col(a));
  mesh.triangles.conservativeResize(3, added + 1);
  mesh.triangles.col(added) = mesh.triangles.col(triangle);
  for (int k = 0; k < 3; ++k) {
    if (mesh.triangles(k, triangle) == b) mesh.triangles(k, triangle) = middle;
    if (mesh.triangles(k, added) == a) mesh.triangles(k, added) = middle;
  }
  if (!mesh.regions.empty()) mesh.regions.push_back(mesh.regions[static_cast<size_t>(triangle)]);
}

}  // namespace coapt
