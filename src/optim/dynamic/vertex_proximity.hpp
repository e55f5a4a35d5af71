// How mass-spring models of valves have kept leaflets apart: at vertices that come near a facet. Neither
// holds off what is pressed hard or moves fast; what passed through is counted at the end.
#pragma once

#include "energy/contact/contact_surface.hpp"

#include <array>
#include <vector>

namespace coapt {

// Pairs of a vertex and a triangle that are closer than `distance` [length] and than half their distance at
// rest; those that share a vertex are left out.
class VertexProximity {
 public:
  VertexProximity(const Points& rest, const Triangles& triangles, double distance);

  // Finds the pairs at x, 3 x node_count. Returns how many there are.
  int find(const Points& x);

  // Takes the velocity at which each pair approaches, by equal and opposite impulses: their collision is
  // inelastic (Hammer et al. 2008). v: 3 x node_count [length/time]; mass: of each node, infinite where it is
  // prescribed.
  void stop_approach(Points& v, const Vector& mass) const;

  // Forces that balance what presses each vertex towards its triangles (Hammer et al. 2011), with equal and
  // opposite ones on their corners. force: what acts on each node besides, 3 x node_count [force].
  Points balancing_forces(const Points& force) const;

 private:
  struct Pair {
    std::array<int, 4> nodes;  // vertex, then corners
    Eigen::Vector4d weights;   // of the difference of the closest points
    Vec3 normal;               // unit, from the triangle to the vertex
  };

  ContactSurface surface_;
  double distance_;
  std::vector<Pair> pairs_;
};

}  // namespace coapt
