// A tree of axis-aligned boxes over triangles: closest points and pairs of near triangles.
#pragma once

#include "mesh/distance/box_hierarchy.hpp"

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
  // Copies positions and corners. O(n log n). Pre: positions are finite, corner indices in range.
  TriangleTree(const Points& points, const Triangles& triangles);

  // Takes new positions of the same triangles and fits the boxes to them, in O(n); the tree keeps its
  // shape, so queries become slower when the surface has moved far from where it was built.
  void move(const Points& points);

  // The surface point closest to p. Pre: there is a triangle.
  ClosestOnSurface closest(const Vec3& p) const;

  // Triangles whose box meets this one (touching counts), in no particular order.
  std::vector<int> overlapping(const Bounds& box) const;

  // Pairs of triangles whose boxes are within `margin` of each other along every axis, each pair once with
  // the smaller number first, in ascending order.
  std::vector<std::array<int, 2>> self_overlaps(double margin = 0) const;

  // The same between this tree's triangles (first) and another's (second).
  std::vector<std::array<int, 2>> overlaps(const TriangleTree& other, double margin = 0) const;

  int triangle_count() const { return static_cast<int>(triangles_.cols()); }

 private:
  Points points_;
  Triangles triangles_;
  std::vector<Bounds> boxes_;  // of the triangles, by number
  BoxHierarchy hierarchy_;
  std::vector<Bounds> node_boxes_;
};

}  // namespace coapt
