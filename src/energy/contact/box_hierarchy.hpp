// A binary tree over triangles whose shape is fixed once: bounds are fitted to it anew in linear time
// wherever the surface goes, and pairs of near leaves are visited in an order that never depends on them.
#pragma once

#include "core/types.hpp"

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

class BoxHierarchy {
 public:
  // Halves the triangles by the median of their centroids along the longest axis of these. The first
  // `first_part` of them and the rest come under different children of the root where there are both; pairs
  // within the rest are never visited.
  BoxHierarchy(const Points& x, const Triangles& triangles, int first_part);

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

  // Calls visit(s, t) for all pairs of triangles, s != t and each pair once, that is_near(bound, bound) does
  // not rule out on the way.
  template <class Bound, class Near, class Visit>
  void for_each_pair(const std::vector<Bound>& of_triangles, const std::vector<Bound>& of_nodes,
                     const Near& is_near, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::vector<std::pair<int, int>> stack{{0, 0}};
    while (!stack.empty()) {
      const auto [a, b] = stack.back();
      stack.pop_back();
      const Node &left = nodes_[static_cast<size_t>(a)], &right = nodes_[static_cast<size_t>(b)];
      if (left.is_second_part && right.is_second_part) continue;
      if (a == b) {
        if (left.is_leaf()) {
          visit_leaves(left, left, of_triangles, is_near, visit);
        } else {
          stack.emplace_back(a + 1, left.right);
          stack.emplace_back(left.right, left.right);
          stack.emplace_back(a + 1, a + 1);
        }
        continue;
      }
      if (!is_near(of_nodes[static_cast<size_t>(a)], of_nodes[static_cast<size_t>(b)])) continue;
      if (left.is_leaf() && right.is_leaf()) {
        visit_leaves(left, right, of_triangles, is_near, visit);
      } else if (right.is_leaf() || (!left.is_leaf() && left.count() >= right.count())) {
        stack.emplace_back(left.right, b);
        stack.emplace_back(a + 1, b);
      } else {
        stack.emplace_back(a, right.right);
        stack.emplace_back(a, b + 1);
      }
    }
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

  template <class Bound, class Near, class Visit>
  void visit_leaves(const Node& left, const Node& right, const std::vector<Bound>& of_triangles,
                    const Near& is_near, const Visit& visit) const {
    for (int i = left.begin; i < left.end; ++i)
      for (int j = &left == &right ? i + 1 : right.begin; j < right.end; ++j) {
        const int s = order_[static_cast<size_t>(i)], t = order_[static_cast<size_t>(j)];
        if (is_near(of_triangles[static_cast<size_t>(s)], of_triangles[static_cast<size_t>(t)])) visit(s, t);
      }
  }

  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace coapt
