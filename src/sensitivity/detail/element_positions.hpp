// Positions of an element's nodes, node after node.
#pragma once

#include "energy/term.hpp"

namespace coapt {

// Of three numbers for each node of an element, which has at most four; on the stack.
using ElementVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 12, 1>;

inline ElementVector element_positions(const EnergyTerm& term, int element, const Points& x) {
  const Stencils& stencils = term.stencils();
  ElementVector local(3 * stencils.width);
  for (int a = 0; a < stencils.width; ++a)
    local.segment<3>(3 * a) = x.col(stencils.nodes[static_cast<size_t>(element * stencils.width + a)]);
  return local;
}

}  // namespace coapt
