// Triangles over a strip of coordinates (u, t), u periodic with period 1, and the changes that make them
// uneven. What every change keeps: a manifold on which no triangle is turned over, in (u, t) or in space.
#pragma once

#include "mesh/triangle_mesh.hpp"
#include "valve/generators/rough_surface.hpp"

#include <functional>
#include <vector>

namespace coapt {

struct RoughTriangles {
  std::vector<Eigen::Vector2d> at;         // (u, t) of each vertex
  std::vector<Vec3> x;                     // its open position [mm]
  std::vector<Eigen::Vector3i> triangles;  // clockwise in (u, t)

  Triangles as_matrix() const;
  Eigen::Vector2d coordinates_between(int a, int b, double share) const;  // of the way from a to b
};

// Longest edge over the height on it; infinite for a triangle without area.
double aspect(const Vec3& a, const Vec3& b, const Vec3& c);

// One column of staggered rows for each entry of `columns` (u, ascending from 0), `rows` + 1 rows.
RoughTriangles staggered_strip(const RoughSurface& surface, const std::vector<double>& columns, int rows);

// Splits edges, those first whose length times `density` (and a random factor) is greatest, until there are
// `wanted` triangles, and flips edges until the mesh is Delaunay (the sum of the two angles opposite each
// edge at most 180 degrees) as far as (u, t) allows.
void refine(const RoughSurface& surface, const std::function<double(const Eigen::Vector2d&)>& density,
            int wanted, RandomSource& random, RoughTriangles& mesh);

// Moves each vertex (those of `held` excepted) by up to `size` of the way to a random place in a triangle
// around it; those of the boundary along it.
void jitter(const RoughSurface& surface, const std::vector<int>& held, double size, RandomSource& random,
            RoughTriangles& mesh);

// Turns a share of the inner edges into the other diagonal, where both triangles stay below `most` in aspect.
void turn_edges(double share, double most, RandomSource& random, RoughTriangles& mesh);

// Adds up to `count` vertices that make slivers, see rough_mesh.hpp.
void add_slivers(int count, RandomSource& random, RoughTriangles& mesh);

}  // namespace coapt
