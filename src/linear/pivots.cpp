#include "linear/pivots.hpp"

#include <Eigen/SparseCholesky>

#include <cmath>

namespace coapt {

Inertia inertia_of(const PermutedMatrix& upper) {
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factor;
  factor.analyzePattern(upper.matrix());
  factor.factorize(upper.matrix());
  Inertia inertia;
  // A pivot of zero ends the factorisation: nothing is known of it and of those that follow.
  const auto size = static_cast<int>(upper.matrix().cols());
  const auto pivots = factor.vectorD();
  for (int k = 0; k < size && pivots[k] != 0 && std::isfinite(pivots[k]); ++k)
    ++(pivots[k] < 0 ? inertia.negative : inertia.positive);
  inertia.zero = size - inertia.negative - inertia.positive;
  return inertia;
}

}  // namespace coapt
