// How far the closed shape on a mesh is from that on ever finer ones, as far as a sequence of meshes shows
// it, each the one before with every triangle refined uniformly, 1:4.
#pragma once

#include "results/reference/reference_distance.hpp"

#include <optional>
#include <vector>

namespace coapt {

// Between the closed shapes of such a sequence; one entry less than it has meshes.
struct MeshDistances {
  std::vector<DistanceFigures> to_next;    // from each to the one that follows it
  std::vector<DistanceFigures> to_finest;  // from each to the last
};

// shapes: coarsest first, at least two. The facets of the coarser one of each pair are cut, flat, into those
// of the finer one, so that both are sampled as closely: a sheet's vertices lie where the facets of a coarser
// mesh are farthest off, and are no fair sample of it alone. Throws InputError where one has no area.
MeshDistances distances_between_meshes(const std::vector<TriangleMesh>& shapes);

struct DiscretisationEstimate {
  // log2 of the ratio of the last two mean distances; empty where there are fewer than two, or one is zero.
  std::optional<double> order;
  // With which errors are taken to fall: the observed order, but at least 1/2 and at most 2. Where none was
  // observed 7/4: discs and valves show 1.5 to 2.3, the second order of smooth shapes less what kinks take.
  double assumed_order = 1.75;
  // Of each mesh: that 95 % of the surface are no farther from the limit [mm].
  std::vector<double> error_mm;
};

// One mesh more than distances. With errors that fall as 2^-p from mesh to mesh, p the assumed order:
//   of a mesh n > 1 cuts before the last   its distance D to the last, and what that lacks: D / (1 - 2^-np)
//   of the last but one                    its distance to the last, times what the mesh before it shows
//                                          error and distance to the next mesh to differ by, 1 ... 1/(1-2^-p)
//   of the last                            2^-p of that
DiscretisationEstimate estimate_discretisation(const MeshDistances& distances);

// log2 of the ratio of two mean distances, each to the next mesh; empty where one is zero.
std::optional<double> observed_order(const DistanceFigures& coarser, const DistanceFigures& finer);

// Whether the last two refinements show errors that fall alike, so that what is beyond the last mesh may be
// told from them: two observed orders, of at least 1/2 each and no more than 1/2 apart. Needs four meshes.
bool orders_agree(const MeshDistances& distances);

}  // namespace coapt
