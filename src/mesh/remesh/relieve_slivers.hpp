// Thin triangles that a shape carried over from a coarser mesh stretches beyond measure.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// How much triangles are distorted from X to x: the greatest of their principal stretches and the inverses of
// these. 1: moved as they are; infinite where a triangle has lost its area; 1 where it has none in X.
Vector distortions(const Triangles& triangles, const Points& X, const Points& x);

// Moves vertices of triangles that are distorted more than `most`. The height of a thin triangle is a small
// part of its edges, so that what is a small error of a vertex beside the edges may stretch it many times.
// One of its vertices then goes along with a triangle across the opposite edge, as if both were one affine
// piece: the vertex and the neighbour that leave the triangles around it least distorted. may_move: of each
// vertex. Triangles that cannot be bettered stay.
void relieve_slivers(const Triangles& triangles, const Points& X, const std::vector<char>& may_move,
                     double most, Points& x);

}  // namespace coapt
