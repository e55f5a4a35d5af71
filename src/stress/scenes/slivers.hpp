// Slivers put into a mesh. Private to this room.
#pragma once

#include "stress/bench.hpp"

namespace coapt {

// Moves some free inner vertices of the mesh at rest along an edge until only `share` of it is left: the
// triangles on that edge become slivers of aspect 1 / share. Vertices with a line or a support keep their
// place, and so do those whose triangles would turn over; of the moved ones no two share a triangle. At most
// one vertex in `every` is moved. Returns how many were.
int add_slivers(StressScene& subject, double share, int every);

}  // namespace coapt
