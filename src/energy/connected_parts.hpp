// The connected parts of a body, and the rigid motions that their supports leave them.
#pragma once

#include "energy/objective.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

// Nodes that elements of internal terms couple, directly or through others; a node of no element is alone.
struct Part {
  std::vector<int> nodes;  // ascending

  // Independent rigid motions, to first order, that no prescribed coordinate of the part prevents: 0 ... 6.
  // A motion that moves none of its nodes, such as a straight line's turning about itself, does not count.
  int free_motions = 0;

  // Along each axis: no coordinate of the part is prescribed, so that it can be shifted without strain.
  std::array<bool, 3> can_shift{};

  bool can_shift_at_all() const { return can_shift[0] || can_shift[1] || can_shift[2]; }

  // "the part with node 17 (34 nodes) is held by nothing: it can move in 6 ways".
  std::string description() const;
};

// All parts, in the order of their first nodes. x: 3 x node_count positions. fixed: as the objective has it.
std::vector<Part> connected_parts(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const Points& x,
                                  const FixedMask& fixed);

// Forces of a term on the nodes, 3 x node_count [force], a circulatory remainder included.
Points nodal_forces(const EnergyTerm& term, const Points& x);

}  // namespace coapt
