// Carries the shape of a coarse mesh over to the fine mesh that it was made from.
#pragma once

#include "mesh/remesh/coarsen.hpp"

namespace coapt {

// Positions of the fine vertices when those of the coarse mesh are at x. A vertex that the coarse mesh lacks
// follows the triangle that took its place: it keeps its barycentric coordinates there, and its distance from
// them turns and stretches with the triangle. Exact for rigid motions of any surface, and for affine ones of
// a flat one. X: of the fine mesh in the shape that was coarsened; x: as many columns as the coarse mesh has
// vertices.
Points prolonged(const Coarsening& coarsening, const Points& X, const Points& x);

// Of the motion of a triangle from X to x that keeps distances along its normal; the identity where it has no
// area in X.
Eigen::Matrix3d motion_gradient(const Points& X, const Points& x, const Eigen::Vector3i& triangle);

}  // namespace coapt
