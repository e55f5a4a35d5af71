#include "energy/hessian_pattern.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace coapt {
namespace {

bool is_contact(const EnergyTerm& term) { return term.role() == TermRole::Contact; }

}  // namespace

size_t HessianPattern::number_slots(const std::vector<std::unique_ptr<EnergyTerm>>& terms, bool of_contact,
                                    size_t first) {
  first_slot_.resize(terms.size());
  for (size_t k = 0; k < terms.size(); ++k) {
    if (is_contact(*terms[k]) != of_contact) continue;
    first_slot_[k] = first;
    first += terms[k]->stencils().nodes.size() * static_cast<size_t>(terms[k]->stencils().width);
  }
  return first;
}

HessianPattern::ElementBlocks HessianPattern::element_blocks(
    const std::vector<std::unique_ptr<EnergyTerm>>& terms, bool of_contact) const {
  const auto visit_blocks = [&](const auto& visit) {
    for (size_t k = 0; k < terms.size(); ++k) {
      if (is_contact(*terms[k]) != of_contact) continue;
      const Stencils& stencils = terms[k]->stencils();
      auto slot = static_cast<std::uint32_t>(first_slot_[k]);
      for (size_t first = 0; first < stencils.nodes.size(); first += stencils.width)
        for (int a = 0; a < stencils.width; ++a)
          for (int b = 0; b < stencils.width; ++b, ++slot) {
            const int row = block_[stencils.nodes[first + a]], column = block_[stencils.nodes[first + b]];
            if (column >= 0 && row >= column) visit(column, ElementBlock{row, slot});
          }
    }
  };
  ElementBlocks blocks;
  blocks.start.assign(block_count_ + 1, 0);
  visit_blocks([&](int column, const ElementBlock&) { ++blocks.start[column + 1]; });
  std::partial_sum(blocks.start.begin(), blocks.start.end(), blocks.start.begin());
  blocks.block.resize(blocks.start.back());
  std::vector<size_t> next(blocks.start.begin(), blocks.start.end() - 1);
  visit_blocks([&](int column, const ElementBlock& block) { blocks.block[next[column]++] = block; });
  return blocks;
}

HessianPattern::HessianPattern(const std::vector<std::unique_ptr<EnergyTerm>>& terms,
                               const std::vector<int>& block, int block_count,
                               const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed)
    : block_(block), block_count_(block_count), is_masked_(3 * block_count, 0) {
  for (size_t node = 0; node < block.size(); ++node)
    for (int c = 0; c < 3; ++c)
      if (block[node] >= 0 && fixed(c, static_cast<Eigen::Index>(node))) {
        is_masked_[3 * block[node] + c] = 1;
        masked_.push_back(3 * block[node] + c);
      }
  couple_fixed(terms);
  renew_pairs(terms);
}

void HessianPattern::couple_fixed(const std::vector<std::unique_ptr<EnergyTerm>>& terms) {
  fixed_entry_.assign(number_slots(terms, false, 0), -1);
  const ElementBlocks elements = element_blocks(terms, false);
  std::vector<int> rows, place(block_count_), column_of(block_count_, -1);
  fixed_start_.assign(1, 0);
  for (int j = 0; j < block_count_; ++j) {
    rows.assign(1, j);
    column_of[j] = j;
    for (size_t k = elements.start[j]; k < elements.start[j + 1]; ++k)
      if (std::exchange(column_of[elements.block[k].row], j) != j) rows.push_back(elements.block[k].row);
    std::sort(rows.begin(), rows.end());
    for (size_t k = 0; k < rows.size(); ++k) place[rows[k]] = static_cast<int>(fixed_row_.size() + k);
    for (size_t k = elements.start[j]; k < elements.start[j + 1]; ++k)
      fixed_entry_[elements.block[k].slot] = place[elements.block[k].row];
    fixed_row_.insert(fixed_row_.end(), rows.begin(), rows.end());
    fixed_start_.push_back(fixed_row_.size());
  }
}

