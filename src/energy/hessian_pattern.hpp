// Where every element's 3x3 blocks go in the assembled Hessian: computed once, written in place. What pairs
// in contact couple changes from one search to the next; the rest stays.
#pragma once

#include "energy/term.hpp"

#include <Eigen/SparseCore>

#include <cstdint>
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

  // The pattern after terms of contact have found other pairs. Pre: the same terms, and no other has changed.
  void renew_pairs(const std::vector<std::unique_ptr<EnergyTerm>>& terms);

  // The lower triangle (whole diagonal blocks) with zero values.
  const Eigen::SparseMatrix<double>& zero_matrix() const { return zero_; }

  // Slots of one term, width * width for each element, as Sink wants them.
  const BlockSlot* slots(size_t term) const { return slots_.data() + first_slot_[term]; }

  // Place of one block of unknowns; base < 0 above the diagonal. Pre: below it, an element couples the two.
  BlockSlot slot(int block_row, int block_column) const;

  // Replaces rows and columns of prescribed coordinates by unit ones.
  void mask(Eigen::SparseMatrix<double>& h) const;

  // The prescribed coordinates among the unknowns.
  const std::vector<int>& masked() const { return masked_; }

 private:
  // A 3x3 block of an element at or below the diagonal.
  struct ElementBlock {
    int row;
    std::uint32_t slot;
  };
  // By block column.
  struct ElementBlocks {
    std::vector<size_t> start;
    std::vector<ElementBlock> block;
  };

  // Gives the terms of contact, or all others, slots from `first` on, and returns how many there are then.
  size_t number_slots(const std::vector<std::unique_ptr<EnergyTerm>>& terms, bool of_contact, size_t first);
  ElementBlocks element_blocks(const std::vector<std::unique_ptr<EnergyTerm>>& terms, bool of_contact) const;
  void couple_fixed(const std::vector<std::unique_ptr<EnergyTerm>>& terms);
  void write_matrix();
  void find_masked();

  std::vector<int> block_;  // of each node
  int block_count_ = 0;
  // Rows that all terms but contact couple with each block column, ascending, the diagonal among them; and
  // which of them each slot of these terms is, -1 above the diagonal.
  std::vector<size_t> fixed_start_;
  std::vector<int> fixed_row_;
  std::vector<int> fixed_entry_;
  std::vector<int> start_, row_;  // of all block columns, contact included
  Eigen::SparseMatrix<double> zero_;
  std::vector<size_t> first_slot_;  // of each term; those of contact are the last
  std::vector<BlockSlot> slots_;
  std::vector<char> is_masked_;                // of each unknown
  std::vector<int> masked_;                    // unknowns
  std::vector<int> masked_zero_, masked_one_;  // positions in the values
};

}  // namespace coapt
