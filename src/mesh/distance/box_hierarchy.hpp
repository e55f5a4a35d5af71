// A binary tree over triangles whose shape is fixed once: bounds are fitted to it anew in linear time
// wherever the surface goes, and triangles are visited in an order that never depends on them. The one tree
// of the library: contact, closest points and intersections are searched with it.
#pragma once

#include "core/types.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace coapt {

// An axis-aligned box [length].
struct Bounds {
  Eigen::Array3d low = Eigen::Array3d::Constant(kInfinity), high = Eigen::Array3d::Constant(-kInfinity);

  void include(const Bounds& other) {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  void include(const Vec3& point) {
    low = low.min(point.array());
    high = high.max(point.array());
  }
};

// The cube of this half width around a point.
inline Bounds bounds_around(const Vec3& p, double half) { return {p.array() - half, p.array() + half}; }

// Centroids of the triangles, 3 x triangles.
Points centroids(const Points& x, const Triangles& triangles);

class BoxHierarchy {
 public:
  // Halves the triangles by the median of their centres (3 x triangles) along the longest axis of these, so
  // that the depth is bounded by log2(n) even when all centres coincide. The first `first_part` of them and
  // the rest come under different children of the root where there are both; pairs within the rest are never
  // visited.
  BoxHierarchy(const Points& centres, Eigen::Index first_part);
  explicit BoxHierarchy(const Points& centres) : BoxHierarchy(centres, centres.cols()) {}

  // Bounds of every node of the tree, from those of every triangle. Bound: default constructible,
  // include(Bound).
  template <class Bound>
  void fit(const std::vector<Bound>& of_triangles, std::vector<Bound>& of_nodes) const {
    of_nodes.assign(nodes_.size(), {});
    for (size_t n = nodes_.size(); n-- > 0;) {
      const Node& node = nodes_[n];
      if (node.is_leaf()) {
        for (int k = node.begin; k < node.end; ++k)
          of_nodes[n].include(of_triangles[static_cast<size_t>(order_[static_cast<size_t>(k)])]);
      } else {
        of_nodes[n].include(of_nodes[n + 1]);
        of_nodes[n].include(of_nodes[static_cast<size_t>(node.right)]);
      }
    }
  }

  // Calls visit(t) for all triangles that is_near(bound) does not rule out on the way.
  template <class Bound, class Near, class Visit>
  void for_each(const std::vector<Bound>& of_triangles, const std::vector<Bound>& of_nodes,
                const Near& is_near, const Visit& visit) const {
    std::vector<int> stack;
    if (!nodes_.empty()) stack.push_back(0);
    while (!stack.empty()) {
      const int n = stack.back();
      stack.pop_back();
      if (!is_near(of_nodes[static_cast<size_t>(n)])) continue;
      const Node& node = nodes_[static_cast<size_t>(n)];
      if (node.is_leaf()) {
        for (int k = node.begin; k < node.end; ++k) {
          const int t = order_[static_cast<size_t>(k)];
          if (is_near(of_triangles[static_cast<size_t>(t)])) visit(t);
        }
      } else {
        stack.insert(stack.end(), {node.right, n + 1});
      }
    }
  }

  // The least visit(t) of all triangles t, nearer boxes first: those that distance(bound) puts no nearer than
  // the least so far are left out.
  template <class Bound, class Distance, class Visit>
  void find_least(const std::vector<Bound>& of_triangles, const std::vector<Bound>& of_nodes,
                  const Distance& distance, const Visit& visit) const {
    double least = kInfinity;
    std::vector<std::pair<double, int>> stack;
    const auto at = [&](int n) { return std::pair(distance(of_nodes[static_cast<size_t>(n)]), n); };
    if (!nodes_.empty()) stack.push_back(at(0));
    while (!stack.empty()) {
      const auto [bound, n] = stack.back();
      stack.pop_back();
      if (bound >= least) continue;
      const Node& node = nodes_[static_cast<size_t>(n)];
      if (node.is_leaf()) {
        for (int k = node.begin; k < node.end; ++k) {
          const int t = order_[static_cast<size_t>(k)];
          if (distance(of_triangles[static_cast<size_t>(t)]) < least) least = std::min(least, visit(t));
        }
      } else {
        auto left = at(n + 1), right = at(node.right);
        if (left.first < right.first) std::swap(left, right);
        stack.insert(stack.end(), {left, right});  // the nearer one is opened first
      }
    }
  }

