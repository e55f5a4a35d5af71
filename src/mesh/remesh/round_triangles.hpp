// A mesh whose triangles are made rounder where they lie on a surface.
#pragma once

#include "mesh/triangle_mesh.hpp"

namespace coapt {

// In each round edges are flipped to where the least of six angles grows, and each vertex moves towards the
// middle of its neighbours, on `surface` (rims along its rims), unless that makes an angle below 30 degrees
// smaller. Corners of the rims are rounded off as far as vertices slide. Manifold, orientation and number of
// rims are kept. Pre: both are manifold and consistently oriented; the vertices of `mesh` lie on `surface`,
// and its rims follow those of `surface` in any order.
void round_triangles(TriangleMesh& mesh, const TriangleMesh& surface, int rounds);

// Edges shorter than this [mm] become points, where the least of the angles around grows by it, and triangles
// with two edges on a rim are cut off that have an angle below 20 degrees or no edge that is longer. Where a
// layer bends sharply its columns crowd, and the edges between them are no longer found by coarsening.
// Manifold, orientation and number of rims are kept. Vertices that belong to nothing remain.
void collapse_short_edges(TriangleMesh& mesh, double shortest);

// The least angle of all triangles [degrees].
double least_angle(const TriangleMesh& mesh);

}  // namespace coapt
