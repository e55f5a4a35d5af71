// The corners of a pair of mesh features.
#pragma once

#include "core/types.hpp"

namespace coapt {

// Four points, or their displacements [length]: a point and a triangle (p | a, b, c) or two edges (a, b | c,
// d).
using PairCorners = Eigen::Matrix<double, 3, 4>;

}  // namespace coapt
