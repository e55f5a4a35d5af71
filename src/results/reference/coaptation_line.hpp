// The coaptation line of any closed surface, as it is seen along an annulus normal, and how far two lie
// apart.
#pragma once

#include "mesh/closed_view.hpp"
#include "mesh/seams.hpp"
#include "mesh/triangle_mesh.hpp"
#include "results/reference/distance_figures.hpp"

#include <optional>
#include <vector>

namespace coapt {

// What is seen of a surface within an annulus, with its slits up to the contact distance closed.
struct SeenSurface {
  TopView view;
  ClosedView closed;
  int radius = 0;  // of the closing, in cells
};

// x: 3 x n; annulus: its points in order, which the view covers; finest: cells over its extent, at most.
// Throws InputError for fewer than three. Pre: contact_distance > 0 [length].
SeenSurface seen_surface(const Points& x, const Triangles& triangles, const Points& annulus,
                         const ViewFrame& frame, double contact_distance, int finest = 1024);

// Its seams (mesh/seams.hpp) near which, seen from above, a vertex is in contact, by vertex of x.
std::vector<Seam> coaptation_line(const SeenSurface& seen, const Points& x, const Triangles& triangles,
                                  const std::vector<char>& is_contact, double contact_distance);

// The same of a surface of which nothing else is known: vertices are in contact where another part of it lies
// within the contact distance.
std::vector<Seam> coaptation_line_of(const TriangleMesh& surface, const Points& annulus,
                                     const ViewFrame& frame, double contact_distance);

// From every place of one line to the closest of the other; by length, whatever the number of pieces
// [length].
struct LineDistance {
  DistanceFigures there, back;
};

// Nothing where one of them has no length.
std::optional<LineDistance> line_distance(const std::vector<Seam>& from, const std::vector<Seam>& to);

// Between the lines of a surface in its place and of the one that it was registered onto, of which nothing
// else is known: both are seen within the target's largest closed boundary loop, from the side that the
// target does not hang on, and vertices are in contact within half a mean edge (of the coarser one). Nothing
// where the target has no such loop, or a line is not seen.
std::optional<LineDistance> distance_of_lines(const TriangleMesh& moved, const TriangleMesh& target);

}  // namespace coapt
