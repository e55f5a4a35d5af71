// Shapes of a film that depend on its supports and on how its triangles are joined, not on where its nodes
// are: starts for a minimiser.
#pragma once

#include "core/types.hpp"

#include <vector>

namespace coapt {

// A film as a net: three nodes for each triangle.
struct FilmNet {
  std::vector<int> corners;
  Eigen::Array<bool, 3, Eigen::Dynamic> is_free;  // 3 x node_count: what moves; nodes of no corner do not
};

// Puts the free nodes into the middle of their neighbours along one coordinate, as equal force densities
// would (Schek 1974); an edge counts once for each of its triangles. Where nothing holds the net x stays.
void relax_net(const FilmNet& net, int coordinate, Points& x);

// Makes the area less, up to eight times: each time the nodes go where the Dirichlet energy of the shape as
// it is is least (Pinkall and Polthier 1993), until that gains little. No triangle is let shrink to next to
// nothing. Returns whether the last time gained little: else no film of least area is near. x stays where
// nothing holds the net.
bool lessen_area(const FilmNet& net, Points& x);

// A net that nothing holds made rounder, its area kept: steps of the flow by mean curvature in which the
// weights of the edges stay those of the start (Kazhdan, Solomon and Ben-Chen 2012), so that no neck pinches
// off. A free coordinate is measured from `centre`.
void round_net(const FilmNet& net, const Vec3& centre, Points& x);

}  // namespace coapt
