// Slivers taken out of the leaflets of a valve, with everything that refers to their vertices carried along.
#pragma once

#include "formats/valve.hpp"
#include "mesh/remesh/repair_slivers.hpp"

namespace coapt {

struct ValveRepair {
  MeshRepair leaflets;
  bool has_reference = false;  // a closed reference on the same triangles, which took the same steps
  double reference_move = 0;   // farthest that any of its samples lies from where it was [length]
};

// repair_slivers() of the leaflets. Commissures and ends of chords stay, vertices of the annulus and of
// supports are merged among themselves alone. Where a flat triangle is cut off, the annulus and the free edge
// run through its apex; on the annulus this gets the closed position at its place along the edge. A closed
// reference with the triangles of the leaflets keeps its vertices and takes the same triangles, so that
// vertex still answers to vertex. Sets name the vertex that took the place of one of theirs.
// Nothing is changed where nothing is to be repaired.
ValveRepair repair_valve(Valve& valve, double aspect);

}  // namespace coapt
