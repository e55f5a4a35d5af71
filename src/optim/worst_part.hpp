// Which few nodes bear nearly all of the force out of balance.
#pragma once

#include "linear/factorisation.hpp"

#include <vector>

namespace coapt {

struct WorstPart {
  explicit WorstPart(Eigen::Index nodes);  // of the whole

  // The nodes that bear more than a tenth of the greatest nodal force of g, and their neighbours in the graph
  // of `lower`. False where these are more than a few dozen, or with their neighbours a great share of all
  // nodes, or nothing is out of balance. lower: lower triangle of a Hessian by whole blocks. Allocates
  // nothing.
  bool find(const Vector& g, const SparseMatrix& lower);

  // Of all nodes, of what was found.
  double share() const { return static_cast<double>(blocks.size()) / static_cast<double>(force_.size()); }

  std::vector<int> blocks;  // of unknowns, ascending
  double outside = 0;       // greatest nodal force elsewhere [force]

 private:
  Vector force_;
  std::vector<bool> is_in_;
};

}  // namespace coapt
