// The exact tangent over all nodes, prescribed ones included, as an operator.
#pragma once

#include "energy/objective.hpp"

namespace coapt {

// K = dg/dx, g the nodal gradient of the energy minus the forces that have no potential: not symmetric where
// pressure acts on free edges. The pattern is kept from one assembly to the next while the objective keeps
// its own.
class NodalTangent {
 public:
  // Pre: the terms are prepared for x and their loads are at full size.
  void assemble(const Objective& objective, const Points& x);

  // K v and K^T v, 3 x node_count.
  Points product(const Points& v) const;
  Points transposed_product(const Points& v) const;

 private:
  HessianPattern pattern_;
  long pattern_version_ = -1;
  Eigen::SparseMatrix<double> h_;  // lower triangle
  std::vector<TangentBlock> circulatory_;
};

}  // namespace coapt
