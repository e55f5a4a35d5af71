// Which few nodes bear nearly all of the force out of balance.
#pragma once

#include "linear/factorisation.hpp"

#include <optional>
#include <vector>

namespace coapt {

struct WorstPart {
  std::vector<int> blocks;  // of unknowns, ascending
  double outside = 0;       // greatest nodal force elsewhere [force]
};

// The nodes that bear more than a tenth of the greatest nodal force of g, and their neighbours in the graph
// of `lower`; none where these are more than a few dozen, or nothing is out of balance. lower: lower triangle
// of a Hessian by whole blocks.
std::optional<WorstPart> worst_part(const Vector& g, const SparseMatrix& lower);

}  // namespace coapt
