// Resolves initial self-intersections, so that a contact that needs a start without
// intersections can take over.
#pragma once

#include "core/types.hpp"

#include <array>
#include <vector>

namespace coapt {

struct SeparationOptions {
  int membrane_count = 0;          // triangles before the obstacles', which do not meet each other
  std::vector<bool> is_held = {};  // per node: it stays where it is
  std::vector<std::array<int, 2>> excluded = {};  // pairs that may intersect, ascending, smaller number first
  double gap = 0;                                 // that is left between two triangles pushed apart [length]
  int most_passes = 200;
};

struct Separation {
  Points x;  // moved positions [length]
  std::vector<std::array<int, 2>> pairs_left;
  int passes = 0;
  double largest_displacement = 0;  // of a node [length]
};

// Moves the corners of intersecting triangles until no pair is left. A pair is pushed apart along the axis on
// which it and the pairs around it overlap least, of those that can separate two triangles: their normals and
// the cross products of their edges. Only corners beyond the plane between the two move, to half the gap from
// it. Where both ways along the axis are as long, as for sheets that coincide, the connected part of the
// lower triangle goes against its own normals. Sheets that cross deeply have no short way out; they keep
// pairs.
// Pre: see intersections().
Separation separate(const Points& x, const Triangles& triangles, const SeparationOptions& options);

// Pairs of triangles that have a point in common, in ascending order, without the excluded ones and those
// within the obstacles.
std::vector<std::array<int, 2>> pairs_to_separate(const Points& x, const Triangles& triangles,
                                                  int membrane_count,
                                                  const std::vector<std::array<int, 2>>& excluded);

}  // namespace coapt
