// A closed loop of vertices and a closed curve, matched by arc length.
#pragma once

#include "core/types.hpp"

#include <vector>

namespace coapt {

// The closed curve through `points` in their order: Catmull-Rom, which passes through all of them, as `count`
// points between each two. 3 x (count * points.cols()) [length].
Points smooth_closed_curve(const Points& points, int count);

// For each point of the closed loop x (3 x n, in order) the point of the closed polygon `curve` at the same
// part of the length. Start and direction are those that bring the points nearest to x (least squares). Pre:
// both have at least three points and a length.
Points matched_by_length(const Points& x, const Points& curve);

// The point of the closed polygon that is nearest to x [length].
Vec3 closest_on_curve(const Points& curve, const Vec3& x);

// Mean distance of the points x from the closed polygon [length].
double mean_distance(const Points& x, const Points& curve);

}  // namespace coapt
