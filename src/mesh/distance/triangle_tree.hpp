// A tree of axis-aligned boxes over triangles: closest points and pairs of near triangles.
#pragma once

#include "core/types.hpp"

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace coapt {

struct ClosestOnSurface {
  int triangle = -1;            // the lowest in number of those equally close is not promised
  Vec3 point;                   // [length]
  Vec3 weights;                 // barycentric coordinates in the triangle
  double distance_squared = 0;  // [length^2]
};

class TriangleTree {
 public:
  using Box = Eigen::AlignedBox3d;

  // Copies positions and corners. O(n log n). Pre: positions are finite, corner indices in range.
  TriangleTree(const Points& points, const Triangles& triangles);

  // Takes new positions of the same triangles and fits the boxes to them, in O(n); the tree keeps its
  // shape, so queries become slower when the surface has moved far from where it was built.
  void move(const Points& points);

  // The surface point closest to p. Pre: there is a triangle.
  ClosestOnSurface closest(const Vec3& p) const;

  // Triangles whose box meets `box` (touching counts), in no particular order.
  std::vector<int> overlapping(const Box& box) const;

  // Pairs of triangles whose boxes are within `margin` of each other along every axis, each pair once with
  // the smaller number first, in ascending order.
  std::vector<std::array<int, 2>> self_overlaps(double margin = 0) const;

  // The same between this tree's triangles (first) and another's (second).
  std::vector<std::array<int, 2>> overlaps(const TriangleTree& other, double margin = 0) const;

  int triangle_count() const { return static_cast<int>(triangles_.cols()); }

 private:
  // A leaf holds order_[begin, end). The children of an inner node are the next node and `right`.
  struct Node {
    Box box;
    int begin = 0, end = 0;
    int right = -1;  // -1: leaf
    bool is_leaf() const { return right < 0; }
  };

  Box triangle_box(int triangle) const;
  int build(int begin, int end, const Points& centres);
  void collect(const TriangleTree& other, bool is_self, double margin,
               std::vector<std::array<int, 2>>& pairs) const;

  Points points_;
  Triangles triangles_;
  std::vector<int> order_;
  std::vector<Box> boxes_;  // of the triangles, by number
  std::vector<Node> nodes_;
};

}  // namespace coapt
