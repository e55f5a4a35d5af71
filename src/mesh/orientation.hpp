// On which side of a line or plane a point lies, exactly.
// Method: Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates, 1997:
// a floating-point determinant with an error bound, and where that does not decide, expansions: sums of
// doubles that hold the determinant without error.
// Exact for coordinates that are zero or whose size lies between 1e-90 and 1e90.
#pragma once

#include "core/types.hpp"

namespace coapt {

// Sign of det[b - a, c - a]: 1 when a, b, c turn counter-clockwise, -1 clockwise, 0 on one line.
int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

// Sign of (b - a) x (c - a) . (d - a): 1 when d lies on the side of triangle abc to which its normal points,
// -1 on the other side, 0 in its plane.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace coapt
