#include "mesh/distance/triangle_tree.hpp"

#include "mesh/distance/triangle_distance.hpp"

#include <algorithm>

namespace coapt {
namespace {

bool are_near(const Bounds& a, const Bounds& b, double margin) {
  return (a.low - b.high <= margin).all() && (b.low - a.high <= margin).all();
}

double squared_distance(const Bounds& box, const Vec3& p) {
  return (box.low - p.array()).max(p.array() - box.high).max(0).matrix().squaredNorm();
}

Points centres(const std::vector<Bounds>& boxes) {
  Points result(3, std::ssize(boxes));
  for (size_t t = 0; t < boxes.size(); ++t)
    result.col(static_cast<Eigen::Index>(t)) = (boxes[t].low + boxes[t].high) / 2;
  return result;
}

std::vector<Bounds> boxes_of(const Points& points, const Triangles& triangles) {
  std::vector<Bounds> boxes(static_cast<size_t>(triangles.cols()));
  for (int t = 0; t < triangles.cols(); ++t)
    for (int k = 0; k < 3; ++k) boxes[static_cast<size_t>(t)].include(Vec3(points.col(triangles(k, t))));
  return boxes;
}

}  // namespace

TriangleTree::TriangleTree(const Points& points, const Triangles& triangles)
    : points_(points),
      triangles_(triangles),
      boxes_(boxes_of(points, triangles)),
      hierarchy_(centres(boxes_)) {
  hierarchy_.fit(boxes_, node_boxes_);
}

void TriangleTree::move(const Points& points) {
  points_ = points;
  boxes_ = boxes_of(points_, triangles_);
  hierarchy_.fit(boxes_, node_boxes_);
}

ClosestOnSurface TriangleTree::closest(const Vec3& p) const {
  ClosestOnSurface best;
  best.distance_squared = kInfinity;
  hierarchy_.find_least(
      boxes_, node_boxes_, [&](const Bounds& box) { return squared_distance(box, p); },
      [&](int t) {
        const ClosestOnTriangle found = closest_on_triangle(
            p, points_.col(triangles_(0, t)), points_.col(triangles_(1, t)), points_.col(triangles_(2, t)));
        if (found.distance_squared < best.distance_squared)
          best = {t, found.point, found.weights, found.distance_squared};
        return found.distance_squared;
      });
  return best;
}

std::vector<int> TriangleTree::overlapping(const Bounds& box) const {
  std::vector<int> found;
  hierarchy_.for_each(
      boxes_, node_boxes_, [&](const Bounds& other) { return are_near(other, box, 0); },
      [&](int t) { found.push_back(t); });
  return found;
}

std::vector<std::array<int, 2>> TriangleTree::self_overlaps(double margin) const {
  std::vector<std::array<int, 2>> pairs;
  hierarchy_.for_each_pair(
      boxes_, node_boxes_, [&](const Bounds& a, const Bounds& b) { return are_near(a, b, margin); },
      [&](int s, int t) {
        pairs.push_back({std::min(s, t), std::max(s, t)});
      });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<std::array<int, 2>> TriangleTree::overlaps(const TriangleTree& other, double margin) const {
  std::vector<std::array<int, 2>> pairs;
  hierarchy_.for_each_pair_with(
      other.hierarchy_, boxes_, node_boxes_, other.boxes_, other.node_boxes_,
      [&](const Bounds& a, const Bounds& b) { return are_near(a, b, margin); },
      [&](int s, int t) {
        pairs.push_back({s, t});
      });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace coapt
