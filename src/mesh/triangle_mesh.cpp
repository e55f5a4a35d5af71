#include "mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <tuple>

namespace coapt {

std::vector<Edge> edges(const Triangles& triangles) {
  struct Side {
    int a, b, triangle;
  };
  std::vector<Side> sides;
  sides.reserve(static_cast<size_t>(triangles.cols()) * 3);
  for (int t = 0; t < triangles.cols(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int i = triangles(k, t), j = triangles((k + 1) % 3, t);
      sides.push_back({std::min(i, j), std::max(i, j), t});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) {
    return std::tie(l.a, l.b, l.triangle) < std::tie(r.a, r.b, r.triangle);
  });
  std::vector<Edge> result;
  for (const Side& side : sides) {
    if (result.empty() || result.back().a != side.a || result.back().b != side.b)
      result.push_back({side.a, side.b, {}});
    result.back().triangles.push_back(side.triangle);
  }
  return result;
}

std::vector<std::vector<int>> boundary_loops(const Triangles& triangles) {
  std::map<int, int> next;  // along the boundary; ordered, so that loops start at their smallest vertex
  for (const Edge& edge : edges(triangles)) {
    if (edge.triangles.size() != 1) continue;
    const Eigen::Vector3i t = triangles.col(edge.triangles[0]);
    for (int k = 0; k < 3; ++k) {
      const int i = t[k], j = t[(k + 1) % 3];
      if (std::min(i, j) == edge.a && std::max(i, j) == edge.b) next[i] = j;
    }
  }
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int> loop;
    for (auto it = next.begin(); it != next.end(); it = next.find(loop.back())) {
      const int to = it->second;
      if (loop.empty()) loop.push_back(it->first);
      next.erase(it);
      if (to == loop.front()) break;
      loop.push_back(to);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

Vec3 area_vector(const Points& x, const Eigen::Vector3i& t) {
  const Vec3 a = x.col(t[0]);
  return 0.5 * (x.col(t[1]) - a).cross(x.col(t[2]) - a);
}

double surface_area(const Points& x, const Triangles& triangles) {
  double sum = 0;
  for (int t = 0; t < triangles.cols(); ++t) sum += area_vector(x, triangles.col(t)).norm();
  return sum;
}

Vector nodal_areas(const Points& x, const Triangles& triangles) {
  Vector areas = Vector::Zero(x.cols());
  for (int t = 0; t < triangles.cols(); ++t) {
    const double third = area_vector(x, triangles.col(t)).norm() / 3;
    for (int k = 0; k < 3; ++k) areas[triangles(k, t)] += third;
  }
  return areas;
}

double mean_edge_length(const Points& x, const Triangles& triangles) {
  double sum = 0;
  const std::vector<Edge> all = edges(triangles);
  for (const Edge& edge : all) sum += (x.col(edge.a) - x.col(edge.b)).norm();
  return all.empty() ? 0 : sum / static_cast<double>(all.size());
}

double bounding_box_diagonal(const Points& x) {
  if (x.cols() == 0) return 0;
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
}

}  // namespace coapt
