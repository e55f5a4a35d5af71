#include "mesh/distance/box_hierarchy.hpp"

#include <algorithm>
#include <numeric>

namespace coapt {
namespace {

constexpr int kLeafSize = 4;  // triangles in a leaf

}  // namespace

Points centroids(const Points& x, const Triangles& triangles) {
  Points centres(3, triangles.cols());
  for (int t = 0; t < triangles.cols(); ++t)
    centres.col(t) = (x.col(triangles(0, t)) + x.col(triangles(1, t)) + x.col(triangles(2, t))) / 3;
  return centres;
}

BoxHierarchy::BoxHierarchy(const Points& centres, Eigen::Index first_part)
    : order_(static_cast<size_t>(centres.cols())) {
  std::iota(order_.begin(), order_.end(), 0);
  const int count = static_cast<int>(centres.cols()), first = static_cast<int>(first_part);
  if (first == 0 || first == count) {
    if (count > 0) build(0, count, centres, first == 0);
    return;
  }
  nodes_.push_back({0, count, -1, false});
  build(0, first, centres, false);
  nodes_[0].right = static_cast<int>(nodes_.size());
  build(first, count, centres, true);
}

void BoxHierarchy::build(int begin, int end, const Points& centres, bool is_second_part) {
  const size_t node = nodes_.size();
  nodes_.push_back({begin, end, -1, is_second_part});
  if (end - begin <= kLeafSize) return;
  Bounds bounds;
  for (int k = begin; k < end; ++k) bounds.include(Vec3(centres.col(order_[static_cast<size_t>(k)])));
  Eigen::Index axis = 0;
  (bounds.high - bounds.low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int s, int t) {
    const double l = centres(axis, s), r = centres(axis, t);
    return l != r ? l < r : s < t;
  });
  build(begin, middle, centres, is_second_part);
  nodes_[node].right = static_cast<int>(nodes_.size());
  build(middle, end, centres, is_second_part);
}

}  // namespace coapt
