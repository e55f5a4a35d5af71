// Array types shared by every room. Arrays hold one column per node, so that a node's
// coordinates lie side by side in memory.
#pragma once

#include "core/alignment.hpp"

#include <Eigen/Core>

#include <limits>

namespace coapt {

using Vector = Eigen::VectorXd;      // unknowns or gradient entries
using Points = Eigen::Matrix3Xd;     // node positions, 3 x node_count [length]
using Triangles = Eigen::Matrix3Xi;  // corner nodes, 3 x triangle_count, 0-based
using Segments = Eigen::Matrix2Xi;   // end nodes, 2 x segment_count, 0-based
using Vec3 = Eigen::Vector3d;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace coapt
