// Distances between points, segments and triangles, with the closest points.
#pragma once

#include "core/types.hpp"

namespace coapt {

struct ClosestOnTriangle {
  Vec3 point;                   // [length]
  Vec3 weights;                 // barycentric coordinates, >= 0, sum 1
  double distance_squared = 0;  // [length^2]
};

// The point of triangle abc that is closest to p. A triangle without area counts as its three edges, one
// of no extent as a point; nothing is ever divided by zero.
ClosestOnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

double point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

struct ClosestOnSegments {
  Vec3 first, second;           // closest points on ab and on cd [length]
  double s = 0, t = 0;          // first = a + s (b - a), second = c + t (d - c); both in [0, 1]
  double distance_squared = 0;  // [length^2]
};

// The closest points of the segments ab and cd. Parallel and zero-length segments are allowed; where many
// pairs are equally close, one of them is returned.
ClosestOnSegments closest_on_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

double segment_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace coapt
