// Meshes of simple shapes for examples and for problems with a closed-form answer.
//
// Every generator takes the number of triangles that is wanted and returns the nearest count that its
// regular pattern allows; the patterns and the counts are stated with each. Flat meshes lie in z = 0
// with normals +z. Lengths are in the caller's unit.
// All throw InputError when a size is not a positive finite number or fewer triangles are asked for
// than the pattern's smallest mesh has.
#pragma once

#include "mesh/triangle_mesh.hpp"

namespace coapt {

enum class CellPattern {
  Diagonal,  // two triangles a cell, all diagonals parallel
  Cross,     // four triangles a cell around its centre ('x'); no preferred direction
};

// Disc around the origin: k m points on the k-th of n concentric rings, m n^2 triangles with m = 6,
// or 5 or 7 where 6 misses the wanted count by more than 5 %. Within 10 % of the wanted count from 80
// triangles on. The smallest angle is above 35 degrees. Vertex 0 is the centre; the rim comes last.
TriangleMesh disc(double radius, int triangles);

// Square [0, side]^2 of n x n cells: 2 n^2 or 4 n^2 triangles, within 10 % from 200 (Diagonal) or
// 400 (Cross) on. A quarter of one sheet of a square airbag with diagonal d has the side d/(2 sqrt 2).
TriangleMesh square(double side, int triangles, CellPattern pattern = CellPattern::Diagonal);

// Rectangle [0, width] x [0, height]; cells as near to squares as the count allows. With a width of many
// heights this is a strip. Vertices of the cell corners come first, row by row from y = 0.
TriangleMesh rectangle(double width, double height, int triangles,
                       CellPattern pattern = CellPattern::Diagonal);

// Closed sphere around the origin, normals outward: each face of an icosahedron is divided into f^2
// triangles and pushed out to the radius, 20 f^2 triangles with the nearest f >= 1 (within 10 % from
// 2,000 on). The smallest angle is above 40 degrees.
TriangleMesh sphere(double radius, int triangles);

struct TentOptions {
  double side = 10;                // of the square through the corners, seen from above [length]
  double corner_height = 5;        // of the corners (0,0) and (side,side); the other two stand at 0 [length]
  double edge_radius = kInfinity;  // edges are pulled in towards the middle to arcs of this radius [length]
  int triangles = 800;
  CellPattern pattern = CellPattern::Cross;
};

// Start shape of a four-point tent: a square sail with two high and two low corners, each edge a circular
// arc that bows horizontally inward (straight for an infinite radius), the inside filled by transfinite
// interpolation (Coons 1967: the sum of the two ruled surfaces less the bilinear one), so straight edges
// give a hyperbolic paraboloid. n x n cells as in square(). Normals have a positive z component.
// The arcs make the corners sharper: seen flat, the angle at a corner is 90 degrees less twice
// asin(edge/(2 edge_radius)), and no triangle there can be better than that. Throws InputError unless
// edge_radius exceeds 0.71 times the length of an edge, where the angle vanishes.
TriangleMesh tent(const TentOptions& options);

}  // namespace coapt
