// Simple meshes that tests build themselves, so that no test depends on the code of another room.
#pragma once

#include "mesh/remesh/uniform_refinement.hpp"

#include <functional>
#include <vector>

namespace coapt {

// Which diagonal cuts the quadrilaterals of a grid.
enum class Diagonal { Same, Alternating };

// Rectangle [0, width] x [0, height] in the plane z = 0, cut into 2 nx ny triangles. Node i + (nx+1) j is
// that of column i and row j. Normals point to +z.
TriangleMesh grid_mesh(int nx, int ny, double width = 1, double height = 1,
                       Diagonal diagonal = Diagonal::Alternating);

// The node of a grid mesh in column i and row j.
inline int grid_node(int nx, int i, int j) { return i + (nx + 1) * j; }

// Rectangle as above of n x n cells, each cut into four triangles around its middle, 4 n^2 in all: no
// preferred direction. Nodes at the corners of cells are numbered as in a grid mesh, the middles follow.
TriangleMesh crossed_grid_mesh(int n, double width = 1, double height = 1);

// Unit disc in the plane z = 0: a centre (node 0) and `rings` rings of 6 k nodes, 6 rings^2 triangles.
// The rim is the last 6 * rings nodes. Normals point to +z.
TriangleMesh disc_mesh(int rings);

// Unit disc again, as the image of a crossed grid of the square [-1, 1]^2 under disc_point. n even: node
// n/2 (n + 2) is the centre. A smooth map shows the clean order of a method, which the kinks between the
// sectors of disc_mesh disturb.
TriangleMesh smooth_disc_mesh(int n);

// The same for the quarter x >= 0, y >= 0: node 0 is the centre.
TriangleMesh quarter_disc_mesh(int n);

// (u sqrt(1 - v^2/2), v sqrt(1 - u^2/2)): the square onto the disc.
Vec3 disc_point(double u, double v);

// Unit sphere: an icosahedron, each triangle cut into four `subdivisions` times (20 * 4^n triangles),
// nodes on the sphere. Normals point outwards.
TriangleMesh sphere_mesh(int subdivisions);

// Moves each node that `may_move` admits by up to `amount` in x and y, from a fixed seed.
void perturb_in_plane(TriangleMesh& mesh, double amount, unsigned seed,
                      const std::function<bool(const Vec3&)>& may_move);

// Adds to each coordinate a random number in [-amount, amount], from a fixed seed.
Points shaken(const Points& x, double amount, unsigned seed);

// Two meshes side by side in one, without regions.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);
TriangleMesh moved(TriangleMesh mesh, const Vec3& by);

// The nodes of all triangles, corner after corner: the stencils of a triangle term.
std::vector<int> triangle_nodes(const Triangles& triangles);

}  // namespace coapt
