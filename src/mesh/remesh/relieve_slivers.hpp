// Thin triangles that a shape carried over from a coarser mesh stretches beyond measure.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// How much triangles are distorted from X to x: principal stretches that are greatest, and the inverses of
// those that are least. 1: moved as they are.
struct Distortion {
  double stretch = 1;
  double shrinkage = 1;  // infinite where a triangle has lost its area
};

// The greatest of both over all triangles that have an area in X.
Distortion greatest_distortion(const Triangles& triangles, const Points& X, const Points& x);

// Moves vertices of triangles that are stretched or shrunk more than `most`. The height of a thin triangle is
// a small part of its edges, so that what is a small error of a vertex beside the edges may stretch it many
// times. One of its vertices then goes along with a triangle across the opposite edge, as if both were one
// affine piece: the vertex and the neighbour that leave the triangles around it least distorted. may_move: of
// each vertex. Triangles that cannot be bettered stay.
void relieve_slivers(const Triangles& triangles, const Points& X, const std::vector<char>& may_move,
                     const Distortion& most, Points& x);

}  // namespace coapt
