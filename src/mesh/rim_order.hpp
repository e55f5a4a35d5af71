// Closed loops of vertices along the rims of a surface, whatever order they were listed in.
#pragma once

#include "core/types.hpp"

#include <string>
#include <vector>

namespace coapt {

// Whether both list the same closed loop: begun elsewhere, or run the other way round.
bool is_same_loop(const std::vector<int>& a, const std::vector<int>& b);

struct RimLoop {
  std::vector<int> vertices;  // in the order of the rim from the first one given; as given where kept
  bool is_reordered = false;
  int rims = 0;  // on which they lie; 0 where those are several and none is wholly theirs
  bool spans_rims() const { return rims > 1; }
};

// Vertices that are meant as a closed loop, such as an annulus, in the order in which they follow one another
// on the rim. Kept as given are lists that are in the rim's order already, that name a vertex twice, and
// those that do not lie on one rim that is a simple loop. A list that holds one whole rim and vertices of
// others is no closed loop in any order: spans_rims() says so. The triangles need no common orientation. O(n
// log n).
RimLoop rim_loop(const std::vector<int>& vertices, const Triangles& triangles);

// What a message says of a loop that was put in order, and of one that cannot be.
std::string reordered_text();
std::string spans_rims_text(int rims);

}  // namespace coapt
