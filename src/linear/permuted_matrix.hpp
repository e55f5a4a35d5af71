// A symmetric matrix of 3x3 node blocks, reordered into storage that was laid out beforehand: what the
// factorisations work on.
#pragma once

#include "linear/factorisation.hpp"

#include <vector>

namespace coapt {

// Lower triangle of the graph of nodes, diagonal included: column j has the rows
// row[start[j]] ... row[start[j + 1] - 1], ascending.
struct NodeGraph {
  std::vector<int> start{0}, row;
  int size() const { return static_cast<int>(start.size()) - 1; }
};

// Pre: the lower triangle consists of whole 3x3 blocks. Throws InputError otherwise.
NodeGraph node_graph(const SparseMatrix& lower);

enum class Triangle { Lower, Upper };

class PermutedMatrix {
 public:
  PermutedMatrix() = default;

  // order[k]: the node that comes k-th. triangle: the one that is stored, with whole diagonal blocks.
  PermutedMatrix(const NodeGraph& graph, std::vector<int> order, Triangle triangle);

  // Takes the values of a matrix whose graph this was made for; allocates nothing.
  void take_values(const SparseMatrix& lower);

  const SparseMatrix& matrix() const { return matrix_; }
  const std::vector<int>& order() const { return order_; }

  // y = P x and x = P^T y. No allocation when the target has its size.
  void permute(const Vector& x, Vector& y) const;
  void restore(const Vector& y, Vector& x) const;

 private:
  // Entry (r, c) of a block comes from values[from + r * row_step + c * column_step]
  // and goes to values[to + r + c * stride].
  struct Move {
    int from, row_step, column_step, to, stride;
  };

  SparseMatrix matrix_;
  std::vector<Move> moves_;  // in the order of the target
  std::vector<int> order_;
};

}  // namespace coapt
