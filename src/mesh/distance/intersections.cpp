#include "mesh/distance/intersections.hpp"

#include "mesh/distance/triangle_tree.hpp"
#include "mesh/orientation.hpp"

#include <algorithm>

namespace coapt {
namespace {

using Vec2 = Eigen::Vector2d;
using Corners = std::array<Vec3, 3>;
using Signs = std::array<int, 3>;

Vec2 without_axis(const Vec3& p, int axis) { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }

// Whether c lies within the box of a and b. Pre: the three are on one line; then c is on the segment.
bool is_between(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (c.array() >= a.cwiseMin(b).array()).all() && (c.array() <= a.cwiseMax(b).array()).all();
}

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int ac = orientation(a, b, c), ad = orientation(a, b, d);
  const int ca = orientation(c, d, a), cb = orientation(c, d, b);
  if (ac * ad < 0 && ca * cb < 0) return true;
  return (ac == 0 && is_between(a, b, c)) || (ad == 0 && is_between(a, b, d)) ||
         (ca == 0 && is_between(c, d, a)) || (cb == 0 && is_between(c, d, b));
}

// Pre: p and q lie in the plane of the triangle. They are compared in a projection in which the triangle
// keeps an area.
bool segment_meets_in_plane(const Vec3& p, const Vec3& q, const Corners& triangle) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vec2 t[3] = {without_axis(triangle[0], axis), without_axis(triangle[1], axis),
                       without_axis(triangle[2], axis)};
    const int turn = orientation(t[0], t[1], t[2]);
    if (turn == 0) continue;
    const Vec2 from = without_axis(p, axis), to = without_axis(q, axis);
    bool is_inside = true;
    for (int k = 0; k < 3; ++k) {
      if (segments_meet(from, to, t[k], t[(k + 1) % 3])) return true;
      is_inside = is_inside && orientation(t[k], t[(k + 1) % 3], from) == turn;
    }
    return is_inside;
  }
  return false;  // no area
}

// p_side, q_side: on which side of the triangle's plane the ends lie.
bool segment_meets(const Vec3& p, const Vec3& q, int p_side, int q_side, const Corners& triangle) {
  if (p_side * q_side > 0) return false;
  if (p_side == 0 && q_side == 0) return segment_meets_in_plane(p, q, triangle);
  bool left = false, right = false;  // the sides of the line pq on which the three edges pass
  for (size_t k = 0; k < 3; ++k) {
    const int side = orientation(p, q, triangle[k], triangle[(k + 1) % 3]);
    left = left || side > 0;
    right = right || side < 0;
  }
  return !(left && right);
}

Signs sides(const Corners& plane, const Corners& points) {
  return {orientation(plane[0], plane[1], plane[2], points[0]),
          orientation(plane[0], plane[1], plane[2], points[1]),
          orientation(plane[0], plane[1], plane[2], points[2])};
}

bool all_on_one_side(const Signs& s) { return s[0] != 0 && s[0] == s[1] && s[1] == s[2]; }

bool any_edge_meets(const Corners& edges, const Signs& side, const Corners& triangle) {
  for (size_t k = 0; k < 3; ++k) {
    const size_t l = (k + 1) % 3;
    if (segment_meets(edges[k], edges[l], side[k], side[l], triangle)) return true;
  }
  return false;
}

// Where two triangles meet, an edge of one meets the other.
bool triangles_meet(const Corners& a, const Corners& b, bool& is_coplanar) {
  const Signs b_sides = sides(a, b);
  if (all_on_one_side(b_sides)) return false;
  const Signs a_sides = sides(b, a);
  if (all_on_one_side(a_sides)) return false;
  is_coplanar = a_sides == Signs{0, 0, 0} && b_sides == Signs{0, 0, 0};
  return any_edge_meets(a, a_sides, b) || any_edge_meets(b, b_sides, a);
}

}  // namespace

std::vector<Intersection> intersections(const Points& points, const Triangles& triangles) {
  std::vector<Intersection> found;
  const auto corners = [&](int t) {
    return Corners{points.col(triangles(0, t)), points.col(triangles(1, t)), points.col(triangles(2, t))};
  };
  for (const auto& [s, t] : TriangleTree(points, triangles).self_overlaps()) {
    bool share = false;
    for (int k = 0; k < 3; ++k) share = share || (triangles.col(s).array() == triangles(k, t)).any();
    if (share) continue;
    bool is_coplanar = false;
    if (triangles_meet(corners(s), corners(t), is_coplanar)) found.push_back({s, t, is_coplanar});
  }
  return found;
}

std::vector<std::array<int, 2>> intersecting_pairs(const Points& points, const Triangles& triangles) {
  std::vector<std::array<int, 2>> pairs;
  for (const Intersection& found : intersections(points, triangles))
    pairs.push_back({found.first, found.second});
  return pairs;
}

}  // namespace coapt
