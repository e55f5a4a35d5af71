// Which few nodes bear nearly all of the force out of balance.
#pragma once

#include "optim/linear/factorisation.hpp"

#include <vector>

namespace coapt {

struct WorstPart {
  std::vector<int> blocks;  // of unknowns, ascending
  double outside = 0;       // greatest nodal force elsewhere [force]
  Vector force;             // of each block, to work with
  std::vector<char> is_in;  // the same
  void make_room(size_t count) {
    blocks.reserve(count);
    force.resize(static_cast<Eigen::Index>(count));
    is_in.reserve(count);
  }
};

// The nodes that bear more than a tenth of the greatest nodal force of g, and their neighbours in the graph
// of `lower`, the lower triangle of a Hessian by whole blocks. Returns false where these are more than a few
// dozen, or with their neighbours more than a hundred and a third of all nodes, or nothing is out of balance.
bool find_worst_part(const Vector& g, const SparseMatrix& lower, WorstPart& worst);

}  // namespace coapt
