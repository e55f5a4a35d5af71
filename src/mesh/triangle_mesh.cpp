#include "mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <compare>
#include <map>

namespace coapt {

std::vector<Edge> edges(const Triangles& triangles) {
  const auto visit_sides = [&](const auto& visit) {
    for (int t = 0; t < triangles.cols(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int i = triangles(k, t), j = triangles((k + 1) % 3, t);
        visit(std::min(i, j), std::max(i, j), t);
      }
  };
  struct Side {
    int b, triangle;
    auto operator<=>(const Side&) const = default;
  };
  const int vertices = triangles.size() == 0 ? 0 : triangles.maxCoeff() + 1;
  std::vector<int> first(static_cast<size_t>(vertices) + 1, 0);  // of the sides of each smaller vertex
  visit_sides([&](int a, int, int) { ++first[a + 1]; });
  for (int a = 0; a < vertices; ++a) first[a + 1] += first[a];
  std::vector<Side> sides(static_cast<size_t>(triangles.size()));
  std::vector<int> next = first;
  visit_sides([&](int a, int b, int t) { sides[next[a]++] = {b, t}; });

  std::vector<Edge> result;
  result.reserve(sides.size() / 2);
  for (int a = 0; a < vertices; ++a) {
    const auto end = sides.begin() + first[a + 1];
    std::sort(sides.begin() + first[a], end);
    for (auto side = sides.begin() + first[a]; side != end;) {
      const auto other = std::find_if(side, end, [&](const Side& it) { return it.b != side->b; });
      Edge& edge = result.emplace_back(Edge{a, side->b, {}});
      edge.triangles.reserve(static_cast<size_t>(other - side));
      for (; side != other; ++side) edge.triangles.push_back(side->triangle);
    }
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
