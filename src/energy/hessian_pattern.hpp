// Where every element's 3x3 blocks go in the assembled Hessian: computed once, written in place.
#pragma once

#include "energy/term.hpp"

#include <Eigen/SparseCore>

#include <memory>
#include <vector>

namespace coapt {

class HessianPattern {
 public:
  HessianPattern() = default;

  // block: block of each node, -1 for a node without unknowns. fixed: 3 x node_count, prescribed
  // coordinates of the other nodes get a unit row.
  HessianPattern(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const std::vector<int>& block,
                 int block_count, const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed);

  // The lower triangle (whole diagonal blocks) with zero values.
  const Eigen::SparseMatrix<double>& zero_matrix() const { return zero_; }

  // Slots of one term, width * width for each element, as Sink wants them.
  const BlockSlot* slots(size_t term) const { return slots_[term].data(); }

  // Place of one block of unknowns; base < 0 above the diagonal. Pre: below it, an element couples the two.
  BlockSlot slot(int block_row, int block_column) const;

  // Replaces rows and columns of prescribed coordinates by unit ones.
  void mask(Eigen::SparseMatrix<double>& h) const;

  // The prescribed coordinates among the unknowns.
  const std::vector<int>& masked() const { return masked_; }

 private:
  Eigen::SparseMatrix<double> zero_;
  std::vector<std::vector<BlockSlot>> slots_;  // per term
  std::vector<int> masked_;                    // unknowns
  std::vector<int> masked_zero_, masked_one_;  // positions in the values
};

}  // namespace coapt
