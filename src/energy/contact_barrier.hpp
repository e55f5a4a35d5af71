// Contact that lets nothing through: a barrier on the distances of points to triangles and of edges to edges
// (Li et al. 2020, "Incremental Potential Contact"), with steps limited by continuous collision detection.
//
//   W = sum over pairs p A r phi(d / r)      phi: energy/contact/pair_barrier.hpp
//
// p is a pressure, A the rest area that belongs to the pair, r its range: the gap that the user names or,
// where two features lie closer than twice that at rest, half their distance at rest, so that a mesh at rest
// feels nothing. Weighted by areas the contact pressure does not depend on the mesh; it reaches p at about
// two thirds of the gap. Features that share a vertex, pairs that the user excludes and
// those of obstacles among themselves are left out; no other pair is.
#pragma once

#include "energy/term.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

struct ContactBarrierOptions {
  double gap = 0;       // distance at which the repulsion begins [length]
  double pressure = 0;  // p: of the order of the pressures that contact has to carry [force/length^2]

  // Obstacles: triangles whose nodes are prescribed. They meet the membrane and not each other.
  Triangles obstacles = Triangles(3, 0);

  // Pairs of triangles that may pass through each other; numbers of triangles, those of the obstacles
  // following those of the membrane.
  std::vector<std::array<int, 2>> excluded = {};
};

// X: 3 x node_count rest positions; triangles: those of the membrane. Throws InputError when an option is out
// of range, naming it.
std::unique_ptr<EnergyTerm> make_contact_barrier(std::string name, const Points& X,
                                                 const Triangles& triangles,
                                                 const ContactBarrierOptions& options);

// A pair of features within its range, and where their closest points lie.
struct BarrierContact {
  std::array<int, 4> nodes;  // point and corners of the triangle, or the ends of both edges
  bool is_edge_edge = false;
  int inside = 0;                      // bit a: the closest points depend on node a
  std::array<double, 4> weights = {};  // of the nodes in the vector between the closest points
  double distance = 0;                 // [length]
  double range = 0;                    // at which the repulsion begins [length]
};

// All of them at x (3 x node_count), in the order of the term's list; none for a term that
// make_contact_barrier() has not made. Pre: the term was prepared for positions near x.
std::vector<BarrierContact> barrier_contacts(const EnergyTerm& term, const Points& x);

}  // namespace coapt
