// Where two parts of a surface that are far from each other along it meet, as seen from above: the coaptation
// line of a closed valve.
#pragma once

#include "mesh/closed_view.hpp"

#include <array>
#include <vector>

namespace coapt {

struct Seam {
  Points points;  // along it, in space [length]; the first again where it is closed
  std::vector<std::array<int, 2>> triangles;  // on both sides of each stretch between two points
};

double length_of(const Seam& seam);

struct SeamRules {
  std::vector<char> is_wanted;  // per node of the view: seams elsewhere do not count
  int radius = 0;               // of the closing, in cells
  double shortest = 0;          // spurs and pieces below it go [length]
};

// The triangles on top of neighbouring nodes are compared (for a node in a slit, those on its rim).
// They belong to a seam when the path between them along the mesh is more than four times the straight
// distance and two mean edges. The lines between such nodes are linked, freed of spurs and short pieces, and
// smoothed by a moving average, their ends held; they lie at the height of the closed view. x, triangles: the
// surface of the view. O(nodes) plus the places that are compared.
std::vector<Seam> seams(const TopView& view, const ClosedView& closed, const Points& x,
                        const Triangles& triangles, const SeamRules& rules);

}  // namespace coapt