void HessianPattern::renew_pairs(const std::vector<std::unique_ptr<EnergyTerm>>& terms) {
  const size_t fixed_count = fixed_entry_.size();
  slots_.resize(number_slots(terms, true, fixed_count));
  std::fill(slots_.begin() + static_cast<std::ptrdiff_t>(fixed_count), slots_.end(), BlockSlot{});
  const ElementBlocks pairs = element_blocks(terms, true);
  std::vector<int> more, place(block_count_), column_of(block_count_, -1);
  std::vector<BlockSlot> of_entry(fixed_row_.size());
  start_.assign(1, 0);
  row_.clear();
  for (int j = 0; j < block_count_; ++j) {
    const auto first = fixed_row_.begin() + static_cast<std::ptrdiff_t>(fixed_start_[j]),
               last = fixed_row_.begin() + static_cast<std::ptrdiff_t>(fixed_start_[j + 1]);
    std::for_each(first, last, [&](int row) { column_of[row] = j; });
    more.clear();
    for (size_t k = pairs.start[j]; k < pairs.start[j + 1]; ++k)
      if (std::exchange(column_of[pairs.block[k].row], j) != j) more.push_back(pairs.block[k].row);
    std::sort(more.begin(), more.end());
    std::merge(first, last, more.begin(), more.end(), std::back_inserter(row_));
    const int begin = start_.back(), end = static_cast<int>(row_.size());
    for (int k = begin; k < end; ++k) place[row_[k]] = k - begin;
    const auto slot_of = [&](int row) { return BlockSlot{9 * begin + 3 * place[row], 3 * (end - begin)}; };
    for (size_t k = fixed_start_[j]; k < fixed_start_[j + 1]; ++k) of_entry[k] = slot_of(fixed_row_[k]);
    for (size_t k = pairs.start[j]; k < pairs.start[j + 1]; ++k)
      slots_[pairs.block[k].slot] = slot_of(pairs.block[k].row);
    start_.push_back(end);
  }
  for (size_t i = 0; i < fixed_entry_.size(); ++i)
    if (fixed_entry_[i] >= 0) slots_[i] = of_entry[static_cast<size_t>(fixed_entry_[i])];
  write_matrix();
  find_masked();
}

void HessianPattern::write_matrix() {
  zero_.resize(3 * block_count_, 3 * block_count_);
  zero_.resizeNonZeros(9 * static_cast<Eigen::Index>(row_.size()));
  int *outer = zero_.outerIndexPtr(), *inner = zero_.innerIndexPtr();
  for (int j = 0; j < block_count_; ++j) {
    const int height = 3 * (start_[j + 1] - start_[j]);
    for (int c = 0; c < 3; ++c) {
      outer[3 * j + c] = 9 * start_[j] + c * height;
      for (int k = start_[j]; k < start_[j + 1]; ++k)
        for (int r = 0; r < 3; ++r) *inner++ = 3 * row_[k] + r;
    }
  }
  outer[3 * block_count_] = 9 * static_cast<int>(row_.size());
  std::fill_n(zero_.valuePtr(), zero_.nonZeros(), 0.0);
}

void HessianPattern::find_masked() {
  masked_zero_.clear();
  masked_one_.clear();
  if (masked_.empty()) return;
  for (int column = 0; column < zero_.outerSize(); ++column)
    for (int k = zero_.outerIndexPtr()[column]; k < zero_.outerIndexPtr()[column + 1]; ++k) {
      const int row = zero_.innerIndexPtr()[k];
      if (!is_masked_[row] && !is_masked_[column]) continue;
      (row == column ? masked_one_ : masked_zero_).push_back(k);
    }
}

BlockSlot HessianPattern::slot(int block_row, int block_column) const {
  if (block_row < block_column || block_column < 0) return {};
  const int first = zero_.outerIndexPtr()[3 * block_column],
            last = zero_.outerIndexPtr()[3 * block_column + 1];
  const int* rows = zero_.innerIndexPtr();
  const auto found = std::lower_bound(rows + first, rows + last, 3 * block_row) - rows;
  return {static_cast<int>(found), last - first};
}

void HessianPattern::mask(Eigen::SparseMatrix<double>& h) const {
  for (int k : masked_zero_) h.valuePtr()[k] = 0;
  for (int k : masked_one_) h.valuePtr()[k] = 1;
}

}  // namespace coapt