  // Calls visit(s, t) for all pairs of triangles, s != t and each pair once, that is_near(bound, bound) does
  // not rule out on the way.
  template <class Bound, class Near, class Visit>
  void for_each_pair(const std::vector<Bound>& of_triangles, const std::vector<Bound>& of_nodes,
                     const Near& is_near, const Visit& visit) const {
    walk_pairs(*this, true, of_triangles, of_nodes, of_triangles, of_nodes, is_near, visit);
  }

  // The same with s a triangle of this tree and t one of another.
  template <class Bound, class Near, class Visit>
  void for_each_pair_with(const BoxHierarchy& other, const std::vector<Bound>& of_triangles,
                          const std::vector<Bound>& of_nodes, const std::vector<Bound>& other_triangles,
                          const std::vector<Bound>& other_nodes, const Near& is_near,
                          const Visit& visit) const {
    walk_pairs(other, false, of_triangles, of_nodes, other_triangles, other_nodes, is_near, visit);
  }

 private:
  // A leaf holds order_[begin, end). The children of an inner node are the next node and `right`.
  struct Node {
    int begin = 0, end = 0;
    int right = -1;  // -1: leaf
    bool is_second_part = false;
    bool is_leaf() const { return right < 0; }
    int count() const { return end - begin; }
  };

  void build(int begin, int end, const Points& centres, bool is_second_part);

  // Descends both trees together, always into the node with more triangles. Within one tree the pair of a
  // node with itself splits into left-left, right-right and left-right.
  template <class Bound, class Near, class Visit>
  void walk_pairs(const BoxHierarchy& other, bool is_self, const std::vector<Bound>& of_triangles,
                  const std::vector<Bound>& of_nodes, const std::vector<Bound>& other_triangles,
                  const std::vector<Bound>& other_nodes, const Near& is_near, const Visit& visit) const {
    if (nodes_.empty() || other.nodes_.empty()) return;
    std::vector<std::pair<int, int>> stack{{0, 0}};
    while (!stack.empty()) {
      const auto [a, b] = stack.back();
      stack.pop_back();
      const Node &left = nodes_[static_cast<size_t>(a)], &right = other.nodes_[static_cast<size_t>(b)];
      if (is_self && left.is_second_part && right.is_second_part) continue;
      const bool is_same = is_self && a == b;
      if (!is_same && !is_near(of_nodes[static_cast<size_t>(a)], other_nodes[static_cast<size_t>(b)]))
        continue;
      if (left.is_leaf() && right.is_leaf()) {
        visit_leaves(other, is_same, left, right, of_triangles, other_triangles, is_near, visit);
      } else if (is_same) {
        stack.emplace_back(a + 1, left.right);
        stack.emplace_back(left.right, left.right);
        stack.emplace_back(a + 1, a + 1);
      } else if (right.is_leaf() || (!left.is_leaf() && left.count() >= right.count())) {
        stack.emplace_back(left.right, b);
        stack.emplace_back(a + 1, b);
      } else {
        stack.emplace_back(a, right.right);
        stack.emplace_back(a, b + 1);
      }
    }
  }

  template <class Bound, class Near, class Visit>
  void visit_leaves(const BoxHierarchy& other, bool is_same, const Node& left, const Node& right,
                    const std::vector<Bound>& of_triangles, const std::vector<Bound>& other_triangles,
                    const Near& is_near, const Visit& visit) const {
    for (int i = left.begin; i < left.end; ++i)
      for (int j = is_same ? i + 1 : right.begin; j < right.end; ++j) {
        const int s = order_[static_cast<size_t>(i)], t = other.order_[static_cast<size_t>(j)];
        if (is_near(of_triangles[static_cast<size_t>(s)], other_triangles[static_cast<size_t>(t)]))
          visit(s, t);
      }
  }

  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace coapt
