// Takes slivers and needles out of a mesh, by steps that move the surface by less than they are high.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace coapt {

struct RepairConstraints {
  double aspect = 1e3;  // longest edge over height, above which a triangle is a sliver
  // Per vertex, or empty. A vertex is merged only into one that has all of its roles.
  std::vector<std::uint64_t> roles = {};
  std::uint64_t uncut_roles = 0;  // no rim edge between two vertices of such a role is cut away
  std::vector<bool> stays = {};   // per vertex, or empty: it is not merged into another
};

enum class RepairKind {
  Drop,     // a triangle that names a vertex twice, or repeats another
  Flip,     // the long edge of a flat triangle goes to its apex
  Cut,      // a flat triangle whose long edge is on the rim is left out: the rim runs through its apex
  Collapse  // a short edge: one of its ends is merged into the other
};

struct RepairStep {
  RepairKind kind = RepairKind::Drop;
  std::vector<int> triangles;        // that are gone or have other corners
  std::array<int, 2> edge = {0, 0};  // Collapse: the vertex that is gone first
  int apex = -1;                     // Flip, Cut
  double moved = 0;                  // bound on how far this step moves the surface [length]
};

struct MeshRepair {
  TriangleMesh mesh;              // vertices and triangles in the order of the given ones
  std::vector<int> number;        // vertex here of each given one; merged ones have that of the other
  std::vector<int> triangle;      // triangle here of each given one; -1: gone
  std::vector<RepairStep> steps;  // in the order in which they were made, in the numbers of the given mesh
  std::vector<int> slivers;       // of the given mesh, ascending
  std::vector<int> left;          // slivers that could not be repaired, by given number, ascending
  double largest_move = 0;        // of a vertex [length]
  double surface_move = 0;  // bound on the distance of any point of either surface from the other [length]

  bool is_changed() const { return !steps.empty(); }
};

// The triangles with a longest edge above `aspect` times the height, those without area included.
// Pre (here and below): corner indices are in range, coordinates are finite.
std::vector<int> slivers(const TriangleMesh& mesh, double aspect);

// Repeated triangles and those that name a vertex twice are dropped. Then, worst first, each sliver takes the
// step that moves the surface least of those that leave fewer slivers, else of those that leave as many but
// better ones. Steps fold nothing over and keep the surface manifold where it was. The height bounds what a
// flip or a cut moves; edges are collapsed up to a hundredth of the longest edge of the sliver. Regions keep
// their borders to within that. A mesh without any of these comes back as it is. O(n log n) and a little per
// sliver. Deterministic.
MeshRepair repair_slivers(const TriangleMesh& mesh, const RepairConstraints& constraints = {});

}  // namespace coapt
