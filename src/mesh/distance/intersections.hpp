// Which triangles of a mesh run through each other.
#pragma once

#include "core/types.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace coapt {

struct Intersection {
  int first = 0, second = 0;  // triangles, first < second
  bool is_coplanar = false;   // both lie in one plane and overlap or touch there
};

// All pairs of triangles that share no vertex and have a point in common; touching counts. Decided without
// rounding (orientation.hpp). A triangle without area counts as its edges; two such are not compared.
// In ascending order. Time O(n log n) plus the pairs whose boxes overlap.
// Pre: positions are finite, corner indices in range.
std::vector<Intersection> intersections(const Points& points, const Triangles& triangles);

// The same as pairs of triangle numbers.
std::vector<std::array<int, 2>> intersecting_pairs(const Points& points, const Triangles& triangles);

// Who counts the intersections of a result.
struct IntersectionChecker {
  std::string name = "own exact predicates";
  std::function<std::vector<std::array<int, 2>>(const Points&, const Triangles&)> pairs = intersecting_pairs;
};

}  // namespace coapt
