#include "energy/hessian_pattern.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace coapt {
namespace {

// The blocks of all elements at and below the diagonal, by block column.
struct ElementBlocks {
  std::vector<size_t> start;  // of each column
  std::vector<int> row;
  std::vector<BlockSlot*> slot;  // of the element, to be filled in
};

// slots: of each term, to point into.
ElementBlocks element_blocks(const std::vector<std::unique_ptr<EnergyTerm>>& terms,
                             const std::vector<int>& block, int block_count,
                             std::vector<std::vector<BlockSlot>>& slots) {
  const auto visit_blocks = [&](const auto& visit) {
    for (size_t k = 0; k < terms.size(); ++k) {
      const Stencils& stencils = terms[k]->stencils();
      BlockSlot* slot = slots[k].data();
      for (size_t first = 0; first < stencils.nodes.size(); first += stencils.width)
        for (int a = 0; a < stencils.width; ++a)
          for (int b = 0; b < stencils.width; ++b, ++slot) {
            const int row = block[stencils.nodes[first + a]], column = block[stencils.nodes[first + b]];
            if (column >= 0 && row >= column) visit(row, column, slot);
          }
    }
  };
  ElementBlocks blocks;
  blocks.start.assign(block_count + 1, 0);
  visit_blocks([&](int, int column, BlockSlot*) { ++blocks.start[column + 1]; });
  std::partial_sum(blocks.start.begin(), blocks.start.end(), blocks.start.begin());
  blocks.row.resize(blocks.start.back());
  blocks.slot.resize(blocks.start.back());
  std::vector<size_t> next(blocks.start.begin(), blocks.start.end() - 1);
  visit_blocks([&](int row, int column, BlockSlot* slot) {
    blocks.row[next[column]] = row;
    blocks.slot[next[column]++] = slot;
  });
  return blocks;
}

}  // namespace

HessianPattern::HessianPattern(const std::vector<std::unique_ptr<EnergyTerm>>& terms,
                               const std::vector<int>& block, int block_count,
                               const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed) {
  for (const auto& term : terms) slots_.emplace_back(term->stencils().nodes.size() * term->stencils().width);
  const ElementBlocks elements = element_blocks(terms, block, block_count, slots_);
  zero_.resize(3 * block_count, 3 * block_count);
  std::vector<int> rows, place(block_count), column_of(block_count, -1), inner;
  inner.reserve(elements.row.size() * 3);
  for (int j = 0; j < block_count; ++j) {
    rows.assign(1, j);
    column_of[j] = j;
    for (size_t k = elements.start[j]; k < elements.start[j + 1]; ++k)
      if (std::exchange(column_of[elements.row[k]], j) != j) rows.push_back(elements.row[k]);
    std::sort(rows.begin(), rows.end());
    const int position = static_cast<int>(inner.size()), height = 3 * static_cast<int>(rows.size());
    for (size_t k = 0; k < rows.size(); ++k) place[rows[k]] = static_cast<int>(k);
    for (size_t k = elements.start[j]; k < elements.start[j + 1]; ++k)
      *elements.slot[k] = {position + 3 * place[elements.row[k]], height};
    for (int c = 0; c < 3; ++c) {
      zero_.outerIndexPtr()[3 * j + c] = position + c * height;
      for (const int row : rows) inner.insert(inner.end(), {3 * row, 3 * row + 1, 3 * row + 2});
    }
  }
  const auto size = static_cast<Eigen::Index>(inner.size());
  zero_.outerIndexPtr()[3 * block_count] = static_cast<int>(size);
  zero_.resizeNonZeros(size);
  std::copy(inner.begin(), inner.end(), zero_.innerIndexPtr());
  std::fill_n(zero_.valuePtr(), size, 0.0);

  std::vector<char> masked(3 * block_count, 0);
  for (size_t node = 0; node < block.size(); ++node)
    for (int c = 0; c < 3; ++c)
      if (block[node] >= 0 && fixed(c, static_cast<Eigen::Index>(node))) {
        masked[3 * block[node] + c] = 1;
        masked_.push_back(3 * block[node] + c);
      }
  for (int column = 0; column < zero_.outerSize(); ++column)
    for (int k = zero_.outerIndexPtr()[column]; k < zero_.outerIndexPtr()[column + 1]; ++k) {
      const int row = zero_.innerIndexPtr()[k];
      if (!masked[row] && !masked[column]) continue;
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
