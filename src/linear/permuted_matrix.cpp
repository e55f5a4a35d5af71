#include "linear/permuted_matrix.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <numeric>
#include <string>

namespace coapt {
namespace {

// A block in its new place; source: its number in the graph.
struct Block {
  int row, column, source_column, source;
  bool is_transposed;
};

// Stable, so that sorting by row and then by column leaves the rows of each column ascending.
template <typename Key>
std::vector<Block> counting_sort(const std::vector<Block>& blocks, int keys, Key key) {
  std::vector<int> place(keys + 1, 0);
  for (const Block& block : blocks) ++place[key(block) + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<Block> sorted(blocks.size());
  for (const Block& block : blocks) sorted[place[key(block)]++] = block;
  return sorted;
}

}  // namespace

NodeGraph node_graph(const SparseMatrix& lower) {
  const auto refuse = [](const std::string& what) {
    throw InputError("factorisation: " + what +
                     "; wanted: a square compressed matrix of whole 3x3 blocks at and "
                     "below the diagonal");
  };
  if (lower.rows() != lower.cols() || lower.rows() % 3 != 0 || !lower.isCompressed())
    refuse("a matrix of " + std::to_string(lower.rows()) + " x " + std::to_string(lower.cols()));
  const int nodes = static_cast<int>(lower.cols()) / 3;
  const int *outer = lower.outerIndexPtr(), *inner = lower.innerIndexPtr();
  NodeGraph graph;
  graph.start.reserve(nodes + 1);
  graph.row.reserve(lower.nonZeros() / 9);
  for (int j = 0; j < nodes; ++j) {
    const int first = outer[3 * j], count = outer[3 * j + 1] - first;
    if (count == 0 || count % 3 != 0 || outer[3 * j + 2] - first != 2 * count ||
        outer[3 * j + 3] - first != 3 * count || inner[first] != 3 * j)
      refuse("block column " + std::to_string(j) + " is incomplete");
    for (int k = 0; k < count; k += 3) {
      if (inner[first + k] % 3 != 0 || inner[first + k + 2] != inner[first + k] + 2)
        refuse("block column " + std::to_string(j) + " is incomplete");
      graph.row.push_back(inner[first + k] / 3);
    }
    graph.start.push_back(static_cast<int>(graph.row.size()));
  }
  return graph;
}

PermutedMatrix::PermutedMatrix(const NodeGraph& graph, std::vector<int> order, Triangle triangle)
    : order_(std::move(order)) {
  const int nodes = graph.size();
  std::vector<int> place(nodes);
  for (int k = 0; k < nodes; ++k) place[order_[k]] = k;

  std::vector<Block> blocks;
  blocks.reserve(graph.row.size());
  for (int j = 0; j < nodes; ++j)
    for (int k = graph.start[j]; k < graph.start[j + 1]; ++k) {
      const int a = place[graph.row[k]], b = place[j];
      if (triangle == Triangle::Lower)
        blocks.push_back({std::max(a, b), std::min(a, b), j, k, a < b});
      else  // of a diagonal block too, only the lower triangle is read
        blocks.push_back({std::min(a, b), std::max(a, b), j, k, a >= b});
    }
  blocks = counting_sort(blocks, nodes, [](const Block& block) { return block.row; });
  blocks = counting_sort(blocks, nodes, [](const Block& block) { return block.column; });

  matrix_.resize(3 * nodes, 3 * nodes);
  matrix_.resizeNonZeros(static_cast<Eigen::Index>(9 * blocks.size()));
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  moves_.reserve(blocks.size());
  int* inner = matrix_.innerIndexPtr();
  int position = 0;
  for (size_t first = 0; first < blocks.size();) {
    const int column = blocks[first].column;
    size_t last = first;
    while (last < blocks.size() && blocks[last].column == column) ++last;
    const int height = 3 * static_cast<int>(last - first);
    for (size_t k = first; k < last; ++k) {
      const Block& block = blocks[k];
      const int start = graph.start[block.source_column];
      const int from_stride = 3 * (graph.start[block.source_column + 1] - start);
      const int from = 9 * start + 3 * (block.source - start);
      const int to = position + 3 * static_cast<int>(k - first);
      if (block.is_transposed)
        moves_.push_back({from, from_stride, 1, to, height});
      else
        moves_.push_back({from, 1, from_stride, to, height});
    }
    for (int c = 0; c < 3; ++c) {
      matrix_.outerIndexPtr()[3 * column + c] = position;
      for (size_t k = first; k < last; ++k)
        for (int r = 0; r < 3; ++r) inner[position++] = 3 * blocks[k].row + r;
    }
    first = last;
  }
  matrix_.outerIndexPtr()[3 * nodes] = position;
}

void PermutedMatrix::take_values(const SparseMatrix& lower) {
  const double* source = lower.valuePtr();
  double* target = matrix_.valuePtr();
  for (const Move& move : moves_)
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        target[move.to + r + c * move.stride] = source[move.from + r * move.row_step + c * move.column_step];
}

void PermutedMatrix::permute(const Vector& x, Vector& y) const {
  y.resize(x.size());
  for (size_t k = 0; k < order_.size(); ++k) y.segment<3>(3 * k) = x.segment<3>(3 * order_[k]);
}

void PermutedMatrix::restore(const Vector& y, Vector& x) const {
  x.resize(y.size());
  for (size_t k = 0; k < order_.size(); ++k) x.segment<3>(3 * order_[k]) = y.segment<3>(3 * k);
}

}  // namespace coapt
