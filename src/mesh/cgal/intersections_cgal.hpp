// Which triangles of a mesh run through each other, by CGAL: a checker that shares no code with the solver,
// nor with mesh/distance/intersections.cpp. Linking this makes the program a GPL work.
#pragma once

#include "core/types.hpp"

#include <array>
#include <vector>

namespace coapt {

// The same question as intersecting_pairs(): all pairs of triangles that share no vertex and have a point in
// common, the smaller number first, ascending; a triangle without area counts as a segment or a point, and
// two such are not compared. Exact predicates; candidate pairs by their boxes. Pre: positions are finite,
// corner indices in range.
std::vector<std::array<int, 2>> intersecting_pairs_cgal(const Points& points, const Triangles& triangles);

}  // namespace coapt
