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

// The gradient of that motion at each fine vertex: of the triangle that took its place, or the mean, by area,
// of the coarse triangles around it.
std::vector<Eigen::Matrix3d> prolonged_gradients(const Coarsening& coarsening, const Points& x);

// Moves vertices so that the triangles between them follow the gradients at their corners as nearly as they
// can, in least squares by area: what is carried over triangle by triangle does not meet where fine triangles
// lie across several coarse ones. Sumner and Popovic, Deformation transfer for triangle meshes, ACM Trans.
// Graph. 23 (2004). X: at rest; gradients, may_move: of each vertex. The others must hold every
// part of the mesh.
void fit_to_gradients(const Triangles& triangles, const Points& X,
                      const std::vector<Eigen::Matrix3d>& gradients, const std::vector<char>& may_move,
                      Points& x);

// Of the motion of a triangle from X to x that keeps distances along its normal; the identity where it has no
// area in X.
Eigen::Matrix3d motion_gradient(const Points& X, const Points& x, const Eigen::Vector3i& triangle);

}  // namespace coapt
