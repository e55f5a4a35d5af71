#include "energy/hessian_pattern.hpp"

#include <algorithm>

namespace coapt {
namespace {

// For each block column the block rows at or below the diagonal, ascending.
std::vector<std::vector<int>> block_columns(const std::vector<std::unique_ptr<EnergyTerm>>& terms,
                                            const std::vector<int>& block, int block_count) {
  std::vector<std::vector<int>> columns(block_count);
  for (int j = 0; j < block_count; ++j) columns[j].push_back(j);
  for (const auto& term : terms) {
    const Stencils& stencils = term->stencils();
    for (size_t first = 0; first < stencils.nodes.size(); first += stencils.width)
      for (int a = 0; a < stencils.width; ++a)
        for (int b = 0; b < stencils.width; ++b) {
          const int row = block[stencils.nodes[first + a]], column = block[stencils.nodes[first + b]];
          if (column >= 0 && row > column) columns[column].push_back(row);
        }
  }
  for (auto& rows : columns) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  }
  return columns;
}

}  // namespace

HessianPattern::HessianPattern(const std::vector<std::unique_ptr<EnergyTerm>>& terms,
                               const std::vector<int>& block, int block_count,
                               const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed) {
  const std::vector<std::vector<int>> columns = block_columns(terms, block, block_count);
  size_t blocks = 0;
  for (const auto& rows : columns) blocks += rows.size();

  zero_.resize(3 * block_count, 3 * block_count);
  zero_.resizeNonZeros(static_cast<Eigen::Index>(9 * blocks));
  int position = 0;
  for (int j = 0; j < block_count; ++j)
    for (int c = 0; c < 3; ++c) {
      zero_.outerIndexPtr()[3 * j + c] = position;
      for (int row : columns[j])
        for (int r = 0; r < 3; ++r) zero_.innerIndexPtr()[position++] = 3 * row + r;
    }
  zero_.outerIndexPtr()[3 * block_count] = position;
  std::fill_n(zero_.valuePtr(), position, 0.0);

  const auto slot_of = [&](int row, int column) -> BlockSlot {
    if (row < column || column < 0) return {};
    const auto& rows = columns[column];
    const auto k = std::lower_bound(rows.begin(), rows.end(), row) - rows.begin();
    return {zero_.outerIndexPtr()[3 * column] + 3 * static_cast<int>(k), 3 * static_cast<int>(rows.size())};
  };
  for (const auto& term : terms) {
    const Stencils& stencils = term->stencils();
    std::vector<BlockSlot> slots;
    slots.reserve(stencils.nodes.size() * stencils.width);
    for (size_t first = 0; first < stencils.nodes.size(); first += stencils.width)
      for (int a = 0; a < stencils.width; ++a)
        for (int b = 0; b < stencils.width; ++b)
          slots.push_back(slot_of(block[stencils.nodes[first + a]], block[stencils.nodes[first + b]]));
    slots_.push_back(std::move(slots));
  }

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
