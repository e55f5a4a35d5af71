// Pairs of facets of the membrane and of obstacles: which pass through each other, which are excluded.
#pragma once

#include "mesh/distance/intersections.hpp"
#include "mesh/numbering.hpp"
#include "scene/build/model.hpp"

#include <array>
#include <string>
#include <vector>

namespace coapt {

using FacetPairs = std::vector<std::array<int, 2>>;  // the smaller number first, in ascending order

// The membrane's facets, then those of the obstacles, by node number.
Triangles all_facets(const Model& model);

// Pairs of all_facets() that pass through each other at x (3 x node_count [mm], finite), as `checker` finds
// them. At least one of a pair is the membrane's: obstacles may overlap among themselves.
FacetPairs membrane_intersections(const Points& x, const Model& model,
                                  const IntersectionChecker& checker = {});

// Two facet numbers a line, separated by a comma; lines that start with # are passed over. Throws InputError
// with every bad line as FILE:LINE.
FacetPairs read_facet_pairs(const std::string& path, int facet_count);

// Writes what read_facet_pairs() reads. Throws InputError when the file cannot be written.
void write_facet_pairs(const std::string& path, const FacetPairs& pairs);

// "12-345, 13-346, ...", at most twenty of them.
std::string listed(const FacetPairs& pairs, Numbering numbering = {});

}  // namespace coapt
