#include "mesh/distance/triangle_tree.hpp"

#include "mesh/distance/triangle_distance.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace coapt {
namespace {

constexpr int kLeafSize = 4;

bool are_near(const TriangleTree::Box& a, const TriangleTree::Box& b, double margin) {
  return ((a.min() - b.max()).array() <= margin).all() && ((b.min() - a.max()).array() <= margin).all();
}

}  // namespace

TriangleTree::TriangleTree(const Points& points, const Triangles& triangles)
    : points_(points), triangles_(triangles) {
  const int count = triangle_count();
  Points centres(3, count);
  boxes_.reserve(static_cast<size_t>(count));
  for (int t = 0; t < count; ++t) {
    boxes_.push_back(triangle_box(t));
    centres.col(t) = boxes_.back().center();
  }
  order_.resize(static_cast<size_t>(count));
  std::iota(order_.begin(), order_.end(), 0);
  if (count > 0) build(0, count, centres);
}

TriangleTree::Box TriangleTree::triangle_box(int triangle) const {
  Box box;
  for (int k = 0; k < 3; ++k) box.extend(Vec3(points_.col(triangles_(k, triangle))));
  return box;
}

// Halves the triangles at the median centre along the longest extent of the centres: the depth is bounded
// by log2(n) even when all centres coincide.
int TriangleTree::build(int begin, int end, const Points& centres) {
  const int number = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Box box, centre_box;
  for (int i = begin; i < end; ++i) {
    box.extend(boxes_[static_cast<size_t>(order_[static_cast<size_t>(i)])]);
    centre_box.extend(Vec3(centres.col(order_[static_cast<size_t>(i)])));
  }
  int right = -1;
  if (end - begin > kLeafSize) {
    int axis = 0;
    centre_box.sizes().maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(
        order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
        [&](int l, int r) { return std::pair(centres(axis, l), l) < std::pair(centres(axis, r), r); });
    build(begin, middle, centres);
    right = build(middle, end, centres);
  }
  nodes_[static_cast<size_t>(number)] = {box, begin, end, right};
  return number;
}

void TriangleTree::move(const Points& points) {
  points_ = points;
  for (int t = 0; t < triangle_count(); ++t) boxes_[static_cast<size_t>(t)] = triangle_box(t);
  for (size_t n = nodes_.size(); n-- > 0;) {  // children come behind their parent
    Node& node = nodes_[n];
    node.box.setEmpty();
    if (node.is_leaf()) {
      for (int i = node.begin; i < node.end; ++i)
        node.box.extend(boxes_[static_cast<size_t>(order_[static_cast<size_t>(i)])]);
    } else {
      node.box = nodes_[n + 1].box.merged(nodes_[static_cast<size_t>(node.right)].box);
    }
  }
}

ClosestOnSurface TriangleTree::closest(const Vec3& p) const {
  ClosestOnSurface best;
  best.distance_squared = kInfinity;
  std::vector<std::pair<double, int>> open = {{nodes_[0].box.squaredExteriorDistance(p), 0}};
  while (!open.empty()) {
    const auto [bound, number] = open.back();
    open.pop_back();
    if (bound >= best.distance_squared) continue;
    const Node& node = nodes_[static_cast<size_t>(number)];
    if (node.is_leaf()) {
      for (int i = node.begin; i < node.end; ++i) {
        const int t = order_[static_cast<size_t>(i)];
        if (boxes_[static_cast<size_t>(t)].squaredExteriorDistance(p) >= best.distance_squared) continue;
        const ClosestOnTriangle found = closest_on_triangle(
            p, points_.col(triangles_(0, t)), points_.col(triangles_(1, t)), points_.col(triangles_(2, t)));
        if (found.distance_squared < best.distance_squared)
          best = {t, found.point, found.weights, found.distance_squared};
      }
      continue;
    }
    std::pair<double, int> left = {nodes_[static_cast<size_t>(number) + 1].box.squaredExteriorDistance(p),
                                   number + 1};
    std::pair<double, int> right = {nodes_[static_cast<size_t>(node.right)].box.squaredExteriorDistance(p),
                                    node.right};
    if (left.first < right.first) std::swap(left, right);
    open.push_back(left);  // the nearer one is opened first
    open.push_back(right);
  }
  return best;
}

std::vector<int> TriangleTree::overlapping(const Box& box) const {
  std::vector<int> found, open;
  if (!nodes_.empty()) open.push_back(0);
  while (!open.empty()) {
    const int number = open.back();
    open.pop_back();
    const Node& node = nodes_[static_cast<size_t>(number)];
    if (!are_near(node.box, box, 0)) continue;
    if (!node.is_leaf()) {
      open.push_back(node.right);
      open.push_back(number + 1);
      continue;
    }
    for (int i = node.begin; i < node.end; ++i)
      if (are_near(boxes_[static_cast<size_t>(order_[static_cast<size_t>(i)])], box, 0))
        found.push_back(order_[static_cast<size_t>(i)]);
  }
  return found;
}

// Descends both trees together, always into the node with more triangles. Within one tree the pair of a
// node with itself splits into left-left, right-right and left-right.
void TriangleTree::collect(const TriangleTree& other, bool is_self, double margin,
                           std::vector<std::array<int, 2>>& pairs) const {
  if (nodes_.empty() || other.nodes_.empty()) return;
  std::vector<std::pair<int, int>> open = {{0, 0}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    const Node &first = nodes_[static_cast<size_t>(a)], &second = other.nodes_[static_cast<size_t>(b)];
    const bool is_same = is_self && a == b;
    if (!is_same && !are_near(first.box, second.box, margin)) continue;
    if (first.is_leaf() && second.is_leaf()) {
      for (int i = first.begin; i < first.end; ++i)
        for (int j = is_same ? i + 1 : second.begin; j < second.end; ++j) {
          const int s = order_[static_cast<size_t>(i)], t = other.order_[static_cast<size_t>(j)];
          if (!are_near(boxes_[static_cast<size_t>(s)], other.boxes_[static_cast<size_t>(t)], margin))
            continue;
          pairs.push_back(is_self ? std::array{std::min(s, t), std::max(s, t)} : std::array{s, t});
        }
    } else if (is_same) {
      open.insert(open.end(), {{a + 1, a + 1}, {first.right, first.right}, {a + 1, first.right}});
    } else if (second.is_leaf() ||
               (!first.is_leaf() && first.end - first.begin > second.end - second.begin)) {
      open.insert(open.end(), {{a + 1, b}, {first.right, b}});
    } else {
      open.insert(open.end(), {{a, b + 1}, {a, second.right}});
    }
  }
  std::sort(pairs.begin(), pairs.end());
}

std::vector<std::array<int, 2>> TriangleTree::self_overlaps(double margin) const {
  std::vector<std::array<int, 2>> pairs;
  collect(*this, true, margin, pairs);
  return pairs;
}

std::vector<std::array<int, 2>> TriangleTree::overlaps(const TriangleTree& other, double margin) const {
  std::vector<std::array<int, 2>> pairs;
  collect(other, false, margin, pairs);
  return pairs;
}

}  // namespace coapt
